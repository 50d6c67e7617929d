// SPDX-License-Identifier: MIT
// sanitizers: address
#include "evidence/trials/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

double random_unit(std::uint64_t& state) { return unit_interval(split_mix(state)); }

// By the definition: all pairs.
double auc_by_pairs(const std::vector<Prediction>& all) {
  double sum = 0, pairs = 0;
  for (const Prediction& won : all)
    for (const Prediction& lost : all) {
      if (!won.success || lost.success) continue;
      sum += won.value > lost.value ? 1 : won.value == lost.value ? 0.5 : 0;
      ++pairs;
    }
  return sum / pairs;
}

double area_under(const std::vector<RocPoint>& curve) {
  double area = 0;
  for (std::size_t k = 1; k < curve.size(); ++k)
    area += (curve[k].failures - curve[k - 1].failures) * 0.5 * (curve[k].successes + curve[k - 1].successes);
  return area;
}

// Normal-like values around a mean of 0 for failures and `shift` for successes.
std::vector<Prediction> shifted_predictions(std::size_t count, double shift, std::uint64_t seed) {
  std::vector<Prediction> all;
  for (std::size_t i = 0; i < count; ++i) {
    const bool success = i % 2 == 0;
    double value = success ? shift : 0;
    for (int k = 0; k < 12; ++k) value += random_unit(seed) - 0.5;
    all.push_back({value, success, i});
  }
  return all;
}

// Successes 3, 2, 1 and failures 2, 0: of six pairs 3 > 2, 3 > 0, 2 = 2, 2 > 0, 1 < 2, 1 > 0.
TEST(TrialStatistics, AucOfAFewByHand) {
  const std::vector<Prediction> few{{3, true, 0}, {2, true, 1}, {1, true, 2}, {2, false, 3}, {0, false, 4}};
  EXPECT_DOUBLE_EQ(auc_of(few), 4.5 / 6);
  const std::vector<RocPoint> curve = roc_curve(few);
  ASSERT_EQ(curve.size(), 5u);  // the start, and the values 3, 2, 1, 0
  EXPECT_DOUBLE_EQ(curve[1].successes, 1.0 / 3);
  EXPECT_DOUBLE_EQ(curve[1].failures, 0);
  EXPECT_DOUBLE_EQ(curve[2].successes, 2.0 / 3);
  EXPECT_DOUBLE_EQ(curve[2].failures, 0.5);
  EXPECT_DOUBLE_EQ(curve[4].failures, 1);
  EXPECT_DOUBLE_EQ(area_under(curve), 4.5 / 6);
}

TEST(TrialStatistics, AucTakesInfiniteValuesAndTies) {
  EXPECT_DOUBLE_EQ(auc_of(std::vector<Prediction>{{HUGE_VAL, true, 0}, {-HUGE_VAL, false, 1}}), 1);
  EXPECT_DOUBLE_EQ(auc_of(std::vector<Prediction>{{-HUGE_VAL, true, 0}, {-HUGE_VAL, false, 1}}), 0.5);
  EXPECT_TRUE(std::isnan(auc_of(std::vector<Prediction>{{1, true, 0}, {2, true, 1}})));
  EXPECT_TRUE(roc_curve(std::vector<Prediction>{{1, false, 0}}).empty());
}

TEST(TrialStatistics, AucIsThatOfAllPairsAndOfTheCurve) {
  std::uint64_t state = 7;
  for (int round = 0; round < 50; ++round) {
    std::vector<Prediction> all;
    for (std::size_t i = 0; i < 60; ++i)
      all.push_back({std::floor(8 * random_unit(state)), random_unit(state) < 0.4, i});  // with many ties
    const double expected = auc_by_pairs(all);
    EXPECT_NEAR(auc_of(all), expected, 1e-12);
    EXPECT_NEAR(area_under(roc_curve(all)), expected, 1e-12);
  }
}

// Hanley and McNeil's formula (1982) for independent values is near, and the truth is inside.
TEST(TrialStatistics, IntervalIsAsWideAsTheoryHasIt) {
  const std::vector<Prediction> all = shifted_predictions(400, 1, 11);
  const Auc found = auc_with_interval(all, 3);
  EXPECT_EQ(found.successes, 200u);
  EXPECT_EQ(found.failures, 200u);
  const double a = found.auc, q1 = a / (2 - a), q2 = 2 * a * a / (1 + a), n = 200;
  const double deviation = std::sqrt((a * (1 - a) + (n - 1) * (q1 - a * a) + (n - 1) * (q2 - a * a)) / (n * n));
  EXPECT_NEAR(found.interval.high - found.interval.low, 2 * 1.96 * deviation, 0.2 * 2 * 1.96 * deviation);
  EXPECT_LT(found.interval.low, 0.7602);  // Phi(1 / sqrt 2)
  EXPECT_GT(found.interval.high, 0.7602);
}

// Each grip nine times says no more than once: trials of one grip are drawn together.
TEST(TrialStatistics, CopiesOfAGripDoNotNarrowTheInterval) {
  const std::vector<Prediction> once = shifted_predictions(60, 1, 5);
  std::vector<Prediction> copies;
  for (const Prediction& one : once) copies.insert(copies.end(), 9, one);
  const Auc a = auc_with_interval(once, 1), b = auc_with_interval(copies, 1);
  EXPECT_NEAR(a.auc, b.auc, 1e-12);
  EXPECT_NEAR(a.interval.low, b.interval.low, 1e-12);
  EXPECT_NEAR(a.interval.high, b.interval.high, 1e-12);
}

TEST(TrialStatistics, IntervalsAreTheSeedsAlone) {
  const std::vector<Prediction> all = shifted_predictions(40, 0.5, 9);
  EXPECT_EQ(auc_with_interval(all, 1).interval.low, auc_with_interval(all, 1).interval.low);
  EXPECT_NE(auc_with_interval(all, 1).interval.low, auc_with_interval(all, 2).interval.low);
}

TEST(TrialStatistics, DifferenceIsPaired) {
  const std::vector<Prediction> all = shifted_predictions(100, 1, 13);
  std::vector<Prediction> noisy = all, same = all;
  std::uint64_t state = 21;
  for (Prediction& one : noisy) one.value += 6 * (random_unit(state) - 0.5);
  for (Prediction& one : same) one.value = 2 * one.value + 5;  // another scale, the same order
  const AucDifference none = auc_difference(all, same, 1);
  EXPECT_DOUBLE_EQ(none.difference, 0);
  EXPECT_DOUBLE_EQ(none.interval.low, 0);
  EXPECT_DOUBLE_EQ(none.interval.high, 0);
  const AucDifference better = auc_difference(all, noisy, 1);
  EXPECT_NEAR(better.difference, auc_of(all) - auc_of(noisy), 1e-12);
  EXPECT_GT(better.interval.low, 0);
  EXPECT_LT(better.interval.low, better.difference);
  EXPECT_GT(better.interval.high, better.difference);
}

TEST(TrialStatistics, CalibrationCountsEachTrialOnce) {
  const std::vector<EffortTrial> trials{{0, true},  {0.05, true}, {0.1, false}, {0.99, true},    {1, false},
                                        {3, false}, {4, true},    {50, false},  {HUGE_VAL, true}};
  const std::vector<CalibrationBin> bins = calibration_bins(trials);
  std::size_t all = 0;
  for (const CalibrationBin& bin : bins) all += bin.held.of;
  EXPECT_EQ(all, trials.size());
  EXPECT_EQ(bins.front().held.of, 2u);
  EXPECT_EQ(bins.front().held.yes, 2u);
  EXPECT_DOUBLE_EQ(bins.front().mean, 0.025);
  EXPECT_EQ(bins[1].held.of, 1u);  // 0.1 begins the second
  EXPECT_EQ(bins.back().held.of, 3u);
  EXPECT_EQ(bins.back().held.yes, 2u);
  EXPECT_DOUBLE_EQ(bins.back().mean, 27);  // of the finite ones
}

TEST(TrialStatistics, ConfusionByHand) {
  const Confusion counts =
      confusion_of(std::vector<EffortTrial>{{0.2, true}, {1, true}, {0.9, false}, {1.1, true}, {HUGE_VAL, false}});
  EXPECT_EQ(counts.held_as_said, 2u);
  EXPECT_EQ(counts.lost_though_said, 1u);
  EXPECT_EQ(counts.held_though_not, 1u);
  EXPECT_EQ(counts.lost_as_said, 1u);
  EXPECT_DOUBLE_EQ(counts.right().share, 0.6);
}

}  // namespace
}  // namespace wholehand

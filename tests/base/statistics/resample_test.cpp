// SPDX-License-Identifier: MIT
#include "base/statistics/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

TEST(Interval, PercentilesLieBetweenValues) {
  const std::vector<double> values{0, 1, 2, 3, 4};
  EXPECT_EQ(percentile_of(values, 0), 0);
  EXPECT_EQ(percentile_of(values, 1), 4);
  EXPECT_NEAR(percentile_of(values, 0.6), 2.4, 1e-15);
  const Interval interval = percentile_interval(std::vector<double>{4, 2, 0, 3, 1});
  EXPECT_NEAR(interval.low, 0.1, 1e-15);
  EXPECT_NEAR(interval.high, 3.9, 1e-15);
  EXPECT_TRUE(std::isnan(percentile_interval({}).low));
}

// Wilson's interval as textbooks have it, for 8 of 10, and at both ends.
TEST(Interval, OfAShareIsWilsons) {
  const Share most = share_of(8, 10);
  EXPECT_DOUBLE_EQ(most.share, 0.8);
  EXPECT_NEAR(most.interval.low, 0.4901625, 1e-6);
  EXPECT_NEAR(most.interval.high, 0.9433178, 1e-6);
  const Share none = share_of(0, 20);
  EXPECT_DOUBLE_EQ(none.interval.low, 0);
  EXPECT_NEAR(none.interval.high, 0.1611252, 1e-6);
  const Share all = share_of(20, 20);
  EXPECT_NEAR(all.interval.low, 1 - 0.1611252, 1e-6);
  EXPECT_DOUBLE_EQ(all.interval.high, 1);
  EXPECT_TRUE(std::isnan(share_of(0, 0).share));
}

// The mean of 25 of numbers 0 to 9999: about 5000 with a deviation of 10000 / sqrt(12 x 25).
TEST(Resample, IntervalsOfAMeanAreThoseOfTheCentralLimit) {
  const auto mean = [](std::span<const std::size_t> members) {
    double sum = 0;
    for (const std::size_t member : members) sum += static_cast<double>(member);
    return sum / static_cast<double>(members.size());
  };
  const Interval interval = resampled_interval(10000, 25, 4000, 1, mean);
  const double deviation = 10000 / std::sqrt(12.0 * 25);
  // a percentile of 4,000 samples has a deviation of 0.04 of that
  EXPECT_NEAR(interval.low, 4999.5 - NORMAL_95 * deviation, 0.2 * deviation);
  EXPECT_NEAR(interval.high, 4999.5 + NORMAL_95 * deviation, 0.2 * deviation);
}

TEST(Resample, SamplesAreTheSeeds) {
  const auto first = [](std::span<const std::size_t> members) { return static_cast<double>(members[0]); };
  EXPECT_EQ(resampled_values(100, 3, 20, 7, first), resampled_values(100, 3, 20, 7, first));
  EXPECT_NE(resampled_values(100, 3, 20, 7, first), resampled_values(100, 3, 20, 8, first));
  for (const double member : resampled_values(3, 1, 1000, 7, first)) EXPECT_LT(member, 3);
}

TEST(Resample, LeavesOutSamplesWithoutTheStatistic) {
  const auto rarely = [](double share) {
    return
        [share](std::span<const std::size_t> members) { return static_cast<double>(members[0]) < share * 100 ? 1 : std::nan(""); };
  };
  // 98 % and 80 % of the samples have a value, give or take three deviations: 3 and 8.5 %
  EXPECT_EQ(resampled_interval(100, 1, 200, 1, rarely(0.98)).low, 1);
  EXPECT_TRUE(std::isnan(resampled_interval(100, 1, 200, 1, rarely(0.8)).low));
}

// An 80th value is below the second of 79, in any order, in 2 of 80 cases.
TEST(SampleInterval, GoesFromTheSecondOf79ToTheLastButOne) {
  std::vector<double> values;
  for (int k = 0; k < 79; ++k) values.push_back((17 * k) % 79);
  EXPECT_EQ(sample_interval(values).low, 1);
  EXPECT_EQ(sample_interval(values).high, 77);
  values.pop_back();
  EXPECT_EQ(sample_interval(values).low, 0) << "a second of 78 would leave more than 5 % outside";
}

// A further uniform value is in the interval with the probability of its width. Its mean over 4,000 intervals has an error of 0.0003 at 200 values.
TEST(SampleInterval, HoldsAFurtherValueIn95Percent) {
  std::uint64_t state = 1;
  for (const std::size_t count : {39u, 200u, 1000u}) {
    double width = 0;
    std::vector<double> values(count);
    for (int repeat = 0; repeat < 4000; ++repeat) {
      for (double& value : values) value = unit_interval(split_mix(state));
      const Interval interval = sample_interval(values);
      width += (interval.high - interval.low) / 4000;
    }
    EXPECT_NEAR(width, 0.95, 0.0015) << count;
  }
}

// 19 of 20 are 95 %.
TEST(SampleInterval, NeedsAValueIn95PercentOfTheSamples) {
  std::vector<std::vector<double>> samples;
  for (int k = 0; k < 20; ++k)
    samples.push_back({7, k == 11 ? std::nan("") : 3, k == 2 || k == 19 ? std::nan("") : 5, std::nan("")});
  const std::vector<Interval> intervals = sample_intervals(samples);
  ASSERT_EQ(intervals.size(), 4u);
  EXPECT_EQ(intervals[0].low, 7);
  EXPECT_EQ(intervals[1].low, 3);
  EXPECT_EQ(intervals[1].high, 3);
  EXPECT_TRUE(std::isnan(intervals[2].low));
  EXPECT_TRUE(std::isnan(intervals[3].high));
}

}  // namespace
}  // namespace wholehand

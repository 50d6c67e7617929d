// SPDX-License-Identifier: MIT
// sanitizers: address
#include "evidence/trials/sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "evidence/trials/cases.h"
#include "tests/support/refusal.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

std::vector<Candidate> graded_grips(std::size_t count) {
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(count);
    all.push_back({0.2 + 0.6 * x * x, i});  // few have a good score
  }
  return all;
}

std::array<std::size_t, SCORE_STRATA> by_stratum(const std::vector<Candidate>& grips) {
  std::array<std::size_t, SCORE_STRATA> counts{};
  for (const Candidate& one : grips) ++counts[std::min<std::size_t>(9, static_cast<std::size_t>((one.score - 0.2) / 0.6 * 10))];
  return counts;
}

TEST(TrialSample, EveryPartOfTheRangeGivesAsMany) {
  const auto sample = stratified_sample(graded_grips(5000), 100, 0, 1);
  ASSERT_EQ(sample.size(), 100u);
  for (const std::size_t count : by_stratum(sample)) EXPECT_NEAR(static_cast<double>(count), 10, 1);
  std::set<std::uint64_t> different;
  for (const Candidate& one : sample) different.insert(one.index);
  EXPECT_EQ(different.size(), sample.size());
}

TEST(TrialSample, PartsThatHaveFewGiveAll) {
  auto grips = graded_grips(5000);
  std::erase_if(grips, [](const Candidate& one) { return one.score > 0.5 && one.index % 500 != 0; });
  const auto before = by_stratum(grips), taken = by_stratum(stratified_sample(grips, 100, 0, 1));
  std::size_t all = 0;
  for (std::size_t k = 0; k < SCORE_STRATA; ++k) {
    all += taken[k];
    if (before[k] < 10) {
      EXPECT_EQ(taken[k], before[k]) << k;
    }
  }
  EXPECT_EQ(all, 100u);
  EXPECT_EQ(stratified_sample(graded_grips(30), 100, 0, 1).size(), 30u);
  EXPECT_TRUE(stratified_sample({}, 100, 0, 1).empty());
  EXPECT_TRUE(stratified_sample(graded_grips(30), 0, 0, 1).empty());
  EXPECT_EQ(stratified_sample({{0.5, 3}, {0.5, 4}}, 1, 0, 1).size(), 1u) << "all scores are one";
}

// The seed alone draws, whatever the order in which a machine found the grips.
TEST(TrialSample, TheSeedAloneDraws) {
  auto grips = graded_grips(1000);
  const auto numbers = [](const std::vector<Candidate>& sample) {
    std::vector<std::uint64_t> all;
    for (const Candidate& one : sample) all.push_back(one.index);
    return all;
  };
  const auto first = numbers(stratified_sample(grips, 50, 1, 7));
  std::reverse(grips.begin(), grips.end());
  EXPECT_EQ(numbers(stratified_sample(grips, 50, 1, 7)), first);
  EXPECT_NE(numbers(stratified_sample(grips, 50, 1, 8)), first);
  EXPECT_NE(numbers(stratified_sample(grips, 50, 2, 7)), first);
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
}

TEST(TrialSample, OfManyGripsOneOfEachStretchIsLookedAt) {
  EXPECT_EQ(looked_at(5, 10, 0, 1), (std::vector<std::uint64_t>{0, 1, 2, 3, 4}));
  const std::uint64_t grips = 100'000'000'003;
  const auto numbers = looked_at(grips, 1000, 0, 1);
  ASSERT_EQ(numbers.size(), 1000u);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    EXPECT_GE(numbers[k], grips / 1000 * k);
    EXPECT_LE(numbers[k], grips / 1000 * (k + 1) + 3);
  }
  EXPECT_LT(numbers.back(), grips);
}

Scene few_grips() {
  Scene scene = three_beakers();
  scene.strength = StrengthData{};
  scene.grips.height = axis_of(0.3, 0.9, 5);
  scene.grips.obliquity = axis_of(0, radians(10), 2);
  scene.grips.roll = axis_of(radians(-60), 0, 4);
  return scene;
}

TEST(TrialSample, BestAndSampleAreToldApart) {
  const Scene scene = few_grips();
  const sweeps::Plan plan(scene, false);
  const std::shared_ptr<const Evaluator> core = make_core_evaluator(scene);
  TrialOptions options;
  options.best = 2;
  options.grips = 10;
  const std::atomic<bool> stop = false;
  const auto grips = choose_trial_grips({scene, plan, core}, options, stop);
  std::set<std::pair<std::size_t, std::uint64_t>> different;
  std::array<std::size_t, 2> counts{};
  for (const TrialGrip& grip : grips) {
    different.insert({grip.vessel, grip.number});
    ++counts[static_cast<std::size_t>(grip.sample)];
    GripResult result;
    core->grip(grip.vessel, grip.grip, result);
    EXPECT_EQ(result.reason, Reason::none);
    EXPECT_TRUE(result.plausible);
    EXPECT_NEAR(core->score(grip.vessel, grip.grip, result).score, grip.score, 1e-12);
  }
  EXPECT_EQ(different.size(), grips.size());
  EXPECT_EQ(counts[0], 6u);
  EXPECT_EQ(counts[1], 10u);
  // the best is better than all others of its vessel
  for (const TrialGrip& grip : grips)
    if (grip.vessel == grips[0].vessel) {
      EXPECT_LE(grip.score, grips[0].score);
    }
  options.vessel = 1;
  for (const TrialGrip& grip : choose_trial_grips({scene, plan, core}, options, stop)) EXPECT_EQ(grip.vessel, 1u);
}

std::vector<Candidate> numbered(std::uint64_t first, std::uint64_t last) {
  std::vector<Candidate> grips;
  for (std::uint64_t k = first; k < last; ++k) grips.push_back({0.1 + 0.8 * static_cast<double>(k - first) / 100, k});
  return grips;
}

std::size_t deep_ones(const std::vector<Candidate>& chosen) {
  return static_cast<std::size_t>(
      std::count_if(chosen.begin(), chosen.end(), [](const Candidate& one) { return one.index >= 1000; }));
}

TEST(TrialSample, OneOfFiveBeginsTooDeep) {
  const auto parts = [](std::uint64_t usual, std::uint64_t deep) {
    return PartedByDepth{numbered(0, usual), numbered(1000, 1000 + deep)};
  };
  const auto chosen = sample_of_parts(parts(100, 100), 50, 0, 1);
  EXPECT_EQ(chosen.size(), 50u);
  EXPECT_EQ(deep_ones(chosen), 10u);
  EXPECT_TRUE(
      std::is_sorted(chosen.begin(), chosen.end(), [](const Candidate& a, const Candidate& b) { return a.index < b.index; }));
  EXPECT_EQ(deep_ones(sample_of_parts(parts(20, 100), 50, 0, 1)), 30u) << "there are too few others";
  EXPECT_EQ(deep_ones(sample_of_parts(parts(100, 4), 50, 0, 1)), 4u);
  EXPECT_EQ(sample_of_parts(parts(100, 4), 50, 0, 1).size(), 50u);
  EXPECT_EQ(sample_of_parts(parts(10, 4), 50, 0, 1).size(), 14u) << "all there are";
  EXPECT_EQ(sample_of_parts(parts(0, 0), 50, 0, 1).size(), 0u);
}

TEST(TrialSample, DeepGripsAreThoseTheCoreFindsDeep) {
  const Scene scene = few_grips();
  const sweeps::Plan plan(scene, false);
  const std::shared_ptr<const Evaluator> core = make_core_evaluator(scene);
  const std::atomic<bool> stop = false;
  const TrialOptions options;
  const auto eligible = plausible_by_core(scene, plan, core, 0, options, stop);
  const PartedByDepth parts = parted_by_depth(scene, plan, core, 0, eligible, options, stop);
  EXPECT_EQ(parts.usual.size() + parts.deep.size(), eligible.size());
  EXPECT_GT(parts.usual.size(), 3u);
  EXPECT_GT(parts.deep.size(), 3u);
  const auto depth = [&](const Candidate& one) {
    GripResult found;
    core->grip(0, plan.grip(0, one.index), found);
    return std::max(found.phalanx_depth, found.palm_depth);
  };
  for (const Candidate& one : parts.usual) EXPECT_LE(depth(one), options.settings.start_overlap);
  for (const Candidate& one : parts.deep) EXPECT_GT(depth(one), options.settings.start_overlap);
}

TEST(TrialSample, NoFeasibleGripIsRefused) {
  Scene scene = few_grips();
  scene.hand.depth_limit = 0;
  scene.grips.height = Axis{{0.01}};  // under the clearance of the table
  scene.table = TableData{};
  const sweeps::Plan plan(scene, false);
  const std::atomic<bool> stop = false;
  const std::shared_ptr<const Evaluator> core = make_core_evaluator(scene);
  EXPECT_NE(refusal_line([&] {
              choose_trial_grips({scene, plan, core}, {}, stop);
            }).find("no grip is feasible"),
            std::string::npos);
}

// ---- states ----

TEST(TrialCases, SpreadOverTheSceneByDefault) {
  const Scene scene = three_beakers();
  const auto core = make_core_evaluator(scene);
  EXPECT_EQ(usual_fills(scene, *core, 0), (std::vector<double>{0.25, 0.75, 1}));
  const auto tilts = usual_tilts(scene);
  ASSERT_EQ(tilts.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(degrees(tilts[k]), 50.0 * static_cast<double>(k), 1e-9);
  TrialOptions options;
  options.six_forces = true;
  const auto cases = trial_cases(scene, *core, 0, options);
  ASSERT_EQ(cases.size(), 3u * 4 + 2 * 6);
  EXPECT_EQ(cases[5].fill, 0.75);
  EXPECT_NEAR(cases[5].tilt, radians(50), 1e-12);
  EXPECT_EQ(cases[12].protocol, TrialProtocol::six_forces);
  EXPECT_EQ(cases[12].fill, 1);
  EXPECT_EQ(cases[19].direction, 1);
  EXPECT_EQ(cases[19].material, 1);
}

TEST(TrialCases, WithoutLiquidThereIsOneFill) {
  Scene scene = three_beakers();
  scene.liquid.reset();
  const auto core = make_core_evaluator(scene);
  EXPECT_EQ(usual_fills(scene, *core, 0), (std::vector<double>{0}));
  TrialOptions options;
  EXPECT_EQ(trial_cases(scene, *core, 0, options).size(), 4u);
  options.fills = {0.5};
  EXPECT_NE(refusal_line([&] { trial_cases(scene, *core, 0, options); }).find("vessel 'beaker1' holds no liquid"),
            std::string::npos);
}

TEST(TrialCases, AVesselThatHoldsNoneHasOneFillToo) {
  Scene scene = three_beakers();
  scene.vessels[1].wall = 0;
  scene.vessels[1].mass = 0.2;
  const auto core = make_core_evaluator(scene);
  EXPECT_EQ(usual_fills(scene, *core, 0).size(), 3u);
  EXPECT_EQ(usual_fills(scene, *core, 1), (std::vector<double>{0}));
}

// What the scene does not count is not tried, unless it is asked for.
TEST(TrialCases, TiltsThatDoNotCountAreLeftOut) {
  Scene scene = three_beakers();
  scene.until_poured = 0.3;
  const auto core = make_core_evaluator(scene);
  TrialOptions options;
  const auto cases = trial_cases(scene, *core, 0, options);
  EXPECT_LT(cases.size(), 12u);
  options.tilts = usual_tilts(scene);
  EXPECT_EQ(trial_cases(scene, *core, 0, options).size(), 12u);
}

// What a result of single precision may list, and the core does not find.
TEST(TrialSample, GripsThatAreNoneByTheCoreGo) {
  Scene scene = three_beakers();
  scene.strength = StrengthData{};
  const auto core = make_core_evaluator(scene);
  TrialGrip good, below, far;
  good.number = 1;
  good.grip.height = 0.07;
  good.grip.roll = radians(-35);
  below.grip.height = -0.05;  // through the table
  far.grip.height = 0.07;
  far.grip.offset = 0.5;  // beside the vessel
  std::vector<TrialGrip> grips{below, good, far};
  EXPECT_EQ(remove_impossible(*core, grips), 2u);
  ASSERT_EQ(grips.size(), 1u);
  EXPECT_EQ(grips[0].number, 1u);
}

// Pushes take longer than tilts, so that there are fewer grips of them.
TEST(TrialSample, QuickTrialsOfBothProtocolsHaveFewerGrips) {
  TrialOptions tilted, both;
  both.six_forces = true;
  make_quick(tilted);
  make_quick(both);
  EXPECT_LE(4 * both.grips, tilted.grips);
  EXPECT_LT(both.best, tilted.best);
  EXPECT_GT(both.best, 0u);
}

}  // namespace
}  // namespace wholehand

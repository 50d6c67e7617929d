// SPDX-License-Identifier: MIT
// The box of a grip, the search in it against functions whose largest value is known, and refined grips of a real scene.
// sanitizers: address
#include "sweeps/lists/refine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/text/error.h"
#include "sweeps/result/result_contents.h"
#include "sweeps/result/sweep_result.h"
#include "sweeps/run/run.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/scene_texts.h"
#include "tests/support/sweep_results.h"

namespace wholehand::sweeps {
namespace {

using Place = std::array<double, REFINED_COORDINATES>;

TEST(Refine, ABoxEndsHalfWayToTheNeighborsAndNeverBeyondTheAxis) {
  Scene scene = fake_scene();
  scene.vessels[0].mass = 0.1;  // with its mass off the axis, so that azimuth matters
  scene.vessels[0].center_of_mass = {0.01, 0, 0};
  scene.grips.height_is_fraction = false;
  scene.grips.roll = Axis{};
  scene.grips.roll.values = {0.5, -1, 0.1};  // in no order, at unequal steps
  scene.grips.hand_scale.values = {0.9, 1.1};
  const Plan plan(scene, false);
  for (std::uint64_t i = 0; i < plan.grips(); ++i) {
    const GripInput grip = plan.grip(0, i);
    const RefineBox box = refine_box(plan, 0, i);
    const Place place = coordinates_of(grip);
    for (std::size_t k = 0; k < place.size(); ++k) {
      EXPECT_LE(box.low[k], place[k]);
      EXPECT_GE(box.high[k], place[k]);
    }
    const double height_step = 0.8 / 6, turn_step = radians(45);
    EXPECT_NEAR(box.low[0], std::max(0.1, grip.height - height_step / 2), 1e-12);
    EXPECT_NEAR(box.high[0], std::min(0.9, grip.height + height_step / 2), 1e-12);
    EXPECT_NEAR(box.low[1], std::max(0.0, grip.azimuth - turn_step / 2), 1e-12);
    EXPECT_NEAR(box.high[1], std::min(radians(90), grip.azimuth + turn_step / 2), 1e-12);
    const std::array<double, 2> roll = grip.roll == -1    ? std::array<double, 2>{-1, -0.45}
                                       : grip.roll == 0.1 ? std::array<double, 2>{-0.45, 0.3}
                                                          : std::array<double, 2>{0.3, 0.5};
    EXPECT_NEAR(box.low[3], roll[0], 1e-12);
    EXPECT_NEAR(box.high[3], roll[1], 1e-12);
    EXPECT_NEAR(box.low[4], grip.offset == 0 ? 0 : 2.5e-3, 1e-12);
    EXPECT_NEAR(box.high[4], grip.offset == 0 ? 2.5e-3 : 5e-3, 1e-12);
  }
}

TEST(Refine, WhatHasOneValueOrChangesNothingStays) {
  Scene scene = fake_scene();
  scene.grips.obliquity.values = {0.2};
  scene.grips.obliquity.is_range = false;
  for (const bool keeps_vectors : {false, true}) {
    const Plan plan(scene, keeps_vectors);
    ASSERT_TRUE(plan.is_symmetric());
    for (std::uint64_t i = 0; i < plan.grips(); i += 17) {
      const RefineBox box = refine_box(plan, 0, i);
      for (const std::size_t k : {1, 2}) EXPECT_EQ(box.low[k], box.high[k]);
      EXPECT_EQ(box.low[2], 0.2);
    }
  }
}

TEST(Refine, HeightsInFractionsAreMovedInTheVesselsMeters) {
  Scene scene = fake_scene();
  scene.grips.height_is_fraction = true;
  scene.vessels[1].base = 0.02;
  const Plan plan(scene, false);
  for (std::uint64_t i = 0; i < plan.grips(); i += 13) {
    const RefineBox box = refine_box(plan, 1, i);
    double fraction = 0;
    plan.coordinates(PLACE_HEIGHT, i, 1, &fraction);
    EXPECT_NEAR(box.high[0], 0.02 + std::min(0.9, fraction + 0.4 / 6) * (scene.vessels[1].height - 0.02), 1e-12);
  }
}

TEST(Refine, SobolPointsMoveByHalfOfTheirMeanSpacing) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.height_is_fraction = false;
  scene.grips.count = 256;  // of four ranges: 4 to each
  const Plan plan(scene, false);
  for (std::uint64_t i = 0; i < plan.grips(); ++i) {
    const GripInput grip = plan.grip(0, i);
    const RefineBox box = refine_box(plan, 0, i);
    EXPECT_NEAR(box.low[0], std::max(0.1, grip.height - 0.1), 1e-12);
    EXPECT_NEAR(box.high[0], std::min(0.9, grip.height + 0.1), 1e-12);
    EXPECT_NEAR(box.high[4], grip.offset == 0 ? 2.5e-3 : 5e-3, 1e-12) << "a list of values";
  }
}

TEST(Refine, TheSearchFindsTheLargestOfASimpleHill) {
  RefineBox box;
  box.low = {-1, -2, 0, -1e-3, 5};
  box.high = {1, 2, 0, 3e-3, 7};
  const Place start{0, 0, 0, 1e-3, 5};  // the last at the end of its box
  // the top lies inside, on an end, and nowhere else: one coordinate after the other
  const Place top{0.5, -2, 0, 1e-3, 6};
  int calls = 0;
  const auto hill = [&](const Place& place) {
    ++calls;
    double sum = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
      EXPECT_GE(place[k], box.low[k]);
      EXPECT_LE(place[k], box.high[k]);
      const double length = box.high[k] - box.low[k];
      if (length > 0) sum += std::pow((place[k] - top[k]) / length, 2);
    }
    return 1 - sum;
  };
  const RefinedPlace found = search_box(start, box, hill);
  EXPECT_EQ(found.evaluations, calls);
  EXPECT_LE(calls, REFINE_EVALUATIONS);
  EXPECT_EQ(found.score, 1) << "every coordinate of the top is a whole number of half steps away";
  for (std::size_t k = 0; k < top.size(); ++k) EXPECT_NEAR(found.place[k], top[k], 1e-12) << k;
}

TEST(Refine, TheSearchIsBoundedNeverWorseAndEndsOnAPlain) {
  RefineBox box;
  box.low.fill(-1);
  box.high.fill(1);
  int calls = 0;
  // each call scores more: the search would never end by itself
  const RefinedPlace rising = search_box({}, box, [&](const Place&) { return static_cast<double>(++calls); });
  EXPECT_LE(rising.evaluations, REFINE_EVALUATIONS);
  EXPECT_EQ(rising.score, calls);
  const RefinedPlace falling = search_box({}, box, [&](const Place&) { return static_cast<double>(-++calls); });
  EXPECT_EQ(falling.place, Place{}) << "nothing scores more than the start";
  const RefinedPlace plain = search_box({}, box, [](const Place&) { return 0.5; });
  EXPECT_EQ(plain.place, Place{});
  EXPECT_EQ(plain.evaluations, 1 + 4 * 2 * REFINED_COORDINATES) << "four steps, both ways";
  RefineBox point;
  EXPECT_EQ(search_box({}, point, [](const Place&) { return 0.5; }).evaluations, 1) << "nowhere to go";
}

// Refined grips of a real scene: inside their boxes, with the score that the core gives them, and not below the core's own of the
// grip.
TEST(Refine, RefinedGripsHaveTheScoreThatIsSaid) {
  const Scene scene = scene_from(edited(RESULT_SCENE, "apart_mm = 0", "apart_mm = 25"));
  const Plan plan(scene, false);
  const auto core = make_core_evaluator(scene);
  std::vector<std::vector<BestGrip>> lists(scene.vessels.size());
  std::size_t higher = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    for (std::uint64_t i = 0; i < plan.grips(); i += 5) {
      BestGrip best;
      best.candidate = {0.5, i};
      best.grip = plan.grip(v, i);
      lists[v].push_back(best);
    }
  }
  auto again = lists;
  refine_lists(*core, scene, plan, 1, lists);
  refine_lists(*core, scene, plan, 2, again);
  for (std::size_t v = 0; v < lists.size(); ++v) {
    for (std::size_t k = 0; k < lists[v].size(); ++k) {
      const BestGrip& best = lists[v][k];
      EXPECT_EQ(best.candidate.index, 5 * k) << "the order stays";
      if (std::isnan(best.refined_score)) continue;
      EXPECT_EQ(best.refined_score, again[v][k].refined_score) << "on any number of threads";
      EXPECT_EQ(coordinates_of(best.refined), coordinates_of(again[v][k].refined));
      EXPECT_EQ(best.refined.hand_scale, best.grip.hand_scale);
      const RefineBox box = refine_box(plan, v, best.candidate.index);
      const Place place = coordinates_of(best.refined);
      for (std::size_t c = 0; c < place.size(); ++c) {
        EXPECT_GE(place[c], box.low[c]);
        EXPECT_LE(place[c], box.high[c]);
      }
      GripResult result;
      core->grip(v, best.refined, result);
      EXPECT_TRUE(result.plausible);
      EXPECT_EQ(core->score(v, best.refined, result).score, best.refined_score);
      core->grip(v, best.grip, result);
      if (result.reason != Reason::none || !result.plausible) continue;
      EXPECT_GE(best.refined_score, core->score(v, best.grip, result).score);
      higher += best.refined_score > core->score(v, best.grip, result).score;
    }
  }
  EXPECT_GT(higher, 5u);
}

TEST(Refine, ItEndsBetweenGripsWhereThatIsAskedFor) {
  const Scene scene = scene_from(RESULT_SCENE);
  const Plan plan(scene, false);
  const auto core = make_core_evaluator(scene);
  std::vector<std::vector<BestGrip>> lists(scene.vessels.size());
  for (std::uint64_t i = 0; i < 9; ++i) {
    BestGrip best;
    best.candidate = {0.5, i};
    best.grip = plan.grip(0, i);
    lists[0].push_back(best);
  }
  auto whole = lists;
  EXPECT_TRUE(refine_lists(*core, scene, plan, 1, whole));
  int looks = 0;
  EXPECT_FALSE(refine_lists(*core, scene, plan, 1, lists, [&] { return ++looks == 4; }));
  EXPECT_EQ(looks, 4);
  for (std::size_t k = 0; k < lists[0].size(); ++k) {
    if (k >= 3 || std::isnan(whole[0][k].refined_score)) {
      EXPECT_TRUE(std::isnan(lists[0][k].refined_score)) << k;
    }
  }
}

TEST(Refine, ASweepSaysBothScoresAndTheResultGivesTheGripsBack) {
  const TemporaryFolder folder;
  const Scene scene = scene_from(RESULT_SCENE);
  const auto core = make_core_evaluator(scene);
  std::vector<double> grips;
  for (const bool refine : {true, false}) {
    const SweepOptions options{.output = folder / "a.nc", .on = "core", .list = {.is_wide = true}, .refine = refine};
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_sweep(scene, options), ExitCode::done);
    const std::string out = testing::internal::GetCapturedStdout();
    EXPECT_EQ(out.find("refined") != std::string::npos, refine) << out;
    if (refine) grips = read_values(options.output, BEST_GRIP);
    EXPECT_EQ(read_values(options.output, BEST_GRIP), grips) << "the order is that of the sweep's scores";
    const auto scores = read_values(options.output, REFINED_SCORE), heights = read_values(options.output, "best_refined_height");
    SweepResult result(options.output);
    const Plan plan(scene, keeps_vectors(result.variables()));
    result.use(scene, plan);
    std::size_t there = 0;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const auto refined = result.refined(v);
      ASSERT_EQ(refined.size(), result.best(v).size());
      for (std::size_t rank = 0; rank < refined.size(); ++rank) {
        const std::size_t at = v * static_cast<std::size_t>(scene.output.best) + rank;
        EXPECT_EQ(refined[rank].has_value(), !std::isnan(scores[at]));
        if (!refined[rank]) continue;
        ++there;
        EXPECT_EQ(refined[rank]->grip.height, heights[at]);
        EXPECT_EQ(refined[rank]->score, scores[at]);
        GripResult answer;
        core->grip(v, refined[rank]->grip, answer);
        EXPECT_EQ(core->score(v, refined[rank]->grip, answer).score, scores[at]) << "all five coordinates are there, to the bit";
        EXPECT_GE(scores[at], result.best(v)[rank].score - 1e-12) << "the sums of a score's terms may be rounded apart";
      }
    }
    EXPECT_EQ(there > 0, refine);
  }
}

TEST(Refine, ADamagedRefinedGripIsRefused) {
  SweptScene swept(RESULT_SCENE);
  ASSERT_FALSE(swept.result->best(0).empty());
  EXPECT_FALSE(swept.result->refined(0)[0]);
  swept.change(REFINED_SCORE, {0.9});  // and its place is missing
  try {
    swept.result->refined(0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("names a grip that the sweep did not refine"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace wholehand::sweeps

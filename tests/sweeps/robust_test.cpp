// SPDX-License-Identifier: MIT
// Robust scores: the normal quantile and the percentile in closed form, the deviations as samples, and the scores of whole sweeps against a
// brute-force evaluation, in the file, in the list, in `rank` and after a break.
// sanitizers: address
#include "sweeps/robust.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <sstream>

#include "app/paths.h"
#include "core/core_backend.h"
#include "host/open_backend.h"
#include "scene/reader.h"
#include "sweeps/rank.h"
#include "sweeps/sweep_result.h"
#include "tests/support/scenes.h"
#include "tests/support/sweep_trial.h"

namespace wholehand {
namespace {

TEST(Robust, NormalQuantilesInvertTheErrorFunction) {
  for (double p = 1e-12; p < 1; p = p < 0.01 ? p * 1.7 : p + 0.0031) {
    const double x = normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)), p, 1e-12 * std::max(p, 1e-3)) << p;
    if (p > 1e-3) {
      EXPECT_NEAR(normal_quantile(1 - p), -x, 1e-11);
    }
  }
  EXPECT_EQ(normal_quantile(0.5), 0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_EQ(normal_quantile(0), -INFINITY);
  EXPECT_EQ(normal_quantile(1), INFINITY);
}

TEST(Robust, PercentilesLieBetweenScores) {
  EXPECT_EQ(robust_score({0.5}).low, 0.5);
  EXPECT_EQ(robust_score({0.5}).mean, 0.5);
  const RobustScore ten = robust_score({9, 1, 8, 2, 7, 3, 6, 4, 5, 0});  // 0.9 of the way from 0 to 1
  EXPECT_NEAR(ten.low, 0.9, 1e-15);
  EXPECT_EQ(ten.mean, 4.5);
  EXPECT_EQ(robust_score({3, 1, 2, 0, 4, 5, 6, 7, 8, 9, 10}).low, 1);  // eleven: the second
}

RobustData wide_spread() {
  RobustData robust;
  robust.height = 3e-3;
  robust.azimuth = 0.1;
  robust.obliquity = 0.05;
  robust.roll = 0.2;
  robust.offset = 2e-3;
  robust.hand_scale = 0.04;
  return robust;
}

// Means and standard deviations of the samples: those of normal ones, to what 4,096 points of a Sobol sequence leave.
TEST(Robust, DeviationsHaveTheSpreadThatIsAskedFor) {
  RobustData robust = wide_spread();
  robust.count = 4096;
  const auto check = [&](double asked, const auto& value) {
    double sum = 0, squares = 0;
    const std::vector<Deviation> all = deviations(robust);
    for (const Deviation& one : all) {
      sum += value(one);
      squares += value(one) * value(one);
    }
    EXPECT_NEAR(sum / 4096, 0, 0.01 * asked);
    EXPECT_NEAR(std::sqrt(squares / 4096), asked, 0.01 * asked);
  };
  check(robust.height, [](const Deviation& d) { return d.added.height; });
  check(robust.azimuth, [](const Deviation& d) { return d.added.azimuth; });
  check(robust.obliquity, [](const Deviation& d) { return d.added.obliquity; });
  check(robust.roll, [](const Deviation& d) { return d.added.roll; });
  check(robust.offset, [](const Deviation& d) { return d.added.offset; });
  check(robust.hand_scale, [](const Deviation& d) { return d.hand_factor - 1; });
  robust.hand_scale = 0.3;
  robust.seed = 2;
  for (const Deviation& one : deviations(robust)) EXPECT_GE(one.hand_factor, LEAST_HAND_FACTOR);
  RobustData other = robust;
  EXPECT_EQ(deviations(other)[7].added.roll, deviations(robust)[7].added.roll);
  other.seed = 3;
  EXPECT_NE(deviations(other)[7].added.roll, deviations(robust)[7].added.roll);
}

TEST(Robust, FrictionsAreEightEqualParts) {
  Scene scene = scene_of({beaker1()});
  scene.force.friction = 0.6;
  scene.robust = RobustData{};
  EXPECT_EQ(robust_frictions(scene), std::vector<double>{0.6});
  scene.robust->friction = 0.1;
  const std::vector<double> levels = robust_frictions(scene);
  ASSERT_EQ(levels.size(), 8u);
  EXPECT_NEAR(std::accumulate(levels.begin(), levels.end(), 0.0) / 8, 0.6, 1e-12);
  EXPECT_NEAR(levels[7], 0.6 + 0.1 * 1.5341205443525463, 1e-9);
  scene.robust->friction = 1;
  EXPECT_EQ(robust_frictions(scene)[0], 0);
}

// Every score by itself, from the grip with the deviation and in a scene with the friction of its eighth.
std::vector<double> scores_by_hand(const Scene& scene, std::size_t vessel, const GripInput& grip) {
  const std::vector<Deviation> all = deviations(*scene.robust);
  const std::vector<double> frictions = robust_frictions(scene);
  std::vector<double> scores;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Scene other = scene;
    other.force.friction = frictions[i * frictions.size() / all.size()];
    const auto core = make_core_evaluator(other);
    GripResult result;
    const GripInput moved = deviated(grip, all[i]);
    core->grip(vessel, moved, result);
    scores.push_back(core->score(vessel, moved, result).score);
  }
  return scores;
}

Scene small_scene() {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  scene.vessels.resize(2);
  scene.liquid->fills = {0, 1};
  scene.tilts = {0, radians(60)};
  scene.grips.height.values = {0.5, 0.7};
  scene.grips.roll.values = {radians(-30), radians(0)};
  scene.grips.obliquity.values = {0, radians(10)};
  scene.grips.height.is_range = scene.grips.roll.is_range = scene.grips.obliquity.is_range = false;
  scene.output.best = 2;
  scene.robust = wide_spread();
  scene.robust->count = 24;
  return scene;
}

std::vector<std::vector<BestGrip>> two_lists(const Scene& scene) {
  std::vector<std::vector<BestGrip>> lists(scene.vessels.size());
  const Plan plan(scene, true);
  for (std::size_t v = 0; v < lists.size(); ++v)
    for (const std::uint64_t grip : {1u, 5u}) {
      BestGrip best;
      best.candidate.index = grip;
      best.grip = plan.grip(v, grip);
      lists[v].push_back(best);
    }
  return lists;
}

OpenBackend opens(const std::string& on, Precision precision, int threads = 0) {
  return [=](const Scene& scene, const FieldSet& fields) { return open_backend(scene, fields, on, precision, threads); };
}

TEST(Robust, ScoresAreThoseOfEveryDeviationByItself) {
  for (const double friction : {0.0, 0.2}) {
    Scene scene = small_scene();
    scene.robust->friction = friction;
    const Plan plan(scene, true);
    auto lists = two_lists(scene);
    add_robust_scores(opens("core", Precision::full), scene, plan, lists);
    auto alone = two_lists(scene);
    add_robust_scores(opens("core", Precision::full, 1), scene, plan, alone);
    bool is_between = false;
    for (std::size_t v = 0; v < lists.size(); ++v)
      for (std::size_t rank = 0; rank < lists[v].size(); ++rank) {
        const RobustScore expected = robust_score(scores_by_hand(scene, v, lists[v][rank].grip));
        // a score state by state and one of the search for the worst state are each to 1e-3 of an effort, of which it has 0.3 x 1/4
        EXPECT_NEAR(lists[v][rank].robust_mean, expected.mean, 2e-4);
        EXPECT_NEAR(lists[v][rank].robust_low, expected.low, 2e-4);
        EXPECT_EQ(lists[v][rank].robust_mean, alone[v][rank].robust_mean) << "whatever the threads";
        EXPECT_EQ(lists[v][rank].robust_low, alone[v][rank].robust_low);
        is_between = is_between || (expected.low > 0 && expected.low < expected.mean);
      }
    EXPECT_TRUE(is_between) << "no deviation matters";
  }
}

TEST(Robust, ASmallSpreadIsTheScoreItself) {
  Scene scene = small_scene();
  scene.robust = RobustData{};
  scene.robust->roll = 1e-9;
  const Plan plan(scene, true);
  auto lists = two_lists(scene);
  add_robust_scores(opens("core", Precision::full), scene, plan, lists);
  const auto core = make_core_evaluator(scene);
  for (std::size_t v = 0; v < lists.size(); ++v)
    for (const BestGrip& best : lists[v]) {
      GripResult result;
      core->grip(v, best.grip, result);
      EXPECT_NEAR(best.robust_mean, core->score(v, best.grip, result).score, 1e-3);
      EXPECT_NEAR(best.robust_low, best.robust_mean, 1e-3);
    }
}

// In float a deviation may be plausible on one side alone, or have a point less that touches: of 24 one moves the mean by 1/24 at most.
TEST(Robust, ADeviceScoresAsTheCore) {
  const Scene scene = small_scene();
  const Plan plan(scene, true);
  auto device = two_lists(scene), core = two_lists(scene);
  add_robust_scores(opens("vulkan", Precision::single), scene, plan, device);
  add_robust_scores(opens("core", Precision::full), scene, plan, core);
  int same = 0, all = 0;
  for (std::size_t v = 0; v < core.size(); ++v)
    for (std::size_t rank = 0; rank < core[v].size(); ++rank) {
      const double difference = std::abs(device[v][rank].robust_mean - core[v][rank].robust_mean);
      EXPECT_LT(difference, 1.0 / 24);
      same += difference < 1e-3;
      ++all;
    }
  EXPECT_GE(same, all - 1);
}

// ---- of sweeps ----

using RobustRun = RunTest;

Scene robust_fake_scene() {
  Scene scene = fake_scene();
  scene.robust = wide_spread();
  scene.robust->friction = 0.05;
  scene.output.best = 6;
  return scene;
}

TEST_F(RobustRun, TheFileTheListAndRankTellTheSame) {
  const Scene scene = robust_fake_scene();
  const std::string file = reference(scene);
  const Plan plan(scene, false);
  SweepResult result(file);
  result.use(scene, plan);
  // the stand-in's scores, deviation by deviation
  const std::vector<Deviation> all = deviations(*scene.robust);
  std::vector<double> means;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto best = result.best(v);
    const auto robust = result.robust(v);
    ASSERT_EQ(best.size(), 6u);
    ASSERT_EQ(robust.size(), best.size());
    for (std::size_t rank = 0; rank < best.size(); ++rank) {
      std::vector<double> scores;
      for (const Deviation& deviation : all) {
        const GripInput grip = deviated(plan.grip(v, best[rank].index), deviation);
        const std::uint32_t status = fake_uint(v, grip, FIELD_STATUS);
        const bool counts = (status & (STATUS_REASON_MASK | STATUS_PLAUSIBLE)) == STATUS_PLAUSIBLE;
        scores.push_back(counts ? fake_real(v, grip, FIELD_SCORE, 0) : 0);
      }
      const RobustScore expected = robust_score(scores);
      EXPECT_NEAR(robust[rank][0], expected.mean, 1e-12);
      EXPECT_NEAR(robust[rank][1], expected.low, 1e-12);
      means.push_back(robust[rank][0]);
    }
  }
  const auto best_list = file_text(output_names(file).best);
  EXPECT_NE(best_list.find(",robust_mean,robust_low,grip,result,sweep\n"), std::string::npos);
  EXPECT_NE(best_list.find(fmt::format(",{:.9g},", means[0])), std::string::npos);
  RankRequest request;
  request.best = 6;
  request.apart = scene.output.apart;
  const Ranking ranking = rank_grips(result, scene, plan, request, [&] { return std::make_shared<FakeEvaluator>(scene); });
  ASSERT_EQ(ranking.lists.size(), 2u);
  for (std::size_t v = 0; v < 2; ++v) {
    const auto best = result.best(v);
    ASSERT_EQ(ranking.lists[v].size(), best.size());
    for (std::size_t rank = 0; rank < best.size(); ++rank) {
      EXPECT_EQ(ranking.lists[v][rank].candidate.index, best[rank].index) << v << " " << rank;
      EXPECT_EQ(ranking.lists[v][rank].robust_mean, means[6 * v + rank]) << v << " " << rank;
    }
  }
  EXPECT_NE(best_table(scene, plan, ranking.lists[0], 3).find("robust low"), std::string::npos);
}

TEST_F(RobustRun, AResumedSweepTellsTheSame) {
  const Scene scene = robust_fake_scene();
  const std::string whole = reference(scene);
  SweepTrial first(folder / "a.nc");
  first.scene = scene;
  int chunks = 0;
  first.before_chunk = [&] {
    if (++chunks == 3) raise(SIGINT);
  };
  EXPECT_EQ(first.run().code, ExitCode::interrupted);
  SweepTrial rest(folder / "a.nc");
  rest.scene = scene;
  rest.options.resume = true;
  EXPECT_EQ(rest.run().code, ExitCode::done);
  expect_same_as(whole, folder / "a.nc");
}

TEST_F(RobustRun, WithoutTheTableThereIsNothingOfIt) {
  const std::string file = reference();
  const std::string list = file_text(output_names(file).best);
  EXPECT_EQ(list.find("robust"), std::string::npos);
  for (const std::string& name : variable_names(file)) EXPECT_EQ(name.find("robust"), std::string::npos) << name;
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Robust scores: the percentile in closed form, the deviations as samples, and the scores of whole sweeps against a brute-force
// evaluation, in the file, in the list, in `rank` and after a break.
// sanitizers: none
#include "sweeps/lists/robust.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <sstream>

#include "base/numbers/normal.h"
#include "core/candidates.h"
#include "core/core_backend.h"
#include "core/hand_size.h"
#include "core/prepare.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "host/open_backend.h"
#include "sweeps/grips/methods.h"
#include "sweeps/grips/report.h"
#include "sweeps/rank/rank.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/sweep_result.h"
#include "sweeps/run/run.h"
#include "tests/support/files.h"
#include "tests/support/scenes.h"
#include "tests/support/sweep_results.h"
#include "tests/support/sweep_trial.h"

namespace wholehand::sweeps {
namespace {

TEST(Robust, PercentilesLieBetweenScores) {
  EXPECT_EQ(robust_score({0.5}, 1).low, 0.5);
  EXPECT_EQ(robust_score({0.5}, 1).mean, 0.5);
  EXPECT_EQ(robust_score({0.5, 0, 1, 0}, 3).share, 0.75);
  const RobustScore ten = robust_score({9, 1, 8, 2, 7, 3, 6, 4, 5, 0}, 10);  // 0.9 of the way from 0 to 1
  EXPECT_NEAR(ten.low, 0.9, 1e-15);
  EXPECT_EQ(ten.mean, 4.5);
  EXPECT_EQ(robust_score({3, 1, 2, 0, 4, 5, 6, 7, 8, 9, 10}, 11).low, 1);  // eleven: the second
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
  // the quantile of 15/16 over the root of the mean square of the eight, both by another program (Python's statistics.NormalDist)
  EXPECT_NEAR(levels[7], 0.6 + 0.1 * 1.5341205443525463 / 0.922524239971265, 1e-9);
  double squares = 0;
  for (const double level : levels) squares += (level - 0.6) * (level - 0.6);
  EXPECT_NEAR(std::sqrt(squares / 8), 0.1, 1e-15) << "the deviation that the scene asks for";
  scene.robust->friction = 1;
  EXPECT_EQ(robust_frictions(scene)[0], 0);
}

// The thumb-index line as kernel 1 has it, continued beyond the pole with the sides that it has below: direction, foot and the side of
// the little finger.
struct Line {
  Triple direction{}, foot{}, below{};
};

Line line_of(const GripInput& grip) {
  const double sa = std::sin(grip.azimuth), ca = std::cos(grip.azimuth), sb = std::sin(grip.obliquity),
               cb = std::cos(grip.obliquity);
  const Triple aside{sa, 0, ca}, down{sb * ca, -cb, -sb * sa};
  Line line{{cb * ca, sb, -cb * sa}, {grip.offset * aside[0], grip.height, grip.offset * aside[2]}, {}};
  // turned about the direction by the roll: the other axis is direction x down, which is `aside` or its opposite
  const Triple& d = line.direction;
  const Triple across{d[1] * down[2] - d[2] * down[1], d[2] * down[0] - d[0] * down[2], d[0] * down[1] - d[1] * down[0]};
  for (std::size_t k = 0; k < 3; ++k) line.below[k] = std::cos(grip.roll) * down[k] + std::sin(grip.roll) * across[k];
  return line;
}

TEST(Robust, BeyondThePoleAHandGoesOnTurning) {
  const GripInput grip{0.05, radians(30), radians(80), radians(-20), 0.004, 1};
  for (const double more : {5.0, 9.0, 11.0, 60.0, 99.0, 101.0, 150.0, 200.0, 350.0, -200.0, -165.0, -340.0}) {
    Deviation deviation;
    deviation.added.obliquity = radians(more);
    deviation.added.azimuth = radians(3 * more);
    deviation.added.roll = radians(-4 * more);
    GripInput turned = grip;
    turned.obliquity += deviation.added.obliquity;
    turned.azimuth += deviation.added.azimuth;
    turned.roll += deviation.added.roll;
    const GripInput named = deviated(grip, deviation);
    EXPECT_LE(std::abs(named.obliquity), PI / 2 + 1e-12) << more;
    EXPECT_LE(std::abs(named.azimuth), 2 * PI) << more;
    EXPECT_LE(std::abs(named.roll), 2 * PI) << more;
    const Line expected = line_of(turned), found = line_of(named);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found.direction[k], expected.direction[k], 1e-14) << more;
      EXPECT_NEAR(found.foot[k], expected.foot[k], 1e-14) << more;
      EXPECT_NEAR(found.below[k], expected.below[k], 1e-14) << more;
    }
  }
}

// The line that kernel 1 closes on is the one of line_of.
TEST(Robust, TheLineIsThatOfTheKernel) {
  const auto core = make_core_evaluator(scene_of({beaker1()}));
  const GripInput grip{0.05, radians(30), radians(20), radians(-20), 0.004, 1};
  GripResult result;
  core->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  const Line line = line_of(grip);
  const Triple thumb = result.joints[3], index = result.joints[8];
  double along = 0, length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    along += (index[k] - thumb[k]) * line.direction[k];
    length += (index[k] - thumb[k]) * (index[k] - thumb[k]);
  }
  EXPECT_NEAR(along, std::sqrt(length), 1e-12);
  along = 0;
  for (std::size_t k = 0; k < 3; ++k) along += (index[k] - line.foot[k]) * line.direction[k];
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(index[k], line.foot[k] + along * line.direction[k], 1e-9);
}

TEST(Robust, EqualScoresHaveTheirScoreAsMean) {
  for (const double score : {0.1, 0.7313, 1e-300, 0.9999999}) {
    const RobustScore robust = robust_score(std::vector<double>(61, score), 61);
    EXPECT_EQ(robust.mean, score);
    EXPECT_EQ(robust.low, score);
  }
}

// As much room as the largest hand that a deviation makes, of 4,096 of the widest.
TEST(Robust, ALatticeHoldsTheLargestHand) {
  Scene scene = scene_of({beaker1()});
  const double before = lattice_margin(scene) - LATTICE_BAND;
  scene.robust = RobustData{};
  scene.robust->count = 4096;
  scene.robust->hand_scale = 0.3;
  double largest = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    scene.robust->seed = seed;
    for (const Deviation& deviation : deviations(*scene.robust)) largest = std::max(largest, deviation.hand_factor);
  }
  EXPECT_GT(largest, 2);
  EXPECT_GT(lattice_margin(scene) - LATTICE_BAND, before * largest);
  EXPECT_LT(normal_quantile(1 - 0x1p-33), FURTHEST_DEVIATION);
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
  // with a hand of which some deviations hold and others do not
  scene.hand = paper_hand();
  scene.strength->by_opening = false;
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

// Counts the grips that it evaluates.
class CountedBackend final : public Backend {
 public:
  CountedBackend(std::unique_ptr<Backend> backend, std::size_t& count) : backend_(std::move(backend)), count_(count) {}
  const BackendInfo& info() const override { return backend_->info(); }
  const FieldSet& fields() const override { return backend_->fields(); }
  RunResult run(const RunRequest& request) override {
    count_ += request.last - request.first;
    return backend_->run(request);
  }
  std::vector<LiquidResult> liquid(std::size_t vessel) override { return backend_->liquid(vessel); }

 private:
  std::unique_ptr<Backend> backend_;
  std::size_t& count_;
};

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
    rank_robustly(opens("core", Precision::full), scene, plan, 2, nullptr, lists);
    auto alone = two_lists(scene);
    rank_robustly(opens("core", Precision::full, 1), scene, plan, 2, nullptr, alone);
    bool is_between = false;
    for (std::size_t v = 0; v < lists.size(); ++v)
      for (std::size_t rank = 0; rank < lists[v].size(); ++rank) {
        const RobustScore expected = robust_score(scores_by_hand(scene, v, lists[v][rank].grip), 0);
        // a score state by state and one of the search for the worst state are each to 1e-3 of an effort, of which it has 0.3 x 1/4
        EXPECT_NEAR(lists[v][rank].robust.mean, expected.mean, 2e-4);
        EXPECT_NEAR(lists[v][rank].robust.low, expected.low, 2e-4);
        EXPECT_EQ(lists[v][rank].robust.mean, alone[v][rank].robust.mean) << "whatever the threads";
        EXPECT_EQ(lists[v][rank].robust.low, alone[v][rank].robust.low);
        GripReport report = make_grip_report(scene, v, lists[v][rank].grip, scene_axes(scene, v),
                                             core_grip_methods(scene, make_core_evaluator(scene), "core"));
        add_held_share(report, scene, v);
        EXPECT_EQ(report.held_share.has_value(), report.answer.result.plausible);
        if (report.held_share) {
          EXPECT_EQ(*report.held_share, lists[v][rank].robust.share) << "a grip alone has what it has in its list";
        }
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
  rank_robustly(opens("core", Precision::full), scene, plan, 2, nullptr, lists);
  const auto core = make_core_evaluator(scene);
  for (std::size_t v = 0; v < lists.size(); ++v)
    for (const BestGrip& best : lists[v]) {
      GripResult result;
      core->grip(v, best.grip, result);
      EXPECT_NEAR(best.robust.mean, core->score(v, best.grip, result).score, 1e-3);
      EXPECT_NEAR(best.robust.low, best.robust.mean, 1e-3);
    }
}

TEST(Robust, WhatIsKnownBoundsThePercentile) {
  EXPECT_EQ(largest_low({}, 64), HUGE_VAL);
  EXPECT_EQ(largest_low({0, 0, 0, 0, 0, 0, 0}, 64), HUGE_VAL) << "the eighth lowest counts too";
  EXPECT_EQ(largest_low(std::vector<double>(8, 0.0), 64), 0);
  const std::vector<double> all{0.2, 0.9, 0.1, 0.8, 0.3, 0.7, 0.4, 0.6, 0.5, 1.0, 0.15};
  for (std::size_t known = 2; known <= all.size(); ++known) {
    const double bound = largest_low({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(known)}, all.size());
    EXPECT_GE(bound, robust_score(all, all.size()).low);
  }
  EXPECT_EQ(largest_low(all, all.size()), robust_score(all, all.size()).low);
}

Scene broad_scene() {
  Scene scene = small_scene();
  scene.grips.height.values = {0.4, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9};
  scene.grips.roll.values = {radians(-80), radians(-60), radians(-40), radians(-20), radians(0)};
  return scene;
}

// Every feasible, plausible grip of a vessel as a candidate, by score.
std::vector<std::vector<BestGrip>> all_by_score(const Scene& scene, const Plan& plan) {
  const auto core = make_core_evaluator(scene);
  std::vector<std::vector<BestGrip>> lists(scene.vessels.size());
  for (std::size_t v = 0; v < lists.size(); ++v) {
    for (std::uint64_t i = 0; i < plan.grips(); ++i) {
      GripResult result;
      BestGrip grip;
      grip.grip = plan.grip(v, i);
      core->grip(v, grip.grip, result);
      if (result.reason != Reason::none || !result.plausible) continue;
      grip.candidate = {core->score(v, grip.grip, result).score, i};
      lists[v].push_back(grip);
    }
    std::sort(lists[v].begin(), lists[v].end(),
              [](const BestGrip& a, const BestGrip& b) { return is_better(a.candidate, b.candidate); });
  }
  return lists;
}

// Skipped deviations change no list.
TEST(Robust, ListsAreThoseOfAllDeviationsOfAllCandidates) {
  for (const double friction : {0.0, 0.2}) {
    Scene scene = broad_scene();
    scene.robust->friction = friction;
    const Plan plan(scene, true);
    const auto candidates = all_by_score(scene, plan);
    constexpr std::size_t BEST = 3;
    std::size_t evaluated = 0;
    const OpenBackend counting = [&](const Scene& other, const FieldSet& fields) {
      return std::make_unique<CountedBackend>(open_backend(other, fields, "core", Precision::full, 0), evaluated);
    };
    auto ranked = candidates, whole = candidates;
    ASSERT_TRUE(rank_robustly(counting, scene, plan, BEST, nullptr, ranked));
    auto first = candidates;
    ASSERT_TRUE(rank_robustly(opens("core", Precision::full), scene, plan, 1, nullptr, first));
    std::size_t all = 0;
    for (std::size_t v = 0; v < whole.size(); ++v) {
      std::vector<BestGrip>& list = whole[v];
      list.resize(std::min(list.size(), judged_grips(BEST)));
      ASSERT_GT(list.size(), ROBUST_CANDIDATES * BEST);
      all += list.size() * static_cast<std::size_t>(scene.robust->count);
      // each candidate alone: nothing to be compared with, so nothing is skipped
      for (BestGrip& grip : list) {
        std::vector<std::vector<BestGrip>> alone(whole.size());
        alone[v] = {grip};
        ASSERT_TRUE(rank_robustly(opens("core", Precision::full), scene, plan, 1, nullptr, alone));
        grip = alone[v][0];
      }
      std::stable_sort(list.begin(), list.end(), [](const BestGrip& a, const BestGrip& b) {
        return a.robust.low != b.robust.low ? a.robust.low > b.robust.low : a.robust.mean > b.robust.mean;
      });
      ASSERT_EQ(ranked[v].size(), BEST);
      ASSERT_EQ(first[v].size(), 1u);
      EXPECT_EQ(first[v][0].candidate.index, list[0].candidate.index) << "a shorter list starts otherwise";
      for (std::size_t place = 0; place < BEST; ++place) {
        EXPECT_EQ(ranked[v][place].candidate.index, list[place].candidate.index) << v << " " << place;
        EXPECT_EQ(ranked[v][place].robust.low, list[place].robust.low);
        EXPECT_EQ(ranked[v][place].robust.mean, list[place].robust.mean);
        EXPECT_EQ(ranked[v][place].robust.share, list[place].robust.share);
      }
      EXPECT_NE(list[0].candidate.index, candidates[v][0].candidate.index) << "the order of scores would do";
    }
    EXPECT_LT(evaluated, all * 9 / 10);
  }
}

// A list with more places than are ranked: the others follow as they were.
TEST(Robust, PlacesBeyondTheRankedOnesKeepTheirOrder) {
  Scene scene = broad_scene();
  const Plan plan(scene, true);
  std::vector<std::vector<BestGrip>> lists(2);
  for (std::size_t i = 0; i < 130; ++i) {
    BestGrip& grip = lists[0].emplace_back();
    grip.grip = plan.grip(0, i % plan.grips());
    grip.candidate = {1 - 1e-3 * static_cast<double>(i), i};
  }
  ASSERT_TRUE(rank_robustly(opens("core", Precision::full), scene, plan, 120, nullptr, lists));
  ASSERT_EQ(lists[0].size(), 120u);
  for (std::size_t i = 0; i < 120; ++i) EXPECT_EQ(std::isnan(lists[0][i].robust.low), i >= MOST_ROBUST) << i;
  for (std::size_t i = MOST_ROBUST + 1; i < 120; ++i) EXPECT_LT(lists[0][i].candidate.score, lists[0][i - 1].candidate.score);
  EXPECT_TRUE(lists[1].empty());
}

// ---- of sweeps ----

// The same list on a device and on the core, in the file and of `rank`; and the grips' own scores beside the robust ones.
TEST(RobustSweep, IsTheSameOnADeviceOnTheCoreAndInRank) {
  const TemporaryFolder folder;
  std::string text = read_scene_file(find_scene("three_beakers")).text;
  text.replace(text.find("[robust]\n"), std::string("[robust]\n").size(), "[robust]\ncount = 16\n");
  Scene scene = parse_scene(text, "robust.toml");
  scene.vessels.resize(1);
  scene.output.also = {"push"};
  std::vector<std::vector<std::uint64_t>> lists;
  for (const char* on : {"core", "vulkan"}) {
    const SweepOptions options{
        .output = folder / (std::string(on) + ".nc"), .on = on, .best = 5, .hooks = {.note = [](const std::string&) {}}};
    Scene swept = scene;
    swept.grips.height.values = {0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
    swept.grips.height.is_range = false;
    ASSERT_EQ(run_sweep(swept, options), ExitCode::done);
    const Plan plan(swept, false);
    SweepResult result(options.output);
    result.use(swept, plan);
    std::vector<std::uint64_t>& list = lists.emplace_back();
    for (const Candidate& candidate : result.best(0)) list.push_back(candidate.index);
    ASSERT_EQ(list.size(), 5u);
    const auto robust = result.robust(0);
    for (std::size_t rank = 1; rank < robust.size(); ++rank) EXPECT_GE(robust[rank - 1].low, robust[rank].low);
    RankRequest request;
    request.best = 5;
    request.apart = swept.output.apart;
    request.by = read_rank_by("", swept);
    const Ranking ranking = rank_grips(result, swept, plan, request, [&] { return make_core_evaluator(swept); });
    ASSERT_EQ(ranking.lists[0].size(), 5u);
    for (std::size_t rank = 0; rank < 5; ++rank) {
      EXPECT_EQ(ranking.lists[0][rank].candidate.index, list[rank]) << on;
      EXPECT_EQ(ranking.lists[0][rank].robust.low, robust[rank].low);
      EXPECT_EQ(ranking.lists[0][rank].score, result.best(0)[rank].score);
    }
    for (const auto& [by, is_worse] :
         {std::pair<RankBy, bool (*)(const BestGrip&, const BestGrip&)>{
              RankBy::worst_effort, [](const BestGrip&a, const BestGrip&b) { return a.efforts.worst > b.efforts.worst; }},
          {RankBy::push, [](const BestGrip&a, const BestGrip&b) { return a.efforts.push < b.efforts.push; }}}) {
      request.by = by;
      const Ranking other = rank_grips(result, swept, plan, request, [&] { return make_core_evaluator(swept); });
      for (std::size_t rank = 1; rank < 5; ++rank) EXPECT_FALSE(is_worse(other.lists[0][rank - 1], other.lists[0][rank])) << rank;
      EXPECT_LE(other.lists[0][0].score, 1);
    }
  }
  EXPECT_EQ(lists[0], lists[1]);
}

TEST(RobustSweep, RefusesToRankByWhatTheSceneLacks) {
  const Scene without = scene_of({beaker1()});
  for (const auto& [by, words] : {std::pair{"robust", "needs [robust]"},
                                  {"push", "needs efforts"},
                                  {"worst_effort", "needs efforts"},
                                  {"luck", "allowed: score, robust, worst_effort or push"}})
    try {
      read_rank_by(by, without);
      ADD_FAILURE() << by;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  EXPECT_EQ(read_rank_by("", without), RankBy::score);
}

TEST(RobustSweep, ShardsHaveNoListsToRank) {
  const TemporaryFolder folder;
  Scene scene = scene_of({beaker1()});
  scene.robust = RobustData();
  try {
    run_sweep(scene, {.output = folder / "a.nc", .rank_by = "score", .shards = ""});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("`wholehand rank` takes it"), std::string::npos) << error.what();
  }
}

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
  std::map<std::uint64_t, double> means;  // by the grip's number, and 1000 for each vessel
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto best = result.best(v);
    const auto robust = result.robust(v);
    ASSERT_EQ(best.size(), 6u);
    ASSERT_EQ(robust.size(), best.size());
    for (std::size_t rank = 0; rank < best.size(); ++rank) {
      std::vector<double> scores;
      std::size_t plausible = 0;
      for (const Deviation& deviation : all) {
        const GripInput grip = deviated(plan.grip(v, best[rank].index), deviation);
        const std::uint32_t status = fake_uint(v, grip, FIELD_STATUS);
        const bool counts = (status & (STATUS_REASON_MASK | STATUS_PLAUSIBLE)) == STATUS_PLAUSIBLE;
        scores.push_back(counts ? fake_real(v, grip, FIELD_SCORE, 0) : 0);
        plausible += counts ? 1 : 0;
      }
      const RobustScore expected = robust_score(scores, plausible);
      EXPECT_NEAR(robust[rank].mean, expected.mean, 1e-12);
      EXPECT_NEAR(robust[rank].low, expected.low, 1e-12);
      EXPECT_NEAR(robust[rank].share, expected.share, 1e-12);
      means[best[rank].index + 1000 * v] = robust[rank].mean;
    }
  }
  const auto best_list = file_text(output_names(file).best);
  EXPECT_NE(best_list.find(",robust_mean,robust_low,robust_share,grip,result,sweep\n"), std::string::npos);
  EXPECT_NE(best_list.find(fmt::format(",{:.9g},", result.robust(0)[0].mean)), std::string::npos);
  RankRequest request;
  request.best = judged_grips(6);  // by score: the candidates, so that the listed ones are among them
  request.apart = scene.output.apart;
  const Ranking ranking = rank_grips(result, scene, plan, request, [&] { return std::make_shared<FakeEvaluator>(scene); });
  ASSERT_EQ(ranking.lists.size(), 2u);
  int reports = 0;
  for (std::size_t v = 0; v < 2; ++v)
    for (const BestGrip& grip : ranking.lists[v]) {
      const auto found = means.find(grip.candidate.index + 1000 * v);
      if (found == means.end()) continue;
      EXPECT_EQ(grip.robust.mean, found->second);
      ++reports;
    }
  EXPECT_EQ(reports, 12);
  EXPECT_NE(best_table(scene, plan, ranking.lists[0], {3, true}).find("  robust  mean  holds %"), std::string::npos);
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

// Robust scores may take longer than the sweep.
TEST_F(RobustRun, AnInterruptBetweenDeviationsResumesToTheSame) {
  const Scene scene = robust_fake_scene();
  const std::string whole = reference(scene);
  SweepTrial first(folder / "a.nc");
  first.scene = scene;
  int chunks = 0, swept = 0, again = 0;
  first.before_chunk = [&] { ++swept; };
  first.before_other = [&] {
    if (++chunks == 3) raise(SIGINT);
  };
  const SweepOutcome stopped = first.run();
  EXPECT_EQ(stopped.code, ExitCode::interrupted) << stopped.error;
  EXPECT_FALSE(file_exists(folder / "a.nc"));
  EXPECT_EQ(stopped.out.find("robust"), std::string::npos) << "no table of grips whose robust scores are missing";
  SweepTrial rest(folder / "a.nc");
  rest.scene = scene;
  rest.options.resume = true;
  rest.before_chunk = [&] { ++again; };
  EXPECT_EQ(rest.run().code, ExitCode::done);
  EXPECT_LT(4 * again, swept) << "but for the listed grips' own values, all were there";
  expect_same_as(whole, folder / "a.nc");
}

TEST_F(RobustRun, TheTimeLimitHoldsBetweenDeviations) {
  const Scene scene = robust_fake_scene();
  const std::string whole = reference(scene);
  SweepTrial first(folder / "a.nc");
  first.scene = scene;
  int chunks = 0;
  first.before_other = [&] {
    ++chunks;
    first.options.time_limit = 1e-9;
  };
  const SweepOutcome stopped = first.run();
  EXPECT_EQ(stopped.code, ExitCode::interrupted) << stopped.error;
  EXPECT_EQ(chunks, 1);
  SweepTrial rest(folder / "a.nc");
  rest.scene = scene;
  rest.options.resume = true;
  EXPECT_EQ(rest.run().code, ExitCode::done);
  expect_same_as(whole, folder / "a.nc");
}

TEST_F(RobustRun, AFailureAfterTheLastGripLeavesAllOfThemMarked) {
  const Scene scene = robust_fake_scene();
  const std::string whole = reference(scene);
  SweepTrial first(folder / "a.nc");
  first.scene = scene;
  first.before_other = [] { throw failure_error("device lost"); };
  const SweepOutcome failed = first.run();
  EXPECT_EQ(failed.code, ExitCode::failure);
  EXPECT_EQ(failed.error, "device lost");
  SweepTrial rest(folder / "a.nc");
  rest.scene = scene;
  rest.options.resume = true;
  const SweepOutcome resumed = rest.run();
  EXPECT_EQ(resumed.code, ExitCode::done) << resumed.error;
  const std::string all = resumed.notes.substr(resumed.notes.find(".partial: ") + 10);
  EXPECT_EQ(all.substr(0, all.find(' ')), all.substr(all.find("of ") + 3, all.find(' '))) << resumed.notes;
  expect_same_as(whole, folder / "a.nc");
}

void change_value(const std::string& path, const char* variable, std::array<std::size_t, 2> place, double value) {
  int file = -1, id = -1;
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &file), NC_NOERR);
  EXPECT_EQ(nc_inq_varid(file, variable, &id), NC_NOERR) << variable;
  EXPECT_EQ(nc_put_var1_double(file, id, place.data(), &value), NC_NOERR);
  EXPECT_EQ(nc_close(file), NC_NOERR);
  renew_checksums(path);
}

TEST_F(RobustRun, ScoresThatNoSweepWritesAreRefused) {
  const Scene scene = robust_fake_scene();
  const std::string file = reference(scene);
  const Plan plan(scene, false);
  for (const char* name : {"best_robust_mean", "best_robust_low", "best_robust_share"})
    for (const double value : {-0.25, HUGE_VAL, std::nan("")}) {
      const std::string changed = folder / "changed.nc";
      std::filesystem::copy_file(file, changed, std::filesystem::copy_options::overwrite_existing);
      change_value(changed, name, {1, 2}, value);
      SweepResult result(changed);
      result.use(scene, plan);
      EXPECT_EQ(result.robust(0).size(), 6u);
      try {
        result.robust(1);
        FAIL() << name << " " << value;
      } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::usage);
        const std::string line = error.what();
        EXPECT_TRUE(line.starts_with(changed + ": best_robust_mean, best_robust_low and best_robust_share of rank 3 are ")) << line;
        EXPECT_TRUE(line.ends_with("; allowed: numbers from 0 on")) << line;
      }
    }
}

TEST_F(RobustRun, WithoutTheTableThereIsNothingOfIt) {
  const std::string file = reference();
  const std::string list = file_text(output_names(file).best);
  EXPECT_EQ(list.find("robust"), std::string::npos);
  for (const std::string& name : variable_names(file)) EXPECT_EQ(name.find("robust"), std::string::npos) << name;
}

}  // namespace
}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// Sweeps whose best grips have to differ, against a choice among all grips at hand.
// sanitizers: thread
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "core/candidates.h"
#include "sweeps/lists/different_grips.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/mark.h"
#include "tests/support/fake_backend.h"
#include "tests/support/sweep_trial.h"

namespace wholehand::sweeps {
namespace {

constexpr double APART = 0.3;  // as fake hands lie: a handful of grips is near each other

Scene choosy_scene() {
  Scene scene = fake_scene();
  scene.output.apart = APART;
  return scene;
}

// The listed grips of a vessel and hand scale (0: any) by the definition, over the stand-ins.
std::vector<std::uint64_t> listed(const Scene& scene, const Plan& plan, std::size_t vessel, double hand_scale) {
  std::vector<Candidate> grips;
  for (std::uint64_t i = 0; i < plan.grips(); ++i) {
    const GripInput grip = plan.grip(vessel, i);
    const std::uint32_t status = fake_uint(vessel, grip, FIELD_STATUS);
    if ((status & STATUS_REASON_MASK) != REASON_NONE || (status & STATUS_PLAUSIBLE) == 0) continue;
    if (hand_scale != 0 && grip.hand_scale != hand_scale) continue;
    grips.push_back({fake_real(vessel, grip, FIELD_SCORE, 0), i});
  }
  std::sort(grips.begin(), grips.end(), is_better);
  std::vector<std::uint64_t> taken;
  for (const Candidate& grip : grips) {
    const auto hand = fake_hand(vessel, plan.grip(vessel, grip.index));
    const bool differs = std::all_of(taken.begin(), taken.end(), [&](std::uint64_t other) {
      return are_different(hand, fake_hand(vessel, plan.grip(vessel, other)), scene.output.apart);
    });
    if (differs && taken.size() < static_cast<std::size_t>(scene.output.best)) taken.push_back(grip.index);
  }
  return taken;
}

void expect_listed(const std::string& file, const Scene& scene) {
  const Plan plan(scene, keeps_vectors(choose_variables(scene)));
  const auto grips = read_values(file, "best_grip"), scores = read_values(file, "best_score");
  const auto best = static_cast<std::size_t>(scene.output.best);
  ASSERT_EQ(grips.size(), scene.vessels.size() * plan.hand_scales() * best);
  for (std::size_t list = 0; list * best < grips.size(); ++list) {
    const std::size_t v = list / plan.hand_scales();
    const double hand = plan.hand_scales() > 1 ? plan.hand_scale(list % plan.hand_scales()) : 0;
    const auto expected = listed(scene, plan, v, hand);
    for (std::size_t rank = 0; rank < best; ++rank) {
      const std::size_t at = list * best + rank;
      EXPECT_EQ(grips[at], rank < expected.size() ? static_cast<double>(expected[rank]) : -1) << list << " " << rank;
      if (rank < expected.size()) {
        EXPECT_EQ(scores[at], fake_real(v, plan.grip(v, expected[rank]), FIELD_SCORE, 0));
      }
    }
  }
}

TEST_F(RunTest, DifferentBestGripsAreThoseOfTheDefinition) {
  std::size_t not_the_best = 0;
  for (const bool is_sobol : {false, true}) {
    for (const bool several_hands : {false, true}) {
      for (const bool keeps : {true, false}) {
        for (const std::size_t pool : {std::size_t{1}, std::size_t{5}, std::size_t{0}}) {
          for (const int best : {3, 40}) {
            SweepTrial trial(folder / "a.nc");
            trial.scene = choosy_scene();
            trial.scene.output.best = best;
            if (keeps) {
              trial.scene.output.keep = {{"gap"}};
            } else {
              trial.scene.output.keep = std::vector<std::string>{};
              trial.options.tuning.cached_scores = 0;
            }
            if (several_hands) trial.scene.grips.hand_scale.values = {1.1, 0.9};
            if (is_sobol) {
              trial.scene.grips.sampling = Sampling::sobol;
              trial.scene.grips.count = 300;
            }
            trial.options.tuning.pool = pool;
            const SweepOutcome outcome = trial.run();
            ASSERT_EQ(outcome.code, ExitCode::done) << outcome.error;
            expect_listed(folder / "a.nc", trial.scene);
            const auto chosen = read_values(folder / "a.nc", "best_grip");
            trial.scene.output.apart = 0;
            ASSERT_EQ(trial.run().code, ExitCode::done);
            not_the_best += chosen != read_values(folder / "a.nc", "best_grip");
            expect_listed(folder / "a.nc", trial.scene);
          }
        }
      }
    }
  }
  EXPECT_GE(not_the_best, 36u) << "else the scene says nothing";  // all but the three best of the Sobol points
}

TEST_F(RunTest, InSinglePrecisionTheListIsTheSame) {
  SweepTrial trial(folder / "a.nc");
  trial.scene = choosy_scene();
  trial.precision = Precision::single;
  trial.options.precision = Precision::single;
  trial.options.tuning.pool = 5;
  ASSERT_EQ(trial.run().code, ExitCode::done);
  expect_listed(folder / "a.nc", trial.scene);  // the stand-ins' scores are the same in both
}

// Without pictures, which take most of a short sweep's time.
Scene quick_choosy_scene() {
  Scene scene = quick_scene();
  scene.output.apart = APART;
  return scene;
}

void expect_same_list(const std::string& file, const std::string& other) {
  expect_same_values(file, other);
  EXPECT_EQ(list_beside(file), list_beside(other));
}

TEST_F(RunTest, AnInterruptInAnyPassLosesNothing) {
  const std::string expected = reference(quick_choosy_scene());
  int runs = 0;
  {
    SweepTrial whole(folder / "b.nc");
    whole.scene = quick_choosy_scene();
    whole.options.tuning.pool = 1;
    whole.options.tuning.cached_scores = 0;
    whole.before_run = [&] { ++runs; };
    ASSERT_EQ(whole.run().code, ExitCode::done);
    expect_same_list(expected, folder / "b.nc");
  }
  ASSERT_GT(runs, 8) << "two vessels, their further passes, and the best grips";
  for (int stop = 1; stop <= runs - 2; ++stop) {
    for (const bool at_once : {true, false}) {
      SweepTrial trial(folder / "a.nc");
      trial.scene = quick_choosy_scene();
      trial.options.tuning.pool = 1;
      trial.options.tuning.cached_scores = 0;
      int run = 0, chunk = 0;
      trial.before_run = [&] {
        if (++run == stop && at_once) raise(SIGINT);
        chunk = 0;
      };
      trial.before_chunk = [&] {
        if (run == stop && !at_once && ++chunk == 3) raise(SIGINT);
      };
      const SweepOutcome outcome = trial.run();
      ASSERT_EQ(outcome.code, ExitCode::interrupted) << stop << outcome.error;
      SweepTrial rest(folder / "a.nc");
      rest.scene = quick_choosy_scene();
      rest.options.tuning.pool = 1;
      rest.options.tuning.cached_scores = 0;
      rest.options.resume = true;
      int runs_of_rest = 0;
      rest.before_run = [&] { ++runs_of_rest; };
      const SweepOutcome resumed = rest.run();
      ASSERT_EQ(resumed.code, ExitCode::done) << stop << resumed.error;
      EXPECT_LE(runs_of_rest, runs - stop + 1) << "passes that were ended are not made again";
      expect_same_list(expected, folder / "a.nc");
      std::filesystem::remove(folder / "a.nc");
    }
  }
}

// Where the scores are kept, a further pass evaluates nothing.
TEST_F(RunTest, FurtherPassesTakeTheScoresOfTheFirst) {
  const std::string expected = reference(quick_choosy_scene());
  const std::uint64_t grips = Plan(quick_choosy_scene(), false).grips();
  for (const std::uint64_t room : {grips, grips - 1}) {
    SweepTrial trial(folder / "a.nc");
    trial.scene = quick_choosy_scene();
    trial.options.tuning.pool = 1;
    trial.options.tuning.cached_scores = static_cast<std::size_t>(room);
    int runs = 0;
    trial.before_run = [&] { ++runs; };
    ASSERT_EQ(trial.run().code, ExitCode::done);
    if (room == grips) {
      EXPECT_EQ(runs, 2) << "each vessel once: the core describes its best grips";
    } else {
      EXPECT_GT(runs, 8) << "one too many to keep";
    }
    expect_same_list(expected, folder / "a.nc");
  }
}

// The scores from before the interrupt are missing: one pass evaluates all grips again, and those after it take its scores.
TEST_F(RunTest, AResumedSweepGathersTheScoresAnew) {
  const std::string expected = reference(quick_choosy_scene());
  for (const int stop : {2, 4}) {
    SweepTrial trial(folder / "a.nc");
    trial.scene = quick_choosy_scene();
    trial.options.tuning.pool = 1;
    int chunks = 0;
    trial.before_chunk = [&] {
      if (++chunks == stop) raise(SIGINT);
    };
    ASSERT_EQ(trial.run().code, ExitCode::interrupted);
    SweepTrial rest(folder / "a.nc");
    rest.scene = quick_choosy_scene();
    rest.options.tuning.pool = 1;
    rest.options.resume = true;
    int runs = 0;
    rest.before_run = [&] { ++runs; };
    ASSERT_EQ(rest.run().code, ExitCode::done);
    EXPECT_EQ(runs, 2 + 1) << "the rest of the first vessel, all of it again, and the second";
    expect_same_list(expected, folder / "a.nc");
    std::filesystem::remove(folder / "a.nc");
  }
}

TEST_F(RunTest, MarksBetweenPassesChangeNothing) {
  const std::string expected = reference(choosy_scene());
  SweepTrial trial(folder / "a.nc");
  trial.scene = choosy_scene();
  trial.options.tuning.pool = 1;
  trial.options.tuning.mark_seconds = 0;
  ASSERT_EQ(trial.run().code, ExitCode::done);
  expect_same_as(expected, folder / "a.nc");
}

TEST_F(RunTest, OnePassIsEnoughWhereTheListFills) {
  SweepTrial trial(folder / "a.nc");
  trial.scene = choosy_scene();
  int runs = 0;
  trial.before_run = [&] { ++runs; };
  ASSERT_EQ(trial.run().code, ExitCode::done);
  EXPECT_EQ(runs, 2) << "each vessel once: the core describes its best grips";
}

}  // namespace
}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// A sweep as a whole: what it writes and says, on any backend.
// sanitizers: thread
#include "sweeps/run/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "base/files/files.h"
#include "core/core_backend.h"
#include "shaders/layout.h"
#include "sweeps/plan/plan.h"
#include "sweeps/result/output_names.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_trial.h"

namespace wholehand::sweeps {
namespace {

TEST_F(RunTest, WritesAllFilesAndSaysWhatItDid) {
  SweepTrial trial(folder / "a.nc");
  const SweepOutcome outcome = trial.run();
  ASSERT_EQ(outcome.code, ExitCode::done) << outcome.error;
  for (const char* name : {"a.nc", "a.best.csv", "a.first_vessel.svg", "a.second.svg"})
    EXPECT_TRUE(file_exists(folder / name)) << name;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_FALSE(has(entry.path().string(), "partial")) << entry.path();
  }
  EXPECT_TRUE(has(outcome.out, "fake: 560 grips of 2 vessels, 8 states each\non fake device (fake driver 1), double precision\n"));
  EXPECT_TRUE(has(outcome.out, "one azimuth stands for all")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "first vessel: ")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, " of 280 grips (each at 3 azimuths) are plausible; ")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "everything else")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "peak memory")) << outcome.out;
  EXPECT_EQ(outcome.notes, "") << "nothing on stderr";
  EXPECT_EQ(trial.opened, 1) << "the default set has all that the best grips need";
}

TEST_F(RunTest, BestGripsAreThoseOfTheWholeVessel) {
  SweepTrial trial(folder / "a.nc");
  ASSERT_EQ(trial.run().code, ExitCode::done);
  const auto index = read_values(folder / "a.nc", "best_grip"), best = read_values(folder / "a.nc", "best_score");
  const auto score = read_values(folder / "a.nc", "score");
  const Plan plan(trial.scene, false);
  ASSERT_EQ(best.size(), 2u * 6);
  for (std::size_t v = 0; v < 2; ++v) {
    for (std::size_t rank = 0; rank < 6; ++rank) {
      const std::size_t at = v * 6 + rank;
      EXPECT_EQ(best[at], score[v * plan.stored_grips() + static_cast<std::size_t>(index[at])]);
      EXPECT_GE(rank > 0 ? best[at - 1] : 1, best[at]);
    }
  }
  int better = 0;
  for (std::uint64_t i = 0; i < plan.grips(); ++i) better += score[i] > best[5];
  EXPECT_EQ(better, 5);
}

// The best of a hand scale, by brute force over the stand-ins.
std::vector<double> best_scores(const Scene& scene, const Plan& plan, std::size_t vessel, double hand_scale) {
  std::vector<double> scores;
  for (std::uint64_t i = 0; i < plan.grips(); ++i) {
    const GripInput grip = plan.grip(vessel, i);
    const std::uint32_t status = fake_uint(vessel, grip, FIELD_STATUS);
    if (grip.hand_scale != hand_scale || (status & STATUS_REASON_MASK) != REASON_NONE || (status & STATUS_PLAUSIBLE) == 0) continue;
    scores.push_back(fake_real(vessel, grip, FIELD_SCORE, 0));
  }
  std::sort(scores.rbegin(), scores.rend());
  scores.resize(static_cast<std::size_t>(scene.output.best));
  return scores;
}

TEST_F(RunTest, EachHandScaleHasAListOfItsOwn) {
  for (const bool is_sobol : {false, true}) {
    for (const bool keeps : {true, false}) {
      SweepTrial trial(folder / "a.nc");
      trial.options.tuning.mark_seconds = 0;  // the lists go through marks too
      trial.scene.grips.hand_scale.values = {1.1, 0.9, 1};
      if (is_sobol) {
        trial.scene.grips.sampling = Sampling::sobol;
        trial.scene.grips.count = 400;
      }
      if (!keeps) trial.scene.output.keep = std::vector<std::string>{};
      const SweepOutcome outcome = trial.run();
      ASSERT_EQ(outcome.code, ExitCode::done) << outcome.error;
      const Plan plan(trial.scene, false);
      const auto best = read_values(folder / "a.nc", "best_score"), hands = read_values(folder / "a.nc", "best_hand_scale");
      ASSERT_EQ(best.size(), 2u * 3 * 6);
      const std::string dimension = is_sobol ? "listed_hand_scale" : "hand_scale";
      EXPECT_EQ(dimension_names(folder / "a.nc", "best_score"), (std::vector<std::string>{"vessel", dimension, "rank"}));
      EXPECT_EQ(read_values(folder / "a.nc", dimension), trial.scene.grips.hand_scale.values);
      for (std::size_t list = 0; list < 6; ++list) {
        const double hand = trial.scene.grips.hand_scale.values[list % 3];
        const auto expected = best_scores(trial.scene, plan, list / 3, hand);
        for (std::size_t rank = 0; rank < 6; ++rank) {
          EXPECT_EQ(best[list * 6 + rank], expected[rank]);
          EXPECT_EQ(hands[list * 6 + rank], hand);
        }
      }
      EXPECT_TRUE(
          has(outcome.out, "\nfirst vessel, hand scale 1.1: whether it holds is not judged without efforts; grip 1 scores "))
          << outcome.out;
      EXPECT_TRUE(has(outcome.out, "\nsecond, hand scale 0.9: whether it holds is not judged without efforts; grip 1 scores "))
          << outcome.out;
      const std::string csv = file_text(folder / "a.best.csv");
      EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 6 * 6);
    }
  }
}

TEST_F(RunTest, ARangeOfSobolHandsAndOneHandHaveOneList) {
  SweepTrial trial(folder / "a.nc");
  trial.scene.grips.sampling = Sampling::sobol;
  trial.scene.grips.count = 100;
  trial.scene.grips.hand_scale = range_axis(0.9, 1.1, 2);
  ASSERT_EQ(trial.run().code, ExitCode::done);
  EXPECT_EQ(dimension_names(folder / "a.nc", "best_score"), (std::vector<std::string>{"vessel", "rank"}));
  EXPECT_EQ(dimension_names(reference(), "best_score"), (std::vector<std::string>{"vessel", "rank"}));
}

TEST_F(RunTest, ABestAtTheEndOfAnAxisIsSaid) {
  SweepTrial trial(folder / "a.nc");
  trial.scene.grips.height = trial.scene.grips.obliquity = range_axis(0.5, 0.5, 1);
  trial.scene.grips.offset = range_axis(0, 0, 1);
  trial.scene.grips.roll = range_axis(radians(-90), radians(0), 2);  // each of two values is an end
  const std::string line = "\n  the best grip lies on the edge of roll_deg; widen it?\n", out = trial.run().out;
  const std::size_t second = out.rfind("\nsecond: ");  // the first says what it holds
  ASSERT_NE(second, std::string::npos) << out;
  EXPECT_LT(out.find(line), second) << out;
  EXPECT_NE(out.find(line, second), std::string::npos) << out;
  trial.scene.grips.roll = range_axis(0, 0, 1);
  EXPECT_FALSE(has(trial.run().out, "edge")) << "nothing was searched";
}

TEST_F(RunTest, EverythingCanBeLeftOutButTheBest) {
  SweepTrial trial(folder / "a.nc");
  trial.scene.output.keep = std::vector<std::string>{};
  const SweepOutcome outcome = trial.run();
  ASSERT_EQ(outcome.code, ExitCode::done) << outcome.error;
  EXPECT_EQ(trial.opened, 1) << "the core describes the best grips";
  EXPECT_TRUE(has(outcome.notes, "no heat maps: the score is not kept")) << outcome.notes;
  EXPECT_TRUE(has(outcome.out, "\n  280 grips (each at 3 azimuths)\n")) << outcome.out;
  SweepTrial whole(folder / "b.nc");
  ASSERT_EQ(whole.run().code, ExitCode::done);
  EXPECT_EQ(list_beside(folder / "a.nc"), list_beside(folder / "b.nc"));
  EXPECT_EQ(read_values(folder / "a.nc", "best_grip"), read_values(folder / "b.nc", "best_grip"));
}

TEST_F(RunTest, MarksInBetweenChangeNothing) {
  const std::string expected = reference();
  SweepTrial trial(folder / "a.nc");
  trial.options.tuning.mark_seconds = 0;
  trial.chunk = 9;
  ASSERT_EQ(trial.run().code, ExitCode::done);
  expect_same_as(expected, folder / "a.nc");
  SweepTrial none(folder / "b.nc");
  none.options.tuning.mark_seconds = 0;
  none.scene.output.keep = std::vector<std::string>{};
  ASSERT_EQ(none.run().code, ExitCode::done);
  EXPECT_EQ(list_beside(folder / "b.nc"), list_beside(folder / "reference.nc"));
}

TEST_F(RunTest, ATimeLimitEndsItAsAnInterruptDoes) {
  const std::string expected = reference();
  SweepTrial trial(folder / "a.nc");
  trial.options.time_limit = 0.05;
  trial.before_chunk = [] { std::this_thread::sleep_for(std::chrono::milliseconds(30)); };
  const SweepOutcome cut = trial.run();
  EXPECT_EQ(cut.code, ExitCode::interrupted) << cut.error;
  EXPECT_NE(cut.notes.find("; the same command with --resume goes on with "), std::string::npos) << cut.notes;
  SweepTrial rest(folder / "a.nc");
  rest.options.resume = true;
  const SweepOutcome whole = rest.run();
  EXPECT_EQ(whole.code, ExitCode::done) << whole.error;
  EXPECT_NE(whole.notes.find("grips are there"), std::string::npos) << whole.notes;
  expect_same_as(expected, folder / "a.nc");
}

TEST_F(RunTest, HugeSweepsAreRefusedWithTheirSizes) {
  SweepTrial trial(folder / "a.nc");
  trial.scene.grips.obliquity = trial.scene.grips.roll = trial.scene.grips.offset = range_axis(0, 1, 10000);
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::usage);
  EXPECT_TRUE(has(outcome.error, "grips, ") && has(outcome.error, "states, ") && has(outcome.error, " of results"))
      << outcome.error;
  EXPECT_EQ(trial.opened, 0);
}

TEST_F(RunTest, FailureOfTheBackendLeavesNoResult) {
  SweepTrial trial(folder / "a.nc");
  int chunks = 0;
  trial.before_chunk = [&] {
    if (++chunks == 5) throw failure_error("device lost");
  };
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::failure);
  EXPECT_EQ(outcome.error, "device lost");
  EXPECT_FALSE(file_exists(folder / "a.nc"));
}

TEST_F(RunTest, BackendThatDeliversNothingIsAFailure) {
  class Silent : public FakeBackend {
   public:
    using FakeBackend::FakeBackend;
    RunResult run(const RunRequest&) override { return {}; }
  };
  const Scene scene = fake_scene();
  const SweepOptions options{.output = folder / "a.nc"};
  const SweepParts parts{
      .open_backend = [&](const BackendChoice&,
                          const FieldSet& fields) { return std::make_unique<Silent>(scene, fields, Precision::full, 10); },
      .open_evaluator = [&] { return std::make_unique<FakeEvaluator>(scene); }};
  testing::internal::CaptureStdout();
  EXPECT_THROW(run_sweep(scene, options, parts), Error);
  testing::internal::GetCapturedStdout();
}

TEST_F(RunTest, CoreOnThreadsGivesTheSameFile) {
  const std::string expected = reference();
  const Scene scene = fake_scene();
  const SweepOptions options{.output = folder / "a.nc"};
  const auto open = [&](const FieldSet& fields) {
    return std::make_unique<CoreBackend>(std::make_unique<FakeEvaluator>(scene), scene, fields, Precision::full, 3);
  };
  const SweepParts parts{.open_backend = [&](const BackendChoice&, const FieldSet& fields) { return open(fields); },
                         .open_evaluator = [&] { return std::make_unique<FakeEvaluator>(scene); },
                         .open_core = [&](const Scene&, const FieldSet& fields) { return open(fields); }};
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_sweep(scene, options, parts), ExitCode::done);
  testing::internal::GetCapturedStdout();
  expect_same_as(expected, folder / "a.nc");
}

// As a part of another program, which asks for the notes: the streams are that program's.
TEST_F(RunTest, WhereNotesAreAskedForNothingIsPrinted) {
  const std::string expected = reference();
  Scene scene = fake_scene();
  std::vector<std::string> notes;
  const SweepOptions options{.output = folder / "a.nc", .hooks = {.note = [&](const std::string& line) { notes.push_back(line); }}};
  scene.robust.emplace().azimuth = 0.1;  // about bodies of revolution it changes nothing, which is a note
  scene.output.best = 0;
  const auto open = [&](const FieldSet& fields) { return std::make_unique<FakeBackend>(scene, fields, Precision::full, 10); };
  const SweepParts parts{.open_backend = [&](const BackendChoice&, const FieldSet& fields) { return open(fields); },
                         .open_evaluator = [&] { return std::make_unique<FakeEvaluator>(scene); },
                         .open_core = [&](const Scene&, const FieldSet& fields) { return open(fields); }};
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_sweep(scene, options, parts), ExitCode::done);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(has(notes[0], "[robust]")) << notes[0];
  EXPECT_EQ(read_values(folder / "a.nc", "score"), read_values(expected, "score"));
}

TEST_F(RunTest, SobolRepeatsWithItsSeed) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 700;
  scene.grips.seed = 5;
  const std::string expected = reference(scene);
  SweepTrial again(folder / "a.nc"), other(folder / "b.nc");
  again.scene = other.scene = scene;
  other.scene.grips.seed = 6;
  ASSERT_EQ(again.run().code, ExitCode::done);
  ASSERT_EQ(other.run().code, ExitCode::done);
  expect_same_as(expected, folder / "a.nc");
  EXPECT_NE(read_values(folder / "b.nc", "roll"), read_values(folder / "a.nc", "roll"));
}

TEST_F(RunTest, XarrayUnderstandsTheResult) {
  for (const Sampling sampling : {Sampling::grid, Sampling::sobol}) {
    for (const Precision precision : {Precision::single, Precision::full}) {
      SweepTrial trial(folder / "a.nc");
      trial.scene.grips.sampling = sampling;
      trial.scene.grips.count = 300;
      trial.precision = precision;
      ASSERT_EQ(trial.run().code, ExitCode::done);
      // Debian's own python3, which Debian's xarray belongs to
      const std::string command =
          "/usr/bin/python3 " WHOLEHAND_SOURCE_DIR "/tests/sweeps/result/xarray_test.py " + (folder / "a.nc");
      EXPECT_EQ(std::system(command.c_str()), 0);
    }
  }
}

TEST_F(RunTest, OutputIsNamedAfterTheSceneFile) {
  Scene scene;
  scene.file = "some/where/three_beakers.toml";
  EXPECT_EQ(default_output(scene), "three_beakers.nc");
  scene.file = "odd";
  EXPECT_EQ(default_output(scene), "odd.nc");
  scene.file = "";
  EXPECT_EQ(default_output(scene), "sweep.nc");
}

TEST_F(RunTest, VesselsWhoseNamesBecomeTheSameFileKeepApart) {
  SweepTrial trial(folder / "a.nc");
  trial.scene.vessels[0].name = "a b";
  trial.scene.vessels[1].name = "a/b";
  ASSERT_EQ(trial.run().code, ExitCode::done);
  EXPECT_TRUE(file_exists(folder / "a.a_b.svg"));
  EXPECT_TRUE(file_exists(folder / "a.a_b_2.svg"));
}

TEST_F(RunTest, APictureThatCannotBeWrittenIsMissingAlone) {
  SweepTrial trial(folder / "a.nc");
  const std::string picture = output_names(folder / "a.nc").heat_map("second"), in_the_way = temporary_name(picture);
  std::ofstream(in_the_way) << "mine";
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::done);
  EXPECT_TRUE(has(outcome.notes, "no picture: cannot write " + picture + ": File exists")) << outcome.notes;
  EXPECT_FALSE(file_exists(picture));
  EXPECT_EQ(file_text(in_the_way), "mine");
  EXPECT_TRUE(file_exists(output_names(folder / "a.nc").heat_map("first_vessel")));
  EXPECT_TRUE(file_exists(folder / "a.nc"));
}

}  // namespace
}  // namespace wholehand::sweeps

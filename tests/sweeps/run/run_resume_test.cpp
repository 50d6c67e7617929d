// SPDX-License-Identifier: MIT
// Sweeps that are interrupted or killed and gone on with, and what --resume refuses.
// sanitizers: thread
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "base/files/files.h"
#include "core/mesh_body.h"
#include "sweeps/result/mark.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_trial.h"

namespace wholehand::sweeps {
namespace {

TEST_F(RunTest, KilledAndResumedIsTheSameBitForBit) {
  const std::string expected = reference();
  std::mt19937 random(2);
  int kills = 0, resumed = 0;
  for (int round = 0; round < 5; ++round) {
    for (int attempt = 0; !file_exists(folder / "a.nc"); ++attempt) {
      ASSERT_LT(attempt, 50);
      int chunks[2];  // a byte for every chunk that the child begins
      ASSERT_EQ(pipe2(chunks, O_CLOEXEC), 0);
      SweepTrial trial(folder / "a.nc");
      trial.options.resume = attempt > 0;
      trial.options.tuning.mark_seconds = 0;
      trial.chunk = 20;
      trial.before_chunk = [&] { EXPECT_EQ(write(chunks[1], "x", 1), 1); };
      resumed += attempt > 0 && file_exists(folder / "a.nc.partial.mark");
      const pid_t child = trial.start();
      close(chunks[1]);
      // killed between the first chunks and the last rename
      char byte = 0;
      for (unsigned wait = 3 + random() % 12; wait > 0 && read(chunks[0], &byte, 1) == 1; --wait) {
      }
      // later and later: a slow machine must reach its end, too
      usleep(random() % (10000 * (1 + static_cast<unsigned>(attempt) / 4)));
      kill(child, SIGKILL);
      const int code = exit_of(child);
      close(chunks[0]);
      ASSERT_TRUE(code == -SIGKILL || code == 0) << code;
      kills += code != 0;
    }
    // at no moment is there a file under the result's name that is not whole
    expect_same_as(expected, folder / "a.nc");
    std::filesystem::remove(folder / "a.nc");
  }
  EXPECT_GT(kills, 0);
  EXPECT_GT(resumed, 0);
}

TEST_F(RunTest, InterruptLeavesAFileToGoOnWith) {
  const std::string expected = reference();
  for (const int signal : {SIGINT, SIGTERM}) {
    SweepTrial trial(folder / "a.nc");
    int chunks = 0;
    trial.before_chunk = [&] {
      if (++chunks == 8) raise(signal);
    };
    const SweepOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::interrupted);
    EXPECT_EQ(static_cast<int>(outcome.code), 130);
    EXPECT_TRUE(has(outcome.notes, "interrupted at 3")) << outcome.notes;  // the eighth chunk is finished
    EXPECT_FALSE(file_exists(folder / "a.nc"));
    SweepTrial rest(folder / "a.nc");
    rest.options.resume = true;
    int rest_chunks = 0;
    rest.before_chunk = [&] { ++rest_chunks; };
    const SweepOutcome resumed = rest.run();
    EXPECT_EQ(resumed.code, ExitCode::done) << resumed.error;
    EXPECT_TRUE(has(resumed.notes, "continuing ")) << resumed.notes;
    EXPECT_LT(rest_chunks, 9) << "only what was missing, and the best";
    expect_same_as(expected, folder / "a.nc");
    EXPECT_EQ(resumed.out.substr(resumed.out.find("first vessel: ")).substr(0, 200),
              SweepTrial(folder / "c.nc").run().out.substr(resumed.out.find("first vessel: ")).substr(0, 200))
        << "counts are those of the whole";
    std::filesystem::remove(folder / "a.nc");
  }
}

TEST_F(RunTest, AnInterruptBeforeTheFirstGripOfAVesselLosesNothing) {
  const std::string expected = reference();
  for (const int vessel : {1, 2}) {
    SweepTrial trial(folder / "a.nc");
    int runs = 0;
    trial.before_run = [&] {
      if (++runs == vessel) raise(SIGINT);
    };
    const SweepOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::interrupted) << outcome.error;
    SweepTrial rest(folder / "a.nc");
    rest.options.resume = true;
    const SweepOutcome resumed = rest.run();
    EXPECT_EQ(resumed.code, ExitCode::done) << resumed.error;
    EXPECT_TRUE(has(resumed.notes, "continuing ")) << resumed.notes;
    expect_same_as(expected, folder / "a.nc");
    std::filesystem::remove(folder / "a.nc");
  }
}

TEST_F(RunTest, ResumeWithoutAnythingStartsAfresh) {
  const std::string expected = reference();
  SweepTrial trial(folder / "a.nc");
  trial.options.resume = true;
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::done);
  EXPECT_TRUE(has(outcome.notes, "starting from the first grip")) << outcome.notes;
  expect_same_as(expected, folder / "a.nc");
}

TEST_F(RunTest, ResumeOfWhatIsCompleteLeavesIt) {
  const std::string expected = reference();
  const auto written = std::filesystem::last_write_time(expected);
  SweepTrial trial(expected);
  trial.options.resume = true;
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::done);
  EXPECT_TRUE(has(outcome.notes, "is complete, so nothing is left to do")) << outcome.notes;
  EXPECT_EQ(trial.opened, 0);
  EXPECT_EQ(std::filesystem::last_write_time(expected), written);
}

TEST_F(RunTest, ResumeOfSomethingElseThatIsCompleteIsRefused) {
  const std::string whole = reference();
  const std::string before = file_text(whole);
  const auto refused = [&](const std::string& path, const char* what, const std::function<void(SweepTrial&)>& change) {
    SweepTrial trial(path);
    trial.options.resume = true;
    change(trial);
    const SweepOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage) << what;
    EXPECT_TRUE(has(outcome.error, what)) << outcome.error;
    EXPECT_EQ(trial.opened, 0) << what;
  };
  refused(whole, "but has another text of the scene", [](SweepTrial& trial) { trial.scene.text += "# changed"; });
  refused(whole, "but has another precision", [](SweepTrial& trial) {
    trial.options.precision = read_text(trial.options.output, "", "precision") == "float" ? Precision::full : Precision::single;
  });
  refused(whole, "but has another backend",
          [](SweepTrial& trial) { trial.options.on = trial.options.on == "core" ? "vulkan" : "core"; });
  refused(whole, "it lacks joints", [](SweepTrial& trial) { trial.scene.output.keep = {{"joints"}}; });
  EXPECT_EQ(file_text(whole), before);
  std::ofstream(folder / "other.nc") << "not a result";
  refused(folder / "other.nc", "is not a result file", [](SweepTrial&) {});
}

TEST_F(RunTest, ResumeWithAnotherMeshIsRefused) {
  const auto with_mesh = [&](const std::string& key) {
    SweepTrial trial(folder / "a.nc");
    MeshBody body;
    body.key = key;
    trial.scene.vessels[1].mesh = MeshData{};
    trial.scene.vessels[1].mesh->body = std::make_shared<MeshBody>(body);
    return trial;
  };
  SweepTrial begun = with_mesh("first");
  int chunks = 0;
  begun.before_chunk = [&] {
    if (++chunks == 2) raise(SIGINT);
  };
  EXPECT_EQ(begun.run().code, ExitCode::interrupted);
  SweepTrial other = with_mesh("second"), same = with_mesh("first");
  other.options.resume = same.options.resume = true;
  const SweepOutcome refused = other.run();
  EXPECT_EQ(refused.code, ExitCode::usage);
  EXPECT_TRUE(has(refused.error, "another set of meshes")) << refused.error;
  EXPECT_EQ(same.run().code, ExitCode::done);
}

TEST_F(RunTest, ResumeOfSomethingElseIsRefused) {
  const auto begin = [&] {
    SweepTrial trial(folder / "a.nc");
    int chunks = 0;
    trial.before_chunk = [&] {
      if (++chunks == 2) raise(SIGINT);
    };
    EXPECT_EQ(trial.run().code, ExitCode::interrupted);
  };
  begin();
  const auto refused = [&](const char* what, const std::function<void(SweepTrial&)>& change) {
    SweepTrial trial(folder / "a.nc");
    trial.options.resume = true;
    change(trial);
    const SweepOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage) << what;
    EXPECT_TRUE(has(outcome.error, std::string("another ") + what)) << outcome.error;
  };
  refused("text of the scene", [](SweepTrial& trial) { trial.scene.text += "# changed"; });
  refused("driver", [](SweepTrial& trial) { trial.driver = "fake driver 2"; });
  refused("precision", [](SweepTrial& trial) { trial.precision = Precision::single; });
  refused("number of best grips", [](SweepTrial& trial) { trial.options.best = 7; });
  refused("number of grips", [](SweepTrial& trial) { trial.scene.grips.roll = range_axis(0, 1, 5); });
  refused("set of variables", [](SweepTrial& trial) { trial.scene.output.keep = {{"score"}}; });
  SweepTrial trial(folder / "a.nc");
  trial.options.resume = true;
  EXPECT_EQ(trial.run().code, ExitCode::done) << "a refusal leaves the file as it was";
}

TEST_F(RunTest, DamagedMarkIsRefusedInOneLine) {
  std::ofstream(folder / "a.nc.partial") << NETCDF4_START;
  std::ofstream(folder / "a.nc.partial.mark") << MARK_START << "2 00";
  SweepTrial trial(folder / "a.nc");
  trial.options.resume = true;
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::failure);
  EXPECT_TRUE(has(outcome.error, "start again without --resume")) << outcome.error;
}

// Damage of a partial file anywhere: what --resume makes of it is the undisturbed result, or it is refused; never something else.
TEST_F(RunTest, ADamagedPartialFileIsNeverTrusted) {
  const std::string expected = reference(quick_scene()), path = folder / "a.nc";
  SweepTrial begun(path);
  begun.scene = quick_scene();
  begun.options.tuning.mark_seconds = 0;
  int chunks = 0;
  begun.before_chunk = [&] {
    if (++chunks == 9) raise(SIGINT);
  };
  ASSERT_EQ(begun.run().code, ExitCode::interrupted);
  const std::string partial = file_text(path + ".partial"), mark = file_text(path + ".partial.mark");
  const auto resume = [&](const std::string& damaged) {
    std::ofstream(path + ".partial", std::ios::binary) << damaged;
    std::ofstream(path + ".partial.mark", std::ios::binary) << mark;
    SweepTrial trial(path);
    trial.scene = quick_scene();
    trial.options.resume = true;
    const SweepOutcome outcome = trial.run();
    EXPECT_TRUE(outcome.code == ExitCode::done || !outcome.error.empty());
    if (outcome.code == ExitCode::done) expect_same_values(expected, path);
    std::filesystem::remove(path);
    return outcome;
  };
  EXPECT_FALSE(has(resume(partial).notes, "damaged")) << "as it was left";
  std::mt19937 random(4);
  int noticed = 0;
  for (int k = 0; k < 24; ++k) {
    std::string damaged = partial;
    const std::size_t at = random() % (partial.size() - 8);
    damaged.replace(at, 8, "\x7f\xff\xff\xff\xff\xff\xff\xff", 8);
    const SweepOutcome outcome = resume(damaged);
    noticed += has(outcome.notes, "damaged");
    EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
  }
  EXPECT_GT(noticed, 8);
  EXPECT_EQ(resume(partial.substr(0, partial.size() / 2)).code, ExitCode::done) << "cut";
  EXPECT_EQ(resume("").code, ExitCode::done) << "emptied";
}

// Leaves a sweep to `path` interrupted after eight chunks, with four bytes of its grips changed since.
void leave_damaged_grips(const std::string& path) {
  SweepTrial begun(path);
  begun.options.tuning.mark_seconds = 0;
  int chunks = 0;
  begun.before_chunk = [&] {
    if (++chunks == 9) raise(SIGINT);
  };
  ASSERT_EQ(begun.run().code, ExitCode::interrupted);
  SweepMark mark;
  ASSERT_TRUE(load_mark(path + ".partial.mark", mark));
  std::fstream bytes(path + ".partial", std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(static_cast<std::streamoff>(mark.in_place[0].offset + 16)).write("\1\2\3\4", 4).flush();
}

TEST_F(RunTest, DamagedGripsAloneAreComputedAgain) {
  const std::string expected = reference(), path = folder / "a.nc";
  leave_damaged_grips(path);
  SweepTrial rest(path);
  rest.options.resume = true;
  const SweepOutcome outcome = rest.run();
  EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
  EXPECT_TRUE(has(outcome.notes, "continuing ")) << outcome.notes;
  EXPECT_TRUE(has(outcome.notes, ".partial: grips 0 to ") && has(outcome.notes, " are damaged: computing them again"))
      << outcome.notes;
  expect_same_as(expected, path);
}

TEST_F(RunTest, AnInterruptWhileDamagedGripsAreComputedAgainLosesNothing) {
  const std::string expected = reference(), path = folder / "a.nc";
  leave_damaged_grips(path);
  SweepTrial repairing(path);
  repairing.options.resume = true;
  int runs = 0;
  repairing.before_run = [&] {
    if (++runs == 1) raise(SIGINT);
  };
  const SweepOutcome interrupted = repairing.run();
  EXPECT_EQ(interrupted.code, ExitCode::interrupted) << interrupted.error;
  EXPECT_TRUE(has(interrupted.notes, " are damaged: computing them again")) << interrupted.notes;
  EXPECT_FALSE(file_exists(path));
  SweepTrial rest(path);
  rest.options.resume = true;
  const SweepOutcome outcome = rest.run();
  EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
  EXPECT_TRUE(has(outcome.notes, "continuing ") && has(outcome.notes, " are damaged: computing them again")) << outcome.notes;
  expect_same_as(expected, path);
}

TEST_F(RunTest, TheTimeLimitHoldsWhileDamagedGripsAreComputedAgain) {
  const std::string expected = reference(), path = folder / "a.nc";
  leave_damaged_grips(path);
  SweepTrial repairing(path);
  repairing.options.resume = true;
  repairing.chunk = 10;
  int chunks = 0;
  repairing.before_chunk = [&] {
    if (++chunks == 2) repairing.options.time_limit = 1e-9;
  };
  const SweepOutcome cut = repairing.run();
  EXPECT_EQ(cut.code, ExitCode::interrupted) << cut.error;
  EXPECT_TRUE(has(cut.notes, " are damaged: computing them again")) << cut.notes;
  EXPECT_LT(chunks, 5);
  SweepTrial rest(path);
  rest.options.resume = true;
  EXPECT_EQ(rest.run().code, ExitCode::done);
  expect_same_as(expected, path);
}

// A mark that was altered with a checksum that fits: what it says must go together all the same.
TEST_F(RunTest, AMarkThatContradictsItselfIsRefused) {
  const std::string path = folder / "a.nc";
  SweepTrial begun(path);
  begun.options.tuning.mark_seconds = 0;
  int chunks = 0;
  begun.before_chunk = [&] {
    if (++chunks == 8) raise(SIGINT);
  };
  ASSERT_EQ(begun.run().code, ExitCode::interrupted);
  SweepMark mark;
  ASSERT_TRUE(load_mark(path + ".partial.mark", mark));
  for (const std::uint64_t done : {std::uint64_t{279}, ~std::uint64_t{0}, std::uint64_t{1} << 63}) {
    SweepMark altered = mark;
    altered.vessels[1].done = done;
    save_mark(path + ".partial.mark", altered);
    SweepTrial rest(path);
    rest.options.resume = true;
    const SweepOutcome outcome = rest.run();
    EXPECT_EQ(outcome.code, ExitCode::failure) << done;
    EXPECT_TRUE(has(outcome.error, "contradicts itself")) << outcome.error;
    EXPECT_FALSE(file_exists(path));
  }
}

}  // namespace
}  // namespace wholehand::sweeps

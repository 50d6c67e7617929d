// SPDX-License-Identifier: MIT
// sanitizers: address thread
#include "sweeps/run.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "core/core_backend.h"
#include "core/mesh_body.h"
#include "shaders/layout.h"
#include "sweeps/mark.h"
#include "sweeps/plan.h"
#include "system/files.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

struct TrialOutcome {
  ExitCode code = ExitCode::done;
  std::string error, out, notes;
};

// A sweep over the stand-in kernels.
struct Trial {
  Scene scene = fake_scene();
  SweepOptions options;
  Precision precision = Precision::full;
  std::size_t chunk = 50;
  std::function<void()> before_run, before_chunk;
  std::string driver = "fake driver 1";
  int opened = 0;  // backends

  explicit Trial(const std::string& output) {
    options.output = output;
    options.on = "fake";
    options.precision = Precision::full;
  }

  ExitCode run_bare() {
    const SweepParts parts{[this](const FieldSet& fields) -> std::unique_ptr<Backend> {
                             auto backend = std::make_unique<FakeBackend>(scene, fields, precision, chunk);
                             backend->before_run = before_run;
                             backend->before_chunk = before_chunk;
                             backend->info_.driver = driver;
                             ++opened;
                             return backend;
                           },
                           [this] { return std::make_unique<FakeEvaluator>(scene); }};
    return run_sweep(scene, options, parts);
  }

  TrialOutcome run() {
    TrialOutcome outcome;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      outcome.code = run_bare();
    } catch (const Error& error) {
      outcome.code = error.code;
      outcome.error = error.what();
    }
    outcome.out = testing::internal::GetCapturedStdout();
    outcome.notes = testing::internal::GetCapturedStderr();
    EXPECT_EQ(outcome.error.find('\n'), std::string::npos) << outcome.error;
    return outcome;
  }

  // In a process of its own, without a word.
  pid_t start() {
    const pid_t child = fork();
    if (child != 0) return child;
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    int code = 99;
    try {
      code = static_cast<int>(run_bare());
    } catch (const Error& error) {
      code = static_cast<int>(error.code);
    }
    _exit(code);
  }
};

int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// The list beside a result without what each row ends with: the names of the result and of the sweep, which tell the backend.
std::string list_beside(const std::string& result) {
  std::istringstream rows(file_text(output_names(result).best));
  std::string text;
  for (std::string row; std::getline(rows, row);) {
    for (int k = 0; k < 2; ++k) row.resize(std::min(row.size(), row.rfind(',')));
    text += row + "\n";
  }
  return text;
}

class RunTest : public testing::Test {
 protected:
  TemporaryFolder folder;

  // An undisturbed sweep to compare with.
  std::string reference(const Scene& scene = fake_scene()) {
    Trial trial(folder / "reference.nc");
    trial.scene = scene;
    EXPECT_EQ(trial.run().code, ExitCode::done);
    return folder / "reference.nc";
  }

  void expect_same_as(const std::string& reference, const std::string& other) {
    expect_same_values(reference, other);
    EXPECT_EQ(list_beside(reference), list_beside(other));
    EXPECT_EQ(file_text(output_names(reference).heat_map("second")), file_text(output_names(other).heat_map("second")));
  }
};

TEST_F(RunTest, WritesAllFilesAndSaysWhatItDid) {
  Trial trial(folder / "a.nc");
  const TrialOutcome outcome = trial.run();
  ASSERT_EQ(outcome.code, ExitCode::done) << outcome.error;
  for (const char* name : {"a.nc", "a.best.csv", "a.first_vessel.svg", "a.second.svg"})
    EXPECT_TRUE(file_exists(folder / name)) << name;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_FALSE(has(entry.path().string(), "partial")) << entry.path();
  }
  EXPECT_TRUE(has(outcome.out, "fake: 560 grips of 2 vessels, 8 states each\non fake device (fake driver 1), double precision\n"));
  EXPECT_TRUE(has(outcome.out, "azimuth left out")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "first vessel: ")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, " of 280 grips (each at 3 azimuths) feasible (")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "everything else")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "peak memory")) << outcome.out;
  EXPECT_EQ(outcome.notes, "") << "nothing on stderr";
  EXPECT_EQ(trial.opened, 1) << "the default set has all that the best grips need";
}

TEST_F(RunTest, BestGripsAreThoseOfTheWholeVessel) {
  Trial trial(folder / "a.nc");
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
      Trial trial(folder / "a.nc");
      trial.options.mark_seconds = 0;  // the lists go through marks too
      trial.scene.grips.hand_scale.values = {1.1, 0.9, 1};
      if (is_sobol) {
        trial.scene.grips.sampling = Sampling::sobol;
        trial.scene.grips.count = 400;
      }
      if (!keeps) trial.scene.output.keep = std::vector<std::string>{};
      const TrialOutcome outcome = trial.run();
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
      EXPECT_TRUE(has(outcome.out, "\nfirst vessel, hand scale 1.1:\n  rank")) << outcome.out;
      EXPECT_TRUE(has(outcome.out, "\nsecond, hand scale 0.9:\n  rank")) << outcome.out;
      const std::string csv = file_text(folder / "a.best.csv");
      EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 6 * 6);
    }
  }
}

TEST_F(RunTest, ARangeOfSobolHandsAndOneHandHaveOneList) {
  Trial trial(folder / "a.nc");
  trial.scene.grips.sampling = Sampling::sobol;
  trial.scene.grips.count = 100;
  trial.scene.grips.hand_scale = range_axis(0.9, 1.1, 2);
  ASSERT_EQ(trial.run().code, ExitCode::done);
  EXPECT_EQ(dimension_names(folder / "a.nc", "best_score"), (std::vector<std::string>{"vessel", "rank"}));
  EXPECT_EQ(dimension_names(reference(), "best_score"), (std::vector<std::string>{"vessel", "rank"}));
}

TEST_F(RunTest, ABestAtTheEndOfAnAxisIsSaid) {
  Trial trial(folder / "a.nc");
  trial.scene.grips.height = trial.scene.grips.obliquity = range_axis(0.5, 0.5, 1);
  trial.scene.grips.offset = range_axis(0, 0, 1);
  trial.scene.grips.roll = range_axis(radians(-90), radians(0), 2);  // each of two values is an end
  const std::string line = "\n  the best lies on the edge of roll_deg; widen it?\n", out = trial.run().out;
  const std::size_t second = out.rfind("\nsecond: ");  // the first says what it holds
  ASSERT_NE(second, std::string::npos) << out;
  EXPECT_LT(out.find(line), second) << out;
  EXPECT_NE(out.find(line, second), std::string::npos) << out;
  trial.scene.grips.roll = range_axis(0, 0, 1);
  EXPECT_FALSE(has(trial.run().out, "edge")) << "nothing was searched";
}

TEST_F(RunTest, EverythingCanBeLeftOutButTheBest) {
  Trial trial(folder / "a.nc");
  trial.scene.output.keep = std::vector<std::string>{};
  const TrialOutcome outcome = trial.run();
  ASSERT_EQ(outcome.code, ExitCode::done) << outcome.error;
  EXPECT_EQ(trial.opened, 2) << "the best grips are evaluated anew with all that is told of them";
  EXPECT_TRUE(has(outcome.notes, "no heat maps: the score is not kept")) << outcome.notes;
  EXPECT_TRUE(has(outcome.out, "first vessel: 280 grips (each at 3 azimuths)\n")) << outcome.out;
  Trial whole(folder / "b.nc");
  ASSERT_EQ(whole.run().code, ExitCode::done);
  EXPECT_EQ(list_beside(folder / "a.nc"), list_beside(folder / "b.nc"));
  EXPECT_EQ(read_values(folder / "a.nc", "best_grip"), read_values(folder / "b.nc", "best_grip"));
}

TEST_F(RunTest, MarksInBetweenChangeNothing) {
  const std::string expected = reference();
  Trial trial(folder / "a.nc");
  trial.options.mark_seconds = 0;
  trial.chunk = 9;
  ASSERT_EQ(trial.run().code, ExitCode::done);
  expect_same_as(expected, folder / "a.nc");
  Trial none(folder / "b.nc");
  none.options.mark_seconds = 0;
  none.scene.output.keep = std::vector<std::string>{};
  ASSERT_EQ(none.run().code, ExitCode::done);
  EXPECT_EQ(list_beside(folder / "b.nc"), list_beside(folder / "reference.nc"));
}

TEST_F(RunTest, KilledAndResumedIsTheSameBitForBit) {
  const std::string expected = reference();
  std::mt19937 random(2);
  int kills = 0, resumed = 0;
  for (int round = 0; round < 5; ++round) {
    for (int attempt = 0; !file_exists(folder / "a.nc"); ++attempt) {
      ASSERT_LT(attempt, 50);
      int chunks[2];  // a byte for every chunk that the child begins
      ASSERT_EQ(pipe2(chunks, O_CLOEXEC), 0);
      Trial trial(folder / "a.nc");
      trial.options.resume = attempt > 0;
      trial.options.mark_seconds = 0;
      trial.chunk = 20;
      trial.before_chunk = [&] { EXPECT_EQ(write(chunks[1], "x", 1), 1); };
      resumed += attempt > 0 && file_exists(folder / "a.nc.partial.mark");
      const pid_t child = trial.start();
      close(chunks[1]);
      // killed between the first chunks and the last rename
      char byte = 0;
      for (unsigned wait = 3 + random() % 12; wait > 0 && read(chunks[0], &byte, 1) == 1; --wait) {
      }
      usleep(random() % 10000);
      kill(child, SIGKILL);
      const int code = wait_for(child);
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
    Trial trial(folder / "a.nc");
    int chunks = 0;
    trial.before_chunk = [&] {
      if (++chunks == 8) raise(signal);
    };
    const TrialOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::interrupted);
    EXPECT_EQ(static_cast<int>(outcome.code), 130);
    EXPECT_TRUE(has(outcome.notes, "interrupted at 3")) << outcome.notes;  // the eighth chunk is finished
    EXPECT_FALSE(file_exists(folder / "a.nc"));
    Trial rest(folder / "a.nc");
    rest.options.resume = true;
    int rest_chunks = 0;
    rest.before_chunk = [&] { ++rest_chunks; };
    const TrialOutcome resumed = rest.run();
    EXPECT_EQ(resumed.code, ExitCode::done) << resumed.error;
    EXPECT_TRUE(has(resumed.notes, "going on with")) << resumed.notes;
    EXPECT_LT(rest_chunks, 9) << "only what was missing, and the best";
    expect_same_as(expected, folder / "a.nc");
    EXPECT_EQ(resumed.out.substr(resumed.out.find("first vessel: ")).substr(0, 200),
              Trial(folder / "c.nc").run().out.substr(resumed.out.find("first vessel: ")).substr(0, 200))
        << "counts are those of the whole";
    std::filesystem::remove(folder / "a.nc");
  }
}

TEST_F(RunTest, AnInterruptBeforeTheFirstGripOfAVesselLosesNothing) {
  const std::string expected = reference();
  for (const int vessel : {1, 2}) {
    Trial trial(folder / "a.nc");
    int runs = 0;
    trial.before_run = [&] {
      if (++runs == vessel) raise(SIGINT);
    };
    const TrialOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::interrupted) << outcome.error;
    Trial rest(folder / "a.nc");
    rest.options.resume = true;
    const TrialOutcome resumed = rest.run();
    EXPECT_EQ(resumed.code, ExitCode::done) << resumed.error;
    EXPECT_TRUE(has(resumed.notes, "going on with")) << resumed.notes;
    expect_same_as(expected, folder / "a.nc");
    std::filesystem::remove(folder / "a.nc");
  }
}

TEST_F(RunTest, ResumeWithoutAnythingStartsAfresh) {
  const std::string expected = reference();
  Trial trial(folder / "a.nc");
  trial.options.resume = true;
  const TrialOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::done);
  EXPECT_TRUE(has(outcome.notes, "starting from the first grip")) << outcome.notes;
  expect_same_as(expected, folder / "a.nc");
}

TEST_F(RunTest, ResumeOfWhatIsCompleteLeavesIt) {
  const std::string expected = reference();
  const auto written = std::filesystem::last_write_time(expected);
  Trial trial(expected);
  trial.options.resume = true;
  const TrialOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::done);
  EXPECT_TRUE(has(outcome.notes, "is complete: nothing to go on with")) << outcome.notes;
  EXPECT_EQ(trial.opened, 0);
  EXPECT_EQ(std::filesystem::last_write_time(expected), written);
}

TEST_F(RunTest, ResumeOfSomethingElseThatIsCompleteIsRefused) {
  const std::string whole = reference();
  const std::string before = file_text(whole);
  const auto refused = [&](const std::string& path, const char* what, const std::function<void(Trial&)>& change) {
    Trial trial(path);
    trial.options.resume = true;
    change(trial);
    const TrialOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage) << what;
    EXPECT_TRUE(has(outcome.error, what)) << outcome.error;
    EXPECT_EQ(trial.opened, 0) << what;
  };
  refused(whole, "of another scene", [](Trial& trial) { trial.scene.text += "# changed"; });
  refused(whole, "of another precision", [](Trial& trial) {
    trial.options.precision = read_text(trial.options.output, "", "precision") == "float" ? Precision::full : Precision::single;
  });
  refused(whole, "of another backend", [](Trial& trial) { trial.options.on = trial.options.on == "core" ? "vulkan" : "core"; });
  refused(whole, "it lacks joints", [](Trial& trial) { trial.scene.output.keep = {{"joints"}}; });
  EXPECT_EQ(file_text(whole), before);
  std::ofstream(folder / "other.nc") << "not a result";
  refused(folder / "other.nc", "is no result file", [](Trial&) {});
}

TEST_F(RunTest, ResumeWithAnotherMeshIsRefused) {
  const auto with_mesh = [&](const std::string& key) {
    Trial trial(folder / "a.nc");
    MeshBody body;
    body.key = key;
    trial.scene.vessels[1].mesh = MeshData{};
    trial.scene.vessels[1].mesh->body = std::make_shared<MeshBody>(body);
    return trial;
  };
  Trial begun = with_mesh("first");
  int chunks = 0;
  begun.before_chunk = [&] {
    if (++chunks == 2) raise(SIGINT);
  };
  EXPECT_EQ(begun.run().code, ExitCode::interrupted);
  Trial other = with_mesh("second"), same = with_mesh("first");
  other.options.resume = same.options.resume = true;
  const TrialOutcome refused = other.run();
  EXPECT_EQ(refused.code, ExitCode::usage);
  EXPECT_TRUE(has(refused.error, "another set of meshes")) << refused.error;
  EXPECT_EQ(same.run().code, ExitCode::done);
}

TEST_F(RunTest, ResumeOfSomethingElseIsRefused) {
  const auto begin = [&] {
    Trial trial(folder / "a.nc");
    int chunks = 0;
    trial.before_chunk = [&] {
      if (++chunks == 2) raise(SIGINT);
    };
    EXPECT_EQ(trial.run().code, ExitCode::interrupted);
  };
  begin();
  const auto refused = [&](const char* what, const std::function<void(Trial&)>& change) {
    Trial trial(folder / "a.nc");
    trial.options.resume = true;
    change(trial);
    const TrialOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage) << what;
    EXPECT_TRUE(has(outcome.error, std::string("another ") + what)) << outcome.error;
  };
  refused("scene", [](Trial& trial) { trial.scene.text += "# changed"; });
  refused("driver", [](Trial& trial) { trial.driver = "fake driver 2"; });
  refused("precision", [](Trial& trial) { trial.precision = Precision::single; });
  refused("number of best grips", [](Trial& trial) { trial.options.best = 7; });
  refused("number of grips", [](Trial& trial) { trial.scene.grips.roll = range_axis(0, 1, 5); });
  refused("set of variables", [](Trial& trial) { trial.scene.output.keep = {{"score"}}; });
  Trial trial(folder / "a.nc");
  trial.options.resume = true;
  EXPECT_EQ(trial.run().code, ExitCode::done) << "a refusal leaves the file as it was";
}

TEST_F(RunTest, DamagedMarkIsRefusedInOneLine) {
  std::ofstream(folder / "a.nc.partial") << NETCDF4_START;
  std::ofstream(folder / "a.nc.partial.mark") << MARK_START << "2 00";
  Trial trial(folder / "a.nc");
  trial.options.resume = true;
  const TrialOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::failure);
  EXPECT_TRUE(has(outcome.error, "start again without --resume")) << outcome.error;
}

// Without pictures, which take most of a short sweep's time.
Scene quick_scene() {
  Scene scene = fake_scene();
  scene.output.keep = {{"gap", "reason"}};
  return scene;
}

// Damage of a partial file anywhere: what --resume makes of it is the undisturbed result, or it is refused; never something else.
TEST_F(RunTest, ADamagedPartialFileIsNeverTrusted) {
  const std::string expected = reference(quick_scene()), path = folder / "a.nc";
  Trial begun(path);
  begun.scene = quick_scene();
  begun.options.mark_seconds = 0;
  int chunks = 0;
  begun.before_chunk = [&] {
    if (++chunks == 9) raise(SIGINT);
  };
  ASSERT_EQ(begun.run().code, ExitCode::interrupted);
  const std::string partial = file_text(path + ".partial"), mark = file_text(path + ".partial.mark");
  const auto resume = [&](const std::string& damaged) {
    std::ofstream(path + ".partial", std::ios::binary) << damaged;
    std::ofstream(path + ".partial.mark", std::ios::binary) << mark;
    Trial trial(path);
    trial.scene = quick_scene();
    trial.options.resume = true;
    const TrialOutcome outcome = trial.run();
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
    const TrialOutcome outcome = resume(damaged);
    noticed += has(outcome.notes, "damaged");
    EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
  }
  EXPECT_GT(noticed, 8);
  EXPECT_EQ(resume(partial.substr(0, partial.size() / 2)).code, ExitCode::done) << "cut";
  EXPECT_EQ(resume("").code, ExitCode::done) << "emptied";
}

// Leaves a sweep to `path` interrupted after eight chunks, with four bytes of its grips changed since.
void leave_damaged_grips(const std::string& path) {
  Trial begun(path);
  begun.options.mark_seconds = 0;
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
  Trial rest(path);
  rest.options.resume = true;
  const TrialOutcome outcome = rest.run();
  EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
  EXPECT_TRUE(has(outcome.notes, "going on with")) << outcome.notes;
  EXPECT_TRUE(has(outcome.notes, ".partial: grips 0 to ") && has(outcome.notes, " are damaged: computing them again"))
      << outcome.notes;
  expect_same_as(expected, path);
}

TEST_F(RunTest, AnInterruptWhileDamagedGripsAreComputedAgainLosesNothing) {
  const std::string expected = reference(), path = folder / "a.nc";
  leave_damaged_grips(path);
  Trial repairing(path);
  repairing.options.resume = true;
  int runs = 0;
  repairing.before_run = [&] {
    if (++runs == 1) raise(SIGINT);
  };
  const TrialOutcome interrupted = repairing.run();
  EXPECT_EQ(interrupted.code, ExitCode::interrupted) << interrupted.error;
  EXPECT_TRUE(has(interrupted.notes, " are damaged: computing them again")) << interrupted.notes;
  EXPECT_FALSE(file_exists(path));
  Trial rest(path);
  rest.options.resume = true;
  const TrialOutcome outcome = rest.run();
  EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
  EXPECT_TRUE(has(outcome.notes, "going on with") && has(outcome.notes, " are damaged: computing them again")) << outcome.notes;
  expect_same_as(expected, path);
}

// A mark that was altered with a checksum that fits: what it says must go together all the same.
TEST_F(RunTest, AMarkThatContradictsItselfIsRefused) {
  const std::string path = folder / "a.nc";
  Trial begun(path);
  begun.options.mark_seconds = 0;
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
    Trial rest(path);
    rest.options.resume = true;
    const TrialOutcome outcome = rest.run();
    EXPECT_EQ(outcome.code, ExitCode::failure) << done;
    EXPECT_TRUE(has(outcome.error, "says what cannot be")) << outcome.error;
    EXPECT_FALSE(file_exists(path));
  }
}

// Two starts at the same moment: one of them does the sweep, or both one after the other; the file is whole whatever they do.
TEST_F(RunTest, TwoAtOnceAreOneAfterTheOtherOrOneIsRefused) {
  const std::string expected = reference(quick_scene());
  for (int round = 0; round < 15; ++round) {
    int start[2];
    ASSERT_EQ(pipe(start), 0);
    pid_t children[2];
    for (pid_t& child : children) {
      child = fork();
      if (child != 0) continue;
      close(start[1]);
      char byte = 0;
      if (read(start[0], &byte, 1) != 0) _exit(98);
      Trial trial(folder / "a.nc");
      trial.scene = quick_scene();
      _exit(wait_for(trial.start()));
    }
    close(start[0]);
    close(start[1]);  // both start now
    int done = 0;
    for (const pid_t child : children) {
      const int code = wait_for(child);
      EXPECT_TRUE(code == 0 || code == 2) << code;
      done += code == 0;
    }
    EXPECT_GE(done, 1);
    expect_same_values(expected, folder / "a.nc");
    for (const char* left : {".partial", ".partial.mark", ".partial.lock"})
      EXPECT_FALSE(file_exists(folder / "a.nc" + left)) << left;
    std::filesystem::remove(folder / "a.nc");
  }
}

TEST_F(RunTest, WhoWritesAResultIsNamedAndUndisturbed) {
  const std::string expected = reference(), path = folder / "a.nc";
  Trial first(path);
  TrialOutcome second, resumed;
  int chunks = 0;
  first.before_chunk = [&] {
    if (++chunks != 4) return;
    for (const bool resume : {false, true}) {
      Trial other(path);
      other.options.resume = resume;
      try {
        other.run_bare();
        ADD_FAILURE() << "two at once";
      } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::usage);
        EXPECT_TRUE(has(error.what(), "process " + std::to_string(getpid()) + " (")) << error.what();
      }
      EXPECT_EQ(other.opened, 0);
    }
  };
  EXPECT_EQ(first.run().code, ExitCode::done);
  EXPECT_GE(chunks, 4);
  expect_same_as(expected, path);
}

TEST_F(RunTest, ALinkIsFollowedToItsFile) {
  std::filesystem::create_directory(folder / "data");
  std::filesystem::create_symlink("data/target.nc", folder / "a.nc");
  for (int round = 0; round < 2; ++round) {  // the file new, then there
    Trial trial(folder / "a.nc");
    bool is_beside_target = false;
    trial.before_chunk = [&] { is_beside_target = file_exists(folder / "data/target.nc.partial"); };
    ASSERT_EQ(trial.run().code, ExitCode::done);
    EXPECT_TRUE(is_beside_target);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.nc"));
    expect_same_values(reference(), folder / "data/target.nc");
    EXPECT_TRUE(file_exists(folder / "a.best.csv"));
  }
}

TEST_F(RunTest, CompanionsOfOthersAreRefusedBeforeAnyWork) {
  for (const char* name : {"a.best.csv", "a.second.svg"}) {
    std::ofstream(folder / name) << "mine";
    Trial trial(folder / "a.nc");
    const TrialOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage);
    EXPECT_TRUE(has(outcome.error, name)) << outcome.error;
    EXPECT_EQ(trial.opened, 0);
    EXPECT_EQ(file_text(folder / name), "mine");
    std::filesystem::remove(folder / name);
  }
  // what a sweep without best grips would remove
  std::ofstream(folder / "a.best.csv") << "mine";
  Trial none(folder / "a.nc");
  none.options.best = 0;
  EXPECT_EQ(none.run().code, ExitCode::done);
  EXPECT_EQ(file_text(folder / "a.best.csv"), "mine");
  std::filesystem::remove(folder / "a.best.csv");
  for (const int best : {3, 0}) {
    Trial own(folder / "a.nc");
    own.options.best = best;
    const TrialOutcome outcome = own.run();
    EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
    EXPECT_EQ(file_exists(folder / "a.best.csv"), best > 0) << "its own it replaces and removes";
  }
}

TEST_F(RunTest, WhatIsCompleteNeedsNoRoom) {
  const std::string whole = reference();
  Trial trial(whole);
  trial.options.resume = true;
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_FSIZE, &none);
    _exit(wait_for(trial.start()));
  }
  EXPECT_EQ(wait_for(child), 0);
}

TEST_F(RunTest, WhatCannotBeWrittenIsRefusedBeforeAnyWork) {
  for (const std::string& path : {folder.path(), folder / "missing/a.nc", std::string("/dev/full")}) {
    Trial trial(path);
    const TrialOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage) << path;
    EXPECT_EQ(trial.opened, 0) << path;
    EXPECT_EQ(outcome.notes, "") << path;
  }
  Trial trial("/proc/a.nc");
  const TrialOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::failure);
  EXPECT_EQ(outcome.notes, "");
}

TEST_F(RunTest, FileSizeLimitAndFullDisk) {
  const auto size = std::filesystem::file_size(reference());
  // too small for the values, for the structure besides, and for the last byte
  for (const rlim_t limit : {size / 4, size * 9 / 10, size - 1}) {
    Trial trial(folder / "a.nc");
    const pid_t child = fork();
    if (child == 0) {
      const rlimit file_size{limit, limit};
      setrlimit(RLIMIT_FSIZE, &file_size);
      _exit(wait_for(trial.start()));
    }
    EXPECT_EQ(wait_for(child), 3) << limit;
    for (const char* name : {"a.nc", "a.nc.partial", "a.best.csv"}) EXPECT_FALSE(file_exists(folder / name)) << limit << name;
  }
}

TEST_F(RunTest, HugeSweepsAreRefusedWithTheirSizes) {
  Trial trial(folder / "a.nc");
  trial.scene.grips.obliquity = trial.scene.grips.roll = trial.scene.grips.offset = range_axis(0, 1, 10000);
  const TrialOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::usage);
  EXPECT_TRUE(has(outcome.error, "grips, ") && has(outcome.error, "states, ") && has(outcome.error, " of results"))
      << outcome.error;
  EXPECT_EQ(trial.opened, 0);
}

TEST_F(RunTest, FailureOfTheBackendLeavesNoResult) {
  Trial trial(folder / "a.nc");
  int chunks = 0;
  trial.before_chunk = [&] {
    if (++chunks == 5) throw failure_error("device lost");
  };
  const TrialOutcome outcome = trial.run();
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
  SweepOptions options;
  options.output = folder / "a.nc";
  const SweepParts parts{[&](const FieldSet& fields) { return std::make_unique<Silent>(scene, fields, Precision::full, 10); },
                         [&] { return std::make_unique<FakeEvaluator>(scene); }};
  testing::internal::CaptureStdout();
  EXPECT_THROW(run_sweep(scene, options, parts), Error);
  testing::internal::GetCapturedStdout();
}

TEST_F(RunTest, CoreOnThreadsGivesTheSameFile) {
  const std::string expected = reference();
  const Scene scene = fake_scene();
  SweepOptions options;
  options.output = folder / "a.nc";
  const SweepParts parts{[&](const FieldSet& fields) {
                           return std::make_unique<CoreBackend>(std::make_unique<FakeEvaluator>(scene), scene, fields,
                                                                Precision::full, 3);
                         },
                         [&] { return std::make_unique<FakeEvaluator>(scene); }};
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_sweep(scene, options, parts), ExitCode::done);
  testing::internal::GetCapturedStdout();
  expect_same_as(expected, folder / "a.nc");
}

TEST_F(RunTest, SobolRepeatsWithItsSeed) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 700;
  scene.grips.seed = 5;
  const std::string expected = reference(scene);
  Trial again(folder / "a.nc"), other(folder / "b.nc");
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
      Trial trial(folder / "a.nc");
      trial.scene.grips.sampling = sampling;
      trial.scene.grips.count = 300;
      trial.precision = precision;
      ASSERT_EQ(trial.run().code, ExitCode::done);
      // Debian's own python3, which Debian's xarray belongs to
      const std::string command = "/usr/bin/python3 " WHOLEHAND_SOURCE_DIR "/tests/sweeps/xarray_test.py " + (folder / "a.nc");
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
  Trial trial(folder / "a.nc");
  trial.scene.vessels[0].name = "a b";
  trial.scene.vessels[1].name = "a/b";
  ASSERT_EQ(trial.run().code, ExitCode::done);
  EXPECT_TRUE(file_exists(folder / "a.a_b.svg"));
  EXPECT_TRUE(file_exists(folder / "a.a_b_2.svg"));
}

TEST_F(RunTest, MissingGnuplotCostsThePicturesAlone) {
  Trial trial(folder / "a.nc");
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const TrialOutcome outcome = trial.run();
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(outcome.code, ExitCode::done);
  EXPECT_TRUE(has(outcome.notes, "gnuplot-nox")) << outcome.notes;
  EXPECT_TRUE(file_exists(folder / "a.nc"));
}

}  // namespace
}  // namespace wholehand

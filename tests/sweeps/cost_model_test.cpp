// SPDX-License-Identifier: MIT
#include "sweeps/cost_model.h"

#include <gtest/gtest.h>

#include "tests/support/fake_backend.h"

namespace wholehand {
namespace {

constexpr const char* HERE = "here";

SweepTask task_of(std::uint64_t grips) {
  SweepTask task;
  task.grips = grips;
  task.states = 155;
  task.threads = 2;
  return task;
}

RunTime run_of(const SweepTask& task, const std::string& device, double fixed, double kernels) {
  return {HERE, kind_of(task), device, 0, task.grips, fixed, kernels};
}

std::vector<RunTime> history_of(const std::vector<RunTime>& runs) {
  std::vector<RunTime> history;
  for (const RunTime& run : runs) add_run(history, run);
  return history;
}

struct Both {
  CostEstimate core, device;
};

Both both(const std::vector<RunTime>& history, const SweepTask& task) {
  return {estimate(history, HERE, task, true, guess_core(task)), estimate(history, HERE, task, false, guess_device(task, true))};
}

BackendChoice choice_of(const std::vector<RunTime>& history, const SweepTask& task) {
  const auto [core, device] = both(history, task);
  return choose_backend(task, core, device);
}

TEST(CostModel, TheCheaperOfTwoIsTaken) {
  // the core: 0.1 s and 10 us a grip; the device: 1.1 s and 1 us; as soon as each other at 111,111 grips
  const SweepTask some = task_of(200'000);
  const auto history = history_of({run_of(some, "core", 0.1, 2), run_of(some, "gpu", 1.1, 0.2), run_of(some, "gpu", 1.1, 0.2)});
  for (const std::uint64_t grips : {1ull, 10'000ull, 100'000ull})
    EXPECT_FALSE(choice_of(history, task_of(grips)).on_device) << grips;
  for (const std::uint64_t grips : {120'000ull, 10'000'000ull}) EXPECT_TRUE(choice_of(history, task_of(grips)).on_device) << grips;
  const auto [core, device] = both(history, task_of(1'000'000));
  EXPECT_NEAR(core.seconds(1'000'000), 10.1, 1e-9);
  EXPECT_NEAR(device.seconds(1'000'000), 2.1, 1e-9);
  EXPECT_EQ(device.device, "gpu");
}

TEST(CostModel, CompilationAndOtherWorkDoNotCount) {
  const SweepTask task = task_of(1'000);
  auto history = history_of({run_of(task, "core", 1, 1), run_of(task, "gpu", 1, 9), run_of(task, "gpu", 0.5, 0.1)});
  EXPECT_NEAR(both(history, task).device.seconds(task.grips), 0.6, 1e-9);
  add_run(history, run_of(task, "gpu", 5, 5));
  EXPECT_NEAR(both(history, task).device.seconds(task.grips), 0.6, 1e-9);
}

TEST(CostModel, OnlyTheNewestRunsCount) {
  const SweepTask task = task_of(1'000);
  std::vector<RunTime> history = history_of({run_of(task, "core", 0.1, 0.1)});
  for (int k = 0; k < COUNTED_RUNS - 1; ++k) add_run(history, run_of(task, "core", 3, 3));
  EXPECT_NEAR(both(history, task).core.seconds(task.grips), 0.2, 1e-9);
  add_run(history, run_of(task, "core", 3, 3));
  EXPECT_NEAR(both(history, task).core.seconds(task.grips), 6, 1e-9);
  EXPECT_EQ(history.size(), std::size_t{COUNTED_RUNS});
}

TEST(CostModel, ScenesOfAnotherKindAndOtherMachinesDoNotCount) {
  const SweepTask task = task_of(1'000);
  auto history = history_of({run_of(task, "core", 7, 7)});
  SweepTask other = task;
  other.has_efforts = true;
  EXPECT_EQ(both(history, other).core.runs, 0);
  other = task;
  other.between = 2;
  EXPECT_EQ(both(history, other).core.runs, 0);
  other = task;
  other.states = 300;
  EXPECT_EQ(both(history, other).core.runs, 0);
  other = task;
  other.is_robust = true;
  EXPECT_EQ(both(history, other).core.runs, 0);
  EXPECT_EQ(estimate(history, "there", task, true, guess_core(task)).runs, 0);
  EXPECT_EQ(both(history, task_of(5)).core.runs, 1) << "the number of grips is no kind";
}

TEST(CostModel, TheFirstGuessGivesSmallSweepsToTheCoreAndLargeOnesToAGpu) {
  for (const bool has_efforts : {false, true}) {
    SweepTask task = task_of(100);
    task.has_efforts = has_efforts;
    EXPECT_FALSE(choose_backend(task, guess_core(task), guess_device(task, false)).on_device);
    EXPECT_FALSE(choose_backend(task, guess_core(task), guess_device(task, true)).on_device);
    task.grips = 10'000'000;
    EXPECT_TRUE(choose_backend(task, guess_core(task), guess_device(task, false)).on_device);
  }
}

// A device that nobody tried, or that was slow the one time it compiled, is tried once in RUNS_TO_OLD runs, and only where little is lost.
TEST(CostModel, TheOtherIsTriedRarely) {
  const SweepTask task = task_of(100'000);
  std::vector<RunTime> history;
  int trials = 0;
  constexpr int RUNS = 4 * static_cast<int>(RUNS_TO_OLD);
  for (int k = 0; k < RUNS; ++k) {
    const BackendChoice choice = choice_of(history, task);
    trials += choice.is_trial ? 1 : 0;
    EXPECT_TRUE(choice.is_trial || !choice.on_device);
    add_run(history, choice.on_device ? run_of(task, "llvmpipe", 0.8, 0.8) : run_of(task, "core", 0.1, 1.0));
  }
  EXPECT_GE(trials, 2);
  EXPECT_LE(trials, RUNS / static_cast<int>(RUNS_TO_OLD));

  history = history_of({run_of(task, "llvmpipe", 9, 9), run_of(task, "llvmpipe", 9, 9)});
  for (int k = 0; k < RUNS; ++k) {
    EXPECT_FALSE(choice_of(history, task).on_device) << "nine times as slow: no use to try";
    add_run(history, run_of(task, "core", 0.1, 1.0));
  }
}

TEST(CostModel, ADeviceThatHasBecomeFasterIsFound) {
  const SweepTask task = task_of(100'000);
  auto history = history_of({run_of(task, "gpu", 1, 0.7), run_of(task, "gpu", 1, 0.7)});
  int on_device = 0;
  for (int k = 0; k < 100; ++k) {
    const bool taken = choice_of(history, task).on_device;
    on_device += taken ? 1 : 0;
    add_run(history, taken ? run_of(task, "gpu", 0.2, 0.1) : run_of(task, "core", 0.1, 1.0));
  }
  EXPECT_GT(on_device, 60);
}

// 27 grips of a device that compiled: 8.26 s say what it takes to begin, and nothing of what a grip takes.
TEST(CostModel, AFewGripsDoNotTellWhatManyTake) {
  const SweepTask few = task_of(27), many = task_of(160'000);
  const double guess = guess_device(many, true).per_grip;
  auto history = history_of({run_of(many, "core", 0.1, 1.76), run_of(few, "llvmpipe", 0.7, 8.26)});
  EXPECT_NEAR(both(history, few).device.seconds(few.grips), 8.96, 1e-9) << "so many took so long";
  EXPECT_NEAR(both(history, many).device.seconds(many.grips), 8.96 + (many.grips - few.grips) * guess, 1e-9);

  add_run(history, run_of(few, "llvmpipe", 0.7, 27e-6));
  EXPECT_NEAR(both(history, many).device.seconds(many.grips), 0.7 + many.grips * 1e-6, 1e-9) << "less than the guess is possible";

  add_run(history, run_of(many, "llvmpipe", 0.7, 3.2));
  EXPECT_NEAR(both(history, many).device.seconds(many.grips), 3.9, 1e-9) << "a run of as many grips says more";
}

TEST(CostModel, ADeviceThatCompiledForAFewGripsIsTriedAgain) {
  const SweepTask few = task_of(27), many = task_of(160'000);
  auto history = history_of({run_of(few, "llvmpipe", 0.7, 8.26)});
  for (std::uint64_t k = 0; k < RUNS_TO_OLD; ++k) add_run(history, run_of(many, "core", 0.1, 1.76));
  EXPECT_TRUE(choice_of(history, many).is_trial);
  EXPECT_TRUE(choice_of(history, many).on_device);
  add_run(history, run_of(many, "llvmpipe", 0.7, 1.0));
  EXPECT_TRUE(choice_of(history, many).on_device) << "it takes 1.7 s, and the core 1.86 s";
}

TEST(CostModel, GuessesGrowOnASlowMachine) {
  const SweepTask task = task_of(100'000);
  auto [core, device] = both(history_of({run_of(task, "core", 0.4, 4.4)}), task);  // more than the guess
  const double guessed = device.seconds(task.grips);
  scale_guess(task, core, device);
  EXPECT_NEAR(device.seconds(task.grips), guessed * 4.8 / guess_core(task).seconds(task.grips), 1e-9);
  CostEstimate quick = core, same = guess_device(task, true);
  quick.fixed = quick.per_grip = 0;
  scale_guess(task, quick, same);
  EXPECT_EQ(same.seconds(task.grips), guessed) << "a fast core says nothing of a device";
}

// A driver that has compiled before took 6 s, and 0.5 s (0.3 and 100,000 grips of 4 us on two threads) were expected: a first run that compiles
// is no measure of it.
TEST(CostModel, TheGuessOfTheCoreGrowsWithARunThatDoesNotCompile) {
  const SweepTask task = task_of(100'000);
  auto [core, device] = both(history_of({run_of(task, "llvmpipe", 1, 5)}), task);
  const double guessed = core.seconds(task.grips);
  scale_guess(task, core, device);
  EXPECT_NEAR(core.seconds(task.grips), guessed * 6 / (0.3 + 0.4 / task.threads), 1e-9);
}

TEST(CostModel, AnotherDeviceBeginsAnew) {
  const SweepTask task = task_of(1'000);
  const auto history = history_of({run_of(task, "core", 1, 1), run_of(task, "old", 1, 1), run_of(task, "new", 2, 2)});
  EXPECT_EQ(both(history, task).device.device, "new");
  EXPECT_EQ(both(history, task).device.runs, 1);
  EXPECT_EQ(both(history, task).core.runs, 1);
}

TEST(CostModel, TheLineSaysWhatWasTakenAndWhy) {
  const SweepTask task = task_of(1'000);
  const auto [core, device] = both(history_of({run_of(task, "core", 0.1, 0.2), run_of(task, "llvmpipe", 0.4, 0.2)}), task);
  EXPECT_EQ(choice_line(task, {false, false}, core, device), "chosen: core, 0.3 s expected, and 0.6 s on llvmpipe");
  EXPECT_EQ(choice_line(task, {true, true}, core, device),
            "chosen: llvmpipe, 0.6 s expected, and 0.3 s on core; taken to learn what it takes now");
  EXPECT_EQ(choice_line(task, {false, false}, core, {17, 0, 0, 0, ""}),
            "chosen: core, 0.3 s expected, and 17 s (first guess) on a device");
  EXPECT_EQ(choice_line(task, {false, false}, {2, 0, 0, 0, ""}, device),
            "chosen: core, 2.0 s expected (first guess), and 0.6 s on llvmpipe");
}

TEST(CostModel, TheTaskIsThatOfTheScene) {
  Scene scene = fake_scene();
  const SweepTask task = sweep_task(scene, 5, 3, "float");
  EXPECT_EQ(task.grips, 5u);
  EXPECT_EQ(task.states, 8u);
  EXPECT_FALSE(task.has_efforts);
  EXPECT_NE(kind_of(task), kind_of(sweep_task(scene, 5, 4, "float")));
  EXPECT_NE(kind_of(task), kind_of(sweep_task(scene, 5, 3, "")));
  scene.vessels[0].mesh.emplace();
  EXPECT_TRUE(sweep_task(scene, 5, 3, "float").has_mesh);
}

}  // namespace
}  // namespace wholehand

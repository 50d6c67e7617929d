// SPDX-License-Identifier: MIT
// sanitizers: address
#include "sweeps/auto_backend.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "scene/reader.h"
#include "scene/shipped.h"
#include "sweeps/mark.h"
#include "sweeps/plan.h"
#include "sweeps/run.h"
#include "sweeps/run_times.h"
#include "sweeps/sweep_result.h"
#include "sweeps/variables.h"
#include "system/files.h"
#include "tests/support/environment.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

// Where Mesa keeps what it compiled: not in the folder of the test, so that only the first run of all compiles.
std::string cache_of_mesa() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  return cache ? cache : home ? std::string(home) + "/.cache" : "/tmp";
}

class AutoBackendTest : public testing::Test {
 protected:
  AutoBackendTest() : cache_("XDG_CACHE_HOME", (folder_ / "cache").c_str()) {
    options_.output = folder_ / "out.nc";
    options_.on = ON_AUTO;
    options_.refine = false;
    options_.note = [this](const std::string& line) { notes_ += line + "\n"; };
  }

  std::string file() const { return run_times_file(folder_ / "cache/wholehand"); }

  std::vector<RunTime> kept() const {
    std::string why;
    auto history = read_run_times(file(), why);
    EXPECT_EQ(why, "");
    return history;
  }

  SweepTask task() const { return sweep_task(scene_, Plan(scene_, false).grips() * scene_.vessels.size(), thread_count(0), ""); }

  // As if core and device had taken so long for this scene, each twice.
  void keep(double core, double device) {
    std::vector<RunTime> history;
    for (int k = 0; k < 2; ++k) {
      add_run(history, {machine_name(), kind_of(task()), "core", 0, task().grips, core, 0});
      add_run(history, {machine_name(), kind_of(task()), "a device", 0, task().grips, device, 0});
    }
    ASSERT_TRUE(write_run_times(file(), history));
  }

  void sweep() { ASSERT_EQ(run_sweep(scene_, options_), ExitCode::done) << notes_; }
  std::string backend() const { return SweepResult(options_.output).origin().backend; }

  const TemporaryFolder folder_;
  const ScopedVariable compiled_{"MESA_SHADER_CACHE_DIR", cache_of_mesa().c_str()};
  const ScopedVariable cache_;
  Scene scene_ = read_scene_file(find_scene("small"));
  SweepOptions options_;
  std::string notes_;
};

TEST_F(AutoBackendTest, TheSoonerIsTakenAndItsTimeIsKept) {
  keep(1, 5);
  sweep();
  EXPECT_EQ(backend(), "core");
  ASSERT_EQ(kept().size(), 5u);
  EXPECT_EQ(kept().back().device, "core");
  EXPECT_EQ(kept().back().number, 5u);
  EXPECT_EQ(kept().back().grips, task().grips);

  keep(5, 1);
  options_.output = folder_ / "other.nc";
  sweep();
  EXPECT_EQ(backend(), "vulkan");
  EXPECT_EQ(SweepResult(options_.output).origin().precision, Precision::single);
  EXPECT_NE(kept().back().device, "core");
  EXPECT_NE(kept().back().device, "a device") << "the name of the one that is there";
  EXPECT_EQ(notes_, "");
}

TEST_F(AutoBackendTest, WhatIsAskedForByNameIsTaken) {
  keep(5, 1);
  options_.on = "core";
  sweep();
  EXPECT_EQ(backend(), "core");
  EXPECT_EQ(kept().size(), 5u) << "it counts for later choices";
  AutoBackend named(scene_, options_);
  EXPECT_THROW(named.or_on_core([]() -> int { throw failure_error("gone"); }), Error);
}

TEST_F(AutoBackendTest, ADeviceThatIsNotThereMeansTheCore) {
  const ScopedVariable drivers("VK_DRIVER_FILES", "/nonexistent.json"), older("VK_ICD_FILENAMES", "/nonexistent.json");
  keep(5, 1);
  sweep();
  EXPECT_EQ(backend(), "core");
  EXPECT_EQ(SweepResult(options_.output).origin().precision, Precision::full);
  EXPECT_EQ(notes_.find("on core, since the device does not work: no Vulkan driver"), 0u) << notes_;
  options_.on = "vulkan";
  options_.output = folder_ / "other.nc";
  EXPECT_THROW(run_sweep(scene_, options_), Error);
}

TEST_F(AutoBackendTest, WithoutAnyDeviceTheLineSaysSo) {
  const ScopedVariable drivers("VK_DRIVER_FILES", "/nonexistent.json"), older("VK_ICD_FILENAMES", "/nonexistent.json");
  scene_ = read_scene_file(find_scene("three_beakers"));  // long enough for a device to be thought of
  const AutoBackend chosen(scene_, options_);
  EXPECT_EQ(options_.on, "core");
  EXPECT_EQ(options_.choice.find("chosen: core, since no Vulkan driver"), 0u) << options_.choice;
}

// What is written grows with the grips, as what is computed does.
TEST_F(AutoBackendTest, WritingCountsForEachGrip) {
  keep(1, 5);
  AutoBackend chosen(scene_, options_);
  BackendInfo info;
  info.backend = "core";
  SweepTimes times;
  times.wall = 10;
  times.kernels = 4;
  times.writing = 5;
  chosen.remember(times, task().grips, info);
  EXPECT_DOUBLE_EQ(kept().back().fixed, 1);
  const CostEstimate cost = estimate({&kept().back(), 1}, machine_name(), task(), true, {});
  EXPECT_DOUBLE_EQ(cost.per_grip * static_cast<double>(task().grips), 9);
}

// A driver that came later is found, though another device has times.
TEST_F(AutoBackendTest, AfterManySweepsDevicesAreLookedForAgain) {
  keep(1, 5);
  auto history = kept();
  const RunTime core = history.front();
  for (std::uint64_t k = 1; k < RUNS_TO_OLD; ++k) {
    AutoBackend(scene_, options_);
    EXPECT_NE(options_.choice.find("5.0 s on a device"), std::string::npos) << options_.choice;
    options_.on = ON_AUTO;
    add_run(history, core);
    ASSERT_TRUE(write_run_times(file(), history));
  }
  add_run(history, core);
  ASSERT_TRUE(write_run_times(file(), history));
  AutoBackend(scene_, options_);
  EXPECT_EQ(options_.choice.find("a device"), std::string::npos) << options_.choice;
  EXPECT_NE(options_.choice.find("(first guess)"), std::string::npos) << "of the one that is there: " << options_.choice;

  options_.on = ON_AUTO;
  const ScopedVariable drivers("VK_DRIVER_FILES", "/nonexistent.json"), older("VK_ICD_FILENAMES", "/nonexistent.json");
  AutoBackend(scene_, options_);
  EXPECT_EQ(options_.choice.find("chosen: core, since no Vulkan driver"), 0u) << options_.choice;
}

// A mesh that is refused is no fault of the device.
TEST_F(AutoBackendTest, AMeshThatIsRefusedIsRefusedOnce) {
  scene_.vessels[0].mesh.emplace().file = "absent.stl";
  keep(5, 1);
  try {
    run_sweep(scene_, options_);
    FAIL() << "there is no such mesh";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("absent.stl"), std::string::npos) << error.what();
  }
  EXPECT_EQ(notes_, "");
}

TEST_F(AutoBackendTest, WhatTheCoreRefusesTooIsNoFaultOfTheDevice) {
  keep(5, 1);
  AutoBackend chosen(scene_, options_);
  ASSERT_EQ(options_.on, "vulkan");
  EXPECT_EQ(refusal_line([&] { chosen.or_on_core([&] { throw usage_error(options_.on + " refuses it"); }); }), "core refuses it");
  EXPECT_EQ(notes_, "");

  options_.on = ON_AUTO;
  AutoBackend other(scene_, options_);
  EXPECT_EQ(other.or_on_core([&] { return options_.on == "core" ? 7 : throw usage_error("it is too large"); }), 7);
  EXPECT_EQ(notes_, "on core, since the device does not work: it is too large\n");
}

TEST(AutoBackend, ADeviceWithoutDoublesIsNotChosenForThem) {
  host::DeviceInfo device;
  device.name = "a small GPU";
  EXPECT_EQ(precision_trouble(device, Precision::full), "a small GPU has no double precision");
  EXPECT_EQ(precision_trouble(device, Precision::single), "");
  EXPECT_EQ(precision_trouble(device, std::nullopt), "") << "the usual one is float";
  device.float64 = true;
  EXPECT_EQ(precision_trouble(device, Precision::full), "");
}

TEST_F(AutoBackendTest, AFileThatIsNotAsItWasWrittenIsIgnored) {
  keep(5, 1);
  std::ifstream in(file());
  std::string good{std::istreambuf_iterator<char>(in), {}};
  std::string changed = good;
  changed[changed.size() - 5] ^= 1;
  for (const std::string& text :
       {changed, good.substr(0, good.size() / 2), std::string("[]"), std::string(), std::string(3000, '\0')}) {
    std::ofstream(file()) << text;
    options_.on = ON_AUTO;
    const AutoBackend chosen(scene_, options_);
    EXPECT_EQ(options_.on, "core") << "as without the file";
    EXPECT_NE(chosen.explanation().find("is ignored: it is damaged"), std::string::npos) << chosen.explanation();
  }
  options_.on = ON_AUTO;
  sweep();
  EXPECT_EQ(kept().size(), 1u) << "and written anew";

  std::filesystem::remove(file());
  ASSERT_EQ(mkfifo(file().c_str(), 0600), 0);
  const AutoBackend chosen(scene_, options_);
  EXPECT_NE(chosen.explanation().find("is none of this program's files"), std::string::npos);
  sweep();
  EXPECT_TRUE(std::filesystem::is_fifo(file())) << "it is not ours";
}

TEST_F(AutoBackendTest, WithoutACacheItChoosesAllTheSame) {
  std::ofstream(folder_ / "cache") << "a file where the folder should be";
  sweep();
  EXPECT_EQ(notes_, "");
  const ScopedVariable none("WHOLEHAND_CACHE_MIB", "0");
  const AutoBackend chosen(scene_, options_);
  EXPECT_NE(chosen.explanation().find("are not kept, as there is no cache"), std::string::npos) << chosen.explanation();
}

// Doubles of the core take more room than the floats of the device, with which the sweep was let in.
TEST_F(AutoBackendTest, OnTheCoreInsteadTheRoomIsLookedAtAgain) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  const auto variables = choose_variables(scene);
  const double in_float = bytes_per_grip(variables, scene, 4), in_double = bytes_per_grip(variables, scene, 8);
  const double free = free_bytes(options_.output) / static_cast<double>(scene.vessels.size());
  scene.grips.count = static_cast<std::uint64_t>(free / std::sqrt(in_float * in_double));
  options_.on = "vulkan";
  SweepParts parts;
  bool is_lost = false;
  parts.open_backend = [&](const FieldSet& fields) {
    if (is_lost) options_.on = "core";
    return std::make_unique<FakeBackend>(scene, fields, is_lost ? Precision::full : Precision::single, 64);
  };
  parts.open_evaluator = []() -> std::unique_ptr<Evaluator> { throw failure_error("goes on"); };  // else it would write all that
  const auto sweep_line = [&] { return refusal_line([&] { run_sweep(scene, options_, parts); }, ExitCode::failure); };
  EXPECT_EQ(sweep_line(), "goes on");
  is_lost = true;
  EXPECT_NE(sweep_line().find("there is room for only"), std::string::npos);
}

TEST_F(AutoBackendTest, ABadBoundOfTheCacheIsRefused) {
  const ScopedVariable bound("WHOLEHAND_CACHE_MIB", "many");
  EXPECT_THROW(AutoBackend(scene_, options_), Error);
}

TEST_F(AutoBackendTest, ResumingGoesOnWhereTheSweepBegan) {
  for (const auto& [on, precision] : {std::pair("core", Precision::single), {"vulkan", Precision::full}}) {
    options_.on = on;
    options_.precision = precision;
    sweep();
    const bool is_core = options_.on == "core";
    keep(is_core ? 5 : 1, is_core ? 1 : 5);
    SweepOptions again = options_;
    again.on = ON_AUTO;
    again.precision.reset();
    again.resume = true;
    EXPECT_EQ(run_sweep(scene_, again), ExitCode::done) << "else it refuses another backend";
    const AutoBackend chosen(scene_, again);
    EXPECT_EQ(again.on == "core", is_core);
    EXPECT_EQ(again.precision, precision);
  }
}

TEST_F(AutoBackendTest, AnInterruptedSweepGoesOnWhereItBegan) {
  keep(1, 5);
  const OutputNames names = output_names(options_.output);
  std::ofstream(names.partial) << "not read here";
  SweepMark mark;
  mark.identity = {{"backend", "vulkan"}, {"device", "some device"}, {"precision", "double"}};
  save_mark(names.mark, mark);
  options_.resume = true;
  const AutoBackend chosen(scene_, options_);
  EXPECT_EQ(options_.on, "some device");
  EXPECT_EQ(options_.precision, Precision::full);
}

// Each write is whole, whoever else writes: a run may be lost, and nothing else.
TEST_F(AutoBackendTest, ProgramsAtOnceDoNotSpoilTheFile) {
  std::filesystem::create_directories(folder_ / "cache/wholehand");
  std::vector<pid_t> children;
  for (int child = 0; child < 4; ++child) {
    const pid_t pid = fork();
    if (pid == 0) {
      std::string why;
      for (int k = 0; k < 50 && why.empty(); ++k) {
        auto history = read_run_times(file(), why);
        add_run(history, {machine_name(), fmt::format("kind {} {}", child, k), "core", 0, 1, 1, 1});
        if (!write_run_times(file(), history)) why = "not written";
      }
      _exit(why.empty() ? 0 : 1);
    }
    children.push_back(pid);
  }
  for (const pid_t pid : children) {
    int status = 0;
    waitpid(pid, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_FALSE(kept().empty());
}

}  // namespace
}  // namespace wholehand

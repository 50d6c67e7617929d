// SPDX-License-Identifier: MIT
// sanitizers: address
#include "sweeps/run/auto_backend.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <string>

#include "base/files/files.h"
#include "base/numbers/parallel.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/sweep_result.h"
#include "sweeps/run/run.h"
#include "tests/support/environment.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand::sweeps {
namespace {

constexpr Workload SMALL{10'000, 155}, LARGE{100'000'000, 155, true};

host::DeviceInfo device(const char* name, host::DeviceKind kind, bool has_doubles = true) {
  host::DeviceInfo info;
  info.name = name;
  info.kind = kind;
  info.float64 = has_doubles;
  return info;
}

BackendChoice choose(const Workload& work, const host::DeviceInfo& device, std::optional<Precision> precision = {}) {
  return choose_backend(work, 0, precision, {device});
}

TEST(AutoBackend, AGpuTakesAllButSmallSweeps) {
  const host::DeviceInfo gpu = device("a GPU", host::DeviceKind::discrete);
  EXPECT_EQ(choose(SMALL, gpu).on, "core");
  EXPECT_NE(choose(SMALL, gpu).alternative.find("so little work does not pay for a device (`--on vulkan`)"), std::string::npos);
  const BackendChoice choice = choose(LARGE, gpu);
  EXPECT_EQ(choice.on, "vulkan");
  const double seconds = core_seconds(LARGE, thread_count(0));
  EXPECT_EQ(choice.alternative,
            fmt::format("; the CPU core, double, would take about {} s (`--on core`)", fixed_text(seconds, seconds < 10 ? 1 : 0)));
  EXPECT_NE(choose(LARGE, gpu, Precision::single).alternative.find("the CPU core, float, "), std::string::npos);
}

// In float the driver is faster, in double the core.
TEST(AutoBackend, ACpuDriverTakesWhatItEndsSooner) {
  const host::DeviceInfo driver = device("llvmpipe (LLVM)", host::DeviceKind::cpu);
  bool was_faster = false, was_slower = false;
  for (const Precision precision : {Precision::single, Precision::full})
    for (Workload work{100'000'000, 155, true}; work.grips >= 1000; work.grips = work.grips * 9 / 10) {
      const double core = core_seconds(work, thread_count(0)), other = cpu_driver_seconds(work, thread_count(0), precision);
      const BackendChoice choice = choose(work, driver, precision);
      if (!pays_for_device(work, 0)) {
        EXPECT_EQ(choice.on, "core") << work.grips;
        continue;
      }
      EXPECT_EQ(choice.on, other < core ? "vulkan" : "core") << work.grips;
      (other < core ? was_faster : was_slower) = true;
      if (other < core) continue;
      EXPECT_EQ(choice.alternative.find("; llvmpipe (LLVM), a CPU driver, would take about "), 0u) << choice.alternative;
      EXPECT_NE(choice.alternative.find(" once its kernels are compiled (`--on vulkan`)"), std::string::npos) << choice.alternative;
    }
  EXPECT_TRUE(was_faster && was_slower);
  EXPECT_LT(core_seconds(LARGE, 64), core_seconds(LARGE, 1) / 30) << "more threads take less time";
}

TEST(AutoBackend, WorkGrowsWithStatesAndWhatIsKept) {
  Workload more = LARGE;
  more.has_reserves = true;
  EXPECT_GT(core_seconds(more, 2), core_seconds(LARGE, 2));
  more = LARGE;
  more.states *= 2;
  EXPECT_GT(core_seconds(more, 2), core_seconds(LARGE, 2));
  EXPECT_GT(cpu_driver_seconds(more, 2, Precision::single), cpu_driver_seconds(LARGE, 2, Precision::single));
  EXPECT_GT(cpu_driver_seconds(LARGE, 2, Precision::full), cpu_driver_seconds(LARGE, 2, Precision::single));
  EXPECT_EQ(cpu_driver_seconds(LARGE, 128, Precision::single), cpu_driver_seconds(LARGE, 64, Precision::single))
      << "llvmpipe uses at most 32 threads";
  const Scene scene = read_scene_file(find_scene("three_beakers"));
  const Workload work = workload_of(scene, choose_variables(scene), 27'648);
  EXPECT_EQ(work.states, scene_fills(scene) * scene.tilts.size());
  EXPECT_TRUE(work.has_efforts);
  EXPECT_FALSE(work.has_reserves);
  Scene asked = scene;
  asked.output.also = {"push"};
  EXPECT_TRUE(workload_of(asked, choose_variables(asked), 27'648).has_reserves);
  asked.output.also.clear();
  asked.strength.reset();
  EXPECT_FALSE(workload_of(asked, choose_variables(asked), 27'648).has_efforts);
}

TEST(AutoBackend, ADeviceWithoutDoublesIsNotChosenForThem) {
  const host::DeviceInfo small = device("a small GPU", host::DeviceKind::integrated, false);
  EXPECT_EQ(choose(LARGE, small, Precision::full).on, "core");
  EXPECT_EQ(choose(LARGE, small, Precision::full).alternative, "; a small GPU has no double precision");
  EXPECT_EQ(choose(LARGE, small, Precision::single).on, "vulkan");
  EXPECT_EQ(choose(LARGE, small).on, "vulkan") << "a device computes in float by default";
  EXPECT_EQ(choose(LARGE, device("a GPU", host::DeviceKind::integrated), Precision::full).on, "vulkan");
}

TEST(AutoBackend, ACpuDriverThatWasNeverTimedIsNotChosen) {
  const BackendChoice choice = choose(LARGE, device("SwiftShader", host::DeviceKind::cpu));
  EXPECT_EQ(choice.on, "core");
  EXPECT_EQ(choice.alternative, "; SwiftShader is a CPU driver that was never timed (`--on vulkan`)");
}

class AutoBackendTest : public testing::Test {
 protected:
  AutoBackendTest() {
    options_.output = folder_ / "out.nc";
    options_.on = ON_AUTO;
    options_.refine = false;
    options_.hooks.note = [this](const std::string& line) { notes_ += line + "\n"; };
  }

  // Enough grips that any device pays off.
  static Scene large_scene() {
    Scene scene = read_scene_file(find_scene("three_beakers"));
    scene.grips.sampling = Sampling::sobol;
    scene.grips.count = 1'000'000;
    return scene;
  }

  void sweep() { ASSERT_EQ(run_sweep(scene_, options_), ExitCode::done) << notes_; }
  std::string backend() const { return SweepResult(options_.output).origin().backend; }

  const TemporaryFolder folder_;
  Scene scene_ = read_scene_file(find_scene("small"));
  SweepOptions options_;
  std::string notes_;
};

TEST_F(AutoBackendTest, ASmallSweepRunsOnTheCore) {
  sweep();
  EXPECT_EQ(backend(), "core");
  EXPECT_EQ(SweepResult(options_.output).origin().precision, Precision::full);
  EXPECT_EQ(notes_, "");
}

TEST_F(AutoBackendTest, ALargeOneRunsOnTheDevice) {
  const BackendChoice choice = choose_backend(large_scene(), options_);
  EXPECT_EQ(choice.on, "vulkan");
  EXPECT_NE(choice.alternative.find("(`--on core`)"), std::string::npos) << choice.alternative;
}

TEST_F(AutoBackendTest, WhatIsAskedForByNameIsTaken) {
  options_.on = "core";
  const BackendChoice choice = choose_backend(large_scene(), options_);
  EXPECT_EQ(choice.on, "core");
  EXPECT_EQ(choice.alternative, "");
  EXPECT_THROW(with_core_fallback(choice, options_.hooks, [](const BackendChoice&) { throw failure_error("gone"); }), Error);
}

TEST_F(AutoBackendTest, WithoutAnyDeviceTheCoreIsTakenAndTheReasonSaid) {
  const ScopedVariable drivers("VK_DRIVER_FILES", "/nonexistent.json"), older("VK_ICD_FILENAMES", "/nonexistent.json");
  const BackendChoice choice = choose_backend(large_scene(), options_);
  EXPECT_EQ(choice.on, "core");
  EXPECT_EQ(choice.alternative.find("; no Vulkan driver"), 0u) << choice.alternative;
}

// A mesh that is refused is no fault of the device.
TEST_F(AutoBackendTest, AMeshThatIsRefusedIsRefusedOnce) {
  scene_ = large_scene();
  scene_.vessels[0].mesh.emplace().file = "absent.stl";
  try {
    run_sweep(scene_, options_);
    FAIL() << "there is no such mesh";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("absent.stl"), std::string::npos) << error.what();
  }
  EXPECT_EQ(notes_, "");
}

TEST_F(AutoBackendTest, WhatTheCoreRefusesTooIsNoFaultOfTheDevice) {
  const BackendChoice device = choose_backend(large_scene(), options_);
  ASSERT_EQ(device.on, "vulkan");
  const auto refuse = [](const BackendChoice& choice) { throw usage_error(choice.on + " refuses it"); };
  EXPECT_EQ(refusal_line([&] { with_core_fallback(device, options_.hooks, refuse); }), "core refuses it");
  EXPECT_EQ(notes_, "");

  const BackendChoice core = with_core_fallback(device, options_.hooks, [](const BackendChoice& choice) {
    if (choice.on != "core") throw usage_error("it is too large");
  });
  EXPECT_EQ(core.on, "core");
  EXPECT_EQ(core.precision, Precision::full);
  EXPECT_EQ(notes_, "on core, since the device does not work: it is too large\n");
  EXPECT_EQ(core.alternative, "") << "the note replaces the closing sentence";
}

// Doubles of the core take more room than the floats of the device, with which the sweep was let in.
TEST_F(AutoBackendTest, OnTheCoreInsteadTheRoomIsLookedAtAgain) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  const auto variables = choose_variables(scene);
  const double in_float = bytes_per_grip(variables, scene, 4), in_double = bytes_per_grip(variables, scene, 8);
  const double free = free_bytes(options_.output) / static_cast<double>(scene.vessels.size());
  scene.grips.count = static_cast<std::uint64_t>(free / std::sqrt(in_float * in_double));
  const BackendChoice device{.on = "vulkan", .precision = Precision::single, .fallback_precision = Precision::full};
  SweepParts parts;
  bool is_lost = false;
  parts.open_backend = [&](const BackendChoice& choice, const FieldSet& fields) {
    if (is_lost && choice.on != "core") throw failure_error("device lost");
    return std::make_unique<FakeBackend>(scene, fields, choice.precision, 64);
  };
  parts.open_evaluator = []() -> std::unique_ptr<Evaluator> { throw failure_error("goes on"); };  // else it would write all that
  const auto sweep_line = [&] { return refusal_line([&] { run_sweep(scene, options_, device, parts); }, ExitCode::failure); };
  EXPECT_EQ(sweep_line(), "goes on");
  is_lost = true;
  EXPECT_NE(sweep_line().find("there is room for only"), std::string::npos);
}

TEST_F(AutoBackendTest, ResumingGoesOnWhereTheSweepBegan) {
  for (const auto& [on, precision] : {std::pair("core", Precision::single), {"vulkan", Precision::full}}) {
    options_.on = on;
    options_.precision = precision;
    sweep();
    const bool is_core = options_.on == "core";
    SweepOptions again = options_;
    again.on = ON_AUTO;
    again.precision.reset();
    again.resume = true;
    EXPECT_EQ(run_sweep(scene_, again), ExitCode::done) << "else it refuses another backend";
    const BackendChoice choice = choose_backend(scene_, again);
    EXPECT_EQ(choice.on == "core", is_core);
    EXPECT_EQ(choice.precision, precision);
  }
}

TEST_F(AutoBackendTest, AnInterruptedSweepGoesOnWhereItBegan) {
  const OutputNames names = output_names(options_.output);
  std::ofstream(names.partial) << "not read here";
  SweepMark mark;
  mark.identity = {{"backend", "vulkan"}, {"device", "some device"}, {"precision", "double"}};
  save_mark(names.mark, mark);
  options_.resume = true;
  const BackendChoice choice = choose_backend(scene_, options_);
  EXPECT_EQ(choice.on, "some device");
  EXPECT_EQ(choice.precision, Precision::full);
}

}  // namespace
}  // namespace wholehand::sweeps

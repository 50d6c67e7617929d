// SPDX-License-Identifier: MIT
// Limits of gains against simulated loops.
// sanitizers: none
#include "device/loop/gains.h"

#include <gtest/gtest.h>

#include "base/text/error.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/loop/grip_loop.h"

namespace wholehand::device {
namespace {

constexpr std::array<double, 2> OWN_GAP{12.5e-3, 128e-3};  // a device whose gap is the hand's

TEST(Gains, ShippedScenesAndDefaultsPassAtEveryRate) {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  for (const double rate : {1000.0, 2000.0, 4000.0, 8000.0}) {
    scene.live.rate = rate;
    EXPECT_NO_THROW(refuse_unstable_gains(scene, OWN_GAP, false)) << rate;
  }
  scene.live.rate = 250;  // (b + B) / (T / 2) of both tips is less than 800 N/m there
  EXPECT_THROW(refuse_unstable_gains(scene, OWN_GAP, false), Error);
}

TEST(Gains, BeyondTheirLimitsAreRefusedWithTheRemedy) {
  const GainLimits limits = gain_limits(1000, 2);  // two tips: twice K and B at the arm
  for (const bool is_stiffness : {true, false}) {
    Scene scene;
    double& gain = is_stiffness ? scene.live.stiffness : scene.force.k_open;
    const double limit = is_stiffness ? limits.stiffness / 2 : limits.k_open;
    // the simulated one is no sharp edge: beside it, a user's answer may come in or out of phase
    const double beside = is_stiffness ? 0.001 : 0.1;
    gain = (1 - beside) * limit;
    EXPECT_NO_THROW(refuse_unstable_gains(scene, OWN_GAP, false));
    gain = (1 + beside) * limit;
    try {
      refuse_unstable_gains(scene, OWN_GAP, false);
      ADD_FAILURE() << "a gain beyond its limit";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      const std::string line = error.what();
      EXPECT_NE(line.find(is_stiffness ? "K_N_m" : "k_open_N_m"), std::string::npos) << line;
      EXPECT_NE(line.find("--unsafe-gains"), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos);
    }
    EXPECT_NO_THROW(refuse_unstable_gains(scene, OWN_GAP, true));
  }
}

// Twice the rate bears about twice the stiffness: K_limit = (b + B) / (T / 2) where nothing else delays.
TEST(Gains, LimitsGrowWithTheRate) {
  for (const double rate : {250.0, 1000.0, 2000.0}) {
    // the user's answer takes its share of it at some reactions, and none at others
    EXPECT_NEAR(gain_limits(2 * rate, 1).k_open / gain_limits(rate, 1).k_open, 2, 0.4);
    EXPECT_NEAR(gain_limits(2 * rate, 1).stiffness / gain_limits(rate, 1).stiffness, 2, 0.2);
  }
}

// At the guard's limit no user within its assumptions shakes.
TEST(Gains, NoUsualUserShakesAtTheLimit) {
  const double limit = gain_limits(1000, 1).k_open;
  for (int reaction = 60; reaction <= 90; ++reaction) {
    GripLoop loop;
    loop.finger_mass = 0.004;
    loop.finger_damping = 1;
    loop.finger_stiffness = 200;
    loop.reaction = reaction * 1e-3;
    loop.k_open = 0.9 * limit;
    EXPECT_TRUE(decays(loop)) << reaction;
    EXPECT_LT(limit, sampled_k_open(loop));
  }
}

// Two tips push the arm; a finger's tip goes as many times as far as the finger: a gap of 25 mm that spans a hand's 128 mm is felt
// like 4.6 K.
TEST(Gains, AMappedDeviceFeelsTheStiffnessTimesTheSlope) {
  Scene scene;
  EXPECT_EQ(device_slope(scene, OWN_GAP), 2) << "the arm's";
  scene.device.has_gap = true;
  scene.device.gap = {0, 25e-3};
  const double slope = device_slope(scene, OWN_GAP);
  EXPECT_NEAR(slope, (128 - 12.5) / 25, 0.1) << "128 mm open; pads that touch are two radii apart and less";
  scene.live.damping = 0;
  scene.live.stiffness = 1.01 * gain_limits(scene.live.rate, 0).stiffness / slope;
  EXPECT_THROW(refuse_unstable_gains(scene, OWN_GAP, false), Error);
  scene.device.has_gap = false;
  EXPECT_NO_THROW(refuse_unstable_gains(scene, OWN_GAP, false));
  scene.device.workspace_scale = 3;  // of its arm's way
  EXPECT_EQ(device_slope(scene, OWN_GAP), 6);
  EXPECT_THROW(refuse_unstable_gains(scene, OWN_GAP, false), Error);
}

}  // namespace
}  // namespace wholehand::device

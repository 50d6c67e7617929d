// SPDX-License-Identifier: MIT
// A live session loses no liquid, gives the same forces for the same states, and of a left hand their mirror image.
// sanitizers: address
#include "core/vectors.h"
#include "device/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/evaluator.h"
#include "device/session/workspace.h"
#include "tests/support/live_script.h"
#include "tests/support/recorded_ticks.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand::device {
namespace {

Triple mirrored_x(const Triple& t) { return {-t[0], t[1], t[2]}; }

// ---- liquid ----

TEST(Session, LosesNoLiquid) {
  for (const bool hits : {true, false}) {
    Scene scene = live_scene();
    if (!hits) scene.task->target_place[2] += 1;
    const std::vector<Tick> record = play_session(scene, script_for(scene));
    const double whole = record[0].volume[0];
    EXPECT_NEAR(whole, 0.5 * make_core_evaluator(scene)->capacity(0), 1e-15);
    double flowed = 0;
    for (const Tick& tick : record) {
      ASSERT_LE(liquid_in_sight(tick, 0), whole + 1e-15);
      ASSERT_GE(tick.flow, 0);
      flowed += tick.flow * 1e-3;
      // liquid that left the lip is in the air, arrived or spilled
      ASSERT_NEAR(whole - tick.volume[0], flowed, 1e-12);
      if (tick.tilt == 0 && is_held(tick.state)) {
        EXPECT_EQ(tick.flow, 0);
      }
    }
    EXPECT_NEAR(liquid_in_sight(record.back(), 0), whole, 1e-15);  // seconds after: all has landed
    EXPECT_GT(hits ? record.back().arrived[0] : record.back().spilled[0], 50e-6);
    EXPECT_EQ(hits ? record.back().spilled[0] : record.back().arrived[0], hits ? record.back().spilled[0] : 0);
  }
}

// Held still long enough at a tilt, what is left is what the lip holds back there.
TEST(Session, PoursDownToWhatTheLipHolds) {
  Scene scene = live_scene();
  LiveScript script = script_for(scene);
  script.tilt = radians(75);
  const auto at = [&](std::int64_t n) { return script.at(std::min<std::int64_t>(n, 3900)); };
  const std::vector<Tick> record = play_session(scene, at, 3900 + 5000);  // 33 time constants
  const auto evaluator = make_core_evaluator(scene);
  const LiquidResult left = evaluator->liquid(0, 0.5, record.back().tilt);
  EXPECT_NEAR(record.back().volume[0], left.volume, 1e-13);
  EXPECT_GT(left.poured, 1e-6);
}

// ---- sameness ----

void expect_same_to_the_bit(const Tick& a, const Tick& b) {
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.wanted.arm, b.wanted.arm);
  EXPECT_EQ(a.wanted.grip, b.wanted.grip);
  EXPECT_EQ(a.coupling, b.coupling);
  EXPECT_EQ(a.proxies, b.proxies);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.arrived, b.arrived);
  EXPECT_EQ(a.spilled, b.spilled);
  EXPECT_EQ(a.torque, b.torque);
  EXPECT_EQ(a.vessel_place, b.vessel_place);
}

TEST(Session, TheSameStatesGiveTheSameForcesToTheBit) {
  const Scene scene = live_scene();
  const LiveScript script = script_for(scene);
  const auto next = [](std::int64_t n) { return n + 1 + n % 3; };
  const auto at = [&](std::int64_t n) { return script.at(n); };
  const std::vector<Tick> a = play_session(scene, at, 7000, next), b = play_session(scene, at, 7000, next);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_same_to_the_bit(a[k], b[k]);
}

// Missed ticks do not change which states a session goes through, nor, beyond the length of a tick, how much pours.
TEST(Session, MissedTicksAreOnlyTime) {
  const Scene scene = live_scene();
  const LiveScript script = script_for(scene);
  const auto at = [&](std::int64_t n) { return script.at(n); };
  const std::vector<Tick> all = play_session(scene, at, 7000),
                          some = play_session(scene, at, 7000, [](std::int64_t n) { return n + 1 + n % 4; });
  const auto order = [](const std::vector<Tick>& record) {
    std::vector<SessionState> states;
    for (const Tick& tick : record)
      if (states.empty() || states.back() != tick.state) states.push_back(tick.state);
    return states;
  };
  EXPECT_EQ(order(all), order(some));
  EXPECT_LT(some.size(), 0.6 * static_cast<double>(all.size()));
  // four ticks of 150 ms time constant
  EXPECT_NEAR(some.back().volume[0] / all.back().volume[0], 1, 0.01);
  EXPECT_NEAR(liquid_in_sight(some.back(), 0), some[0].volume[0], 1e-15);
}

// Displays find the effort from the tick: what is felt and recorded is the same to the bit.
TEST(Session, StrengthsChangeNoTick) {
  Scene scene = live_scene();
  const std::vector<Tick> without = play_session(scene, script_for(scene));
  scene.strength = StrengthData{{1, 2, 3, 4, 5, 6}, true, {}};
  expect_same_ticks(play_session(scene, script_for(scene)), without);
}

void expect_mirrored(Scene right) {
  right.vessels.push_back(lopsided());
  right.vessels[2].place = {-0.3, 0, 0};
  Scene left = right;
  left.hand.handedness = Handedness::left;
  for (VesselData& vessel : left.vessels) {
    vessel.place = mirrored_x(vessel.place);
    vessel.center_of_mass = mirrored_x(vessel.center_of_mass);
  }
  left.task->target_place = mirrored_x(left.task->target_place);
  left.task->destination = mirrored_x(left.task->destination);
  for (const std::size_t v : {std::size_t{0}, std::size_t{2}}) {
    LiveScript script = script_for(right);
    script.vessel = right.vessels[v].place;
    script.azimuth = 0.4;
    const auto at_left = [&](std::int64_t n) {
      GripperState state = script.at(n);
      state.position = mirrored_x(state.position);
      // M R M: what has one index x changes sign
      for (const int k : {1, 2, 3, 6}) state.rotation[static_cast<std::size_t>(k)] = -state.rotation[static_cast<std::size_t>(k)];
      return state;
    };
    const std::vector<Tick> a = play_session(
                                right, [&](std::int64_t n) { return script.at(n); }, 7000),
                            b = play_session(left, at_left, 7000);
    int held = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].state, b[k].state);
      // 1e-12: the same to rounding
      EXPECT_LT(glm::length(to_vec3(a[k].wanted.arm) - to_vec3(mirrored_x(b[k].wanted.arm))), 1e-12);
      EXPECT_NEAR(a[k].wanted.grip, b[k].wanted.grip, 1e-12);
      // half of index less thumb in a mirror, of the tip at +x less the other one in the device: the thumb of a left hand
      EXPECT_LT(glm::length(to_vec3(a[k].wanted.across) + to_vec3(mirrored_x(b[k].wanted.across))), 1e-12);
      EXPECT_LT(glm::length(to_vec3(a[k].tips[1]) - to_vec3(mirrored_x(b[k].tips[1]))), 1e-12);
      EXPECT_LT(glm::length(to_vec3(a[k].proxies[0]) - to_vec3(mirrored_x(b[k].proxies[0]))), 1e-12);
      EXPECT_LT(glm::length(to_vec3(a[k].vessel_place) - to_vec3(mirrored_x(b[k].vessel_place))), 1e-12);
      EXPECT_NEAR(a[k].torque, b[k].torque, 1e-12);
      EXPECT_EQ(a[k].touch_mask, b[k].touch_mask);
      EXPECT_NEAR(a[k].slip_distance, b[k].slip_distance, 1e-12);
      EXPECT_NEAR(a[k].slip_angle, b[k].slip_angle, 1e-12);
      EXPECT_NEAR(a[k].volume[0], b[k].volume[0], 1e-15);
      EXPECT_NEAR(a[k].arrived[0], b[k].arrived[0], 1e-15);
      held += is_held(a[k].state);
    }
    EXPECT_GT(held, 1000);
  }
}

TEST(Session, ALeftHandIsMirrored) { expect_mirrored(live_scene()); }

TEST(Session, ALeftHandIsMirroredWhereVesselsSlide) {
  Scene scene = live_scene();
  scene.live.slide = true;
  scene.force.base = 3;
  scene.force.max = 12;
  expect_mirrored(scene);
}

}  // namespace
}  // namespace wholehand::device

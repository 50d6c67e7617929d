// SPDX-License-Identifier: MIT
// The states of a live session: held and tilted from the first tick on to which it is true; the clutch and the task.
// sanitizers: address
#include "device/session/session.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text/error.h"
#include "device/session/workspace.h"
#include "tests/support/live_script.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand::device {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

// ---- states ----

TEST(Session, GoesThroughTheStatesOfTheExperiment) {
  const Scene scene = live_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  std::vector<SessionState> order;
  for (const Tick& tick : record)
    if (order.empty() || order.back() != tick.state) order.push_back(tick.state);
  using S = SessionState;
  const std::vector<S> expected{S::free, S::touching, S::lift, S::tilt, S::maintain, S::tilt, S::slipped, S::free};
  EXPECT_EQ(order, expected);
  EXPECT_EQ(record.back().grasps, 1);
  EXPECT_EQ(record.back().lost, 1);  // let go 15 cm above where it stood
}

// The first tick with both tips within the contact tolerance, and not one before.
TEST(Session, HoldsFromWhenBothTipsTouch) {
  const Scene scene = live_scene();
  const core_f64::Vessel vessel = ready_vessel(scene.vessels[0]);
  const core_f64::Hand hand = ready_hand(scene.hand);
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  for (std::size_t k = 0; k < record.size(); ++k) {
    const Tick& tick = record[k];
    const double thumb =
        core_f64::separation_at(vessel, to_vec3(tick.tips[0]) - to_vec3(scene.vessels[0].place), hand.radius[0][3]);
    const double index =
        core_f64::separation_at(vessel, to_vec3(tick.tips[1]) - to_vec3(scene.vessels[0].place), hand.radius[1][4]);
    const bool both = thumb <= hand.contact_tolerance && index <= hand.contact_tolerance;
    EXPECT_EQ(is_held(tick.state), both) << k;
    if (both) break;
    EXPECT_EQ(tick.state == SessionState::touching, std::min(thumb, index) <= hand.contact_tolerance) << k;
  }
}

// While it is held the vessel keeps its place and turn in the gripper's axes, from where it stood.
TEST(Session, TheVesselMovesWithTheHand) {
  const Scene scene = live_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const Tick* first = nullptr;
  for (const Tick& tick : record) {
    if (!is_held(tick.state)) continue;
    if (!first) {
      first = &tick;
      EXPECT_LT(glm::length(to_vec3(tick.vessel_place) - to_vec3(scene.vessels[0].place)), 1e-15);
      EXPECT_LT(tick.tilt, 1e-15);
    }
    const Mat3 then = to_mat3(first->hand_rotation), now = to_mat3(tick.hand_rotation);
    const Vec3 place =
        to_vec3(tick.middle) + now * (glm::transpose(then) * (to_vec3(first->vessel_place) - to_vec3(first->middle)));
    EXPECT_LT(glm::length(to_vec3(tick.vessel_place) - place), 1e-15);
    const Mat3 turn = now * glm::transpose(then);
    for (int k = 0; k < 3; ++k) EXPECT_LT(glm::length(to_mat3(tick.vessel_rotation)[k] - turn[k]), 1e-14);
    // the tilt is the angle between its axis and up; acos is good to 1e-8 at its ends
    EXPECT_NEAR(tick.tilt, std::acos(std::clamp(tick.vessel_rotation[4], -1.0, 1.0)), 3e-8);
    EXPECT_EQ(tick.grasp_height, first->grasp_height);
  }
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->grasp_height, 55e-3, 1e-9);
  EXPECT_NE(first->touch_mask & (1u << 3), 0u);  // the thumb's tip and
  EXPECT_NE(first->touch_mask & (1u << 8), 0u);  // the index's
}

// Turning by 5 degrees or more within half a second is tilt; then, within half a second of standing still, maintain, or lift where
// it is upright.
TEST(Session, ATiltThatStandsStillIsMaintained) {
  Scene scene = live_scene();
  const LiveScript script = script_for(scene);
  for (const double angle : {4.5, 5.5, 30.0}) {
    const auto at = [&](std::int64_t n) {
      GripperState state = script.at(std::min<std::int64_t>(n, 2250));  // lifted
      const double share = std::clamp((static_cast<double>(n) - 2300) / 300, 0.0, 1.0);
      state.rotation = turned('x', -share * radians(angle));
      return state;
    };
    const std::vector<Tick> record = play_session(scene, at, 4000);
    bool tilted = false;
    for (const Tick& tick : record) tilted = tilted || tick.state == SessionState::tilt;
    EXPECT_EQ(tilted, angle > 5) << angle;
    EXPECT_EQ(record[2299].state, SessionState::lift);
    EXPECT_EQ(record.back().state, angle > 5 ? SessionState::maintain : SessionState::lift) << angle;
    // at the latest two windows after it came to rest
    EXPECT_NE(record[2601 + 1000].state, SessionState::tilt);
  }
}

// However slow: what has changed by 5 degrees since it stood still is tilting.
TEST(Session, ASlowTiltIsATilt) {
  Scene scene = live_scene();
  const LiveScript script = script_for(scene);
  const auto at = [&](std::int64_t n) {
    GripperState state = script.at(std::min<std::int64_t>(n, 2250));
    state.rotation =
        turned('x', -radians(4) * std::clamp((static_cast<double>(n) - 2300) / 1000, 0.0, 10.0));  // 4 degrees a second
    return state;
  };
  for (const Tick& tick : play_session(scene, at, 2300 + 12000)) {
    if (tick.number > 2300 + 1300 && tick.number < 2300 + 10000) {
      ASSERT_EQ(tick.state, SessionState::tilt) << tick.number;
    } else if (tick.number > 2300 + 11000) {
      ASSERT_EQ(tick.state, SessionState::maintain) << tick.number;
    }
  }
}

// ---- clutch and task ----

TEST(Session, TheClutchTakesTheForceAway) {
  Scene scene = scene_of({beaker1()});
  scene.device.clutch_button = 0;
  const auto at = [](std::int64_t n) {
    GripperState state = gripper_at(Vec3(0.102 - 1e-4 * std::min<double>(static_cast<double>(n), 70), 0.05, 0), 0.1);
    if (n >= 100 && n < 200) {
      state.buttons = 1;
      state.position[0] -= 1e-4 * static_cast<double>(n - 99);  // on through the glass, were it not for the clutch
    }
    if (n >= 200) state.position[0] -= 1e-2;
    return state;
  };
  const std::vector<Tick> record = play_session(scene, at, 300);
  EXPECT_GT(record[99].wanted.arm[0], 1);
  for (std::size_t n = 100; n < 200; ++n) {
    EXPECT_EQ(record[n].wanted.arm, Triple{});
    EXPECT_NEAR(record[n].middle[0], record[100].middle[0], 1e-15);
  }
  EXPECT_GT(record[250].wanted.arm[0], 1);  // and goes on from there
  EXPECT_NEAR(record[250].middle[0], record[100].middle[0], 1e-12);
}

TEST(Session, CountsWhatTheTaskAsks) {
  Scene scene = live_scene();
  scene.vessels[0].guidance = {{50e-3, 0}, {60e-3, 0}};
  // all that pours, and the empty vessel carried to its destination would be the rest
  const std::vector<Tick> first = play_session(scene, script_for(scene));
  scene.task->amounts[0].second = first.back().arrived[0];
  scene.task->tolerance = 1e-6;
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  EXPECT_EQ(record[0].guidance, 0);
  EXPECT_EQ(record.back().guidance, 1);  // the liquid is there, the tutorial is not done
  EXPECT_FALSE(record.back().task_done);
  // grasped at 55 mm, 5 mm above the guidance point that was shown, on the index's side
  for (const Tick& tick : record)
    if (is_held(tick.state)) {
      // the tip may be up to the contact tolerance of 0.2 mm off the glass: 4 um of the hypotenuse
      EXPECT_NEAR(tick.guidance_distance, 5e-3, 5e-6);
      break;
    }
  // carry the dry vessel there
  LiveScript script;
  script.vessel = scene.vessels[1].place;
  const Vec3 way = to_vec3(scene.task->destination) - to_vec3(scene.vessels[1].place);
  const auto at = [&](std::int64_t n) {
    GripperState state = script.at(std::min<std::int64_t>(n, 2250));
    if (n < 2250) state.gap = std::max(0.06, 0.127 - 5e-5 * static_cast<double>(n));
    if (n < 2250) state.position[0] = scene.vessels[1].place[0];
    if (n >= 2250) state.gap = 0.127 - 5e-5 * 1339;
    const double share = std::clamp((static_cast<double>(n) - 2300) / 1000, 0.0, 1.0);
    for (std::size_t k = 0; k < 3; ++k) state.position[k] += share * (way[static_cast<int>(k)] - (k == 1 ? 0.15 : 0));
    return state;
  };
  const std::vector<Tick> carried = play_session(scene, at, 3500);
  EXPECT_EQ(carried[2290].vessel, 1);
  EXPECT_EQ(carried.back().destinations, 1);
}

// ---- the hand ----

// The rotation of a gripper whose first axis is the line through the tips and whose second is against the little finger's side.
TEST(PlaceLiveHand, IsTheSweepsHand) {
  Random random(12);
  for (const HandData& data : {paper_hand(), odd_hand(), large_hand()}) {
    const core_f64::Hand hand = ready_hand(data);
    for (int k = 0; k < 100; ++k) {
      const double azimuth = random.uniform(-PI, PI), obliquity = random.uniform(-1, 1), roll = random.uniform(-PI, PI);
      const Vec3 d = core_f64::grip_direction(azimuth, obliquity);
      const Vec3 down = glm::normalize(Vec3(0, -1, 0) + d.y * d), side = glm::cross(d, down);
      const Vec3 f2 = std::cos(roll) * down + std::sin(roll) * side;
      const Mat3 gripper(d, -f2, -glm::cross(d, f2));
      const Vec3 middle(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const double closure = random.uniform(0, 1), scale = random.uniform(0.5, 2);
      double a = 0, b = 0;
      const core_f64::Placement live = place_live_hand(hand, closure, gripper, middle, scale, a);
      const core_f64::Placement swept = core_f64::place_hand(hand, closure, d, roll, middle, scale, b);
      EXPECT_NEAR(a, b, 1e-15);
      EXPECT_LT(glm::length(live.translation - swept.translation), 1e-14);
      for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(live.rotation[c] - swept.rotation[c]), 1e-14);
      EXPECT_EQ(live.scale, swept.scale);
    }
  }
}

// ---- refusals ----

TEST(LiveScene, AGuidancePointOfAHollowMeshIsOnItsNearWall) {
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 400), line_to(37, 400), line_to(37, 3), line_to(0, 3)};
  VesselData cup = vessel_of_mesh("cup", turned_mesh(shell, 128, 2e-3), 1e-3);
  for (int degree = 0; degree < 360; degree += 20) cup.guidance.push_back({0.2, radians(degree)});
  const LiveScene live(scene_of({cup}));
  for (const Vec3& place : live.vessels[0].guidance) EXPECT_NEAR(std::hypot(place.x, place.z), 0.04, 2e-5);  // chords and cells
}

TEST(LiveScene, RefusesWhatCannotBeLive) {
  EXPECT_THROW(LiveScene(scene_of({})), Error);
  EXPECT_THROW(LiveScene(scene_of(std::vector<VesselData>(LIVE_VESSELS + 1, beaker1()))), Error);
  Scene many = scene_of(std::vector<VesselData>(LIVE_VESSELS, beaker1()));
  EXPECT_THROW(LiveScene{many}, Error) << "they stand in each other";
  for (std::size_t v = 0; v < many.vessels.size(); ++v) many.vessels[v].place = {0.1 * static_cast<double>(v), 0, 0};
  EXPECT_NO_THROW(LiveScene{many});
  Scene mesh = scene_of({beaker1()});
  mesh.vessels[0].mesh = MeshData{};
  EXPECT_THROW(LiveScene{mesh}, Error) << "it is not read";
  Scene leaky = scene_of({ledges()});
  leaky.liquid = LiquidData{};
  leaky.liquid->fills = {1};
  leaky.vessels[0].liquid_name = "water";
  leaky.vessels[0].liquid_fill = 0.5;
  EXPECT_THROW(LiveScene{leaky}, Error);
  EXPECT_THROW(Session(scene_of({beaker1()}), {0.1, 0.1}), Error);
}

}  // namespace
}  // namespace wholehand::device

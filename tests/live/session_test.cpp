// SPDX-License-Identifier: MIT
// A live session as a whole: its states, the forces before and after the grasp against closed forms and against a sweep, what pours, and that
// the same states give the same forces.
// sanitizers: address
#include "live/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/evaluator.h"
#include "core/trig.h"
#include "live/workspace.h"
#include "tests/support/live_script.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

constexpr double G = 9.80665;

Triple mirrored_x(const Triple& t) { return {-t[0], t[1], t[2]}; }

// All ticks of a way through a scene: the state of each by a function.
std::vector<Tick> play(
    const Scene& scene, const std::function<GripperState(std::int64_t)>& at, std::int64_t ticks,
    const std::function<std::int64_t(std::int64_t)>& next = [](std::int64_t n) { return n + 1; }) {
  Session session(scene, own_gap(scene.hand));
  std::vector<Tick> record;
  Tick tick;
  for (std::int64_t n = 0; n < ticks; n = next(n)) {
    session.step(at(n), n, tick);
    record.push_back(tick);
  }
  return record;
}

LiveScript script_for(const Scene& scene) {
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  return script;
}

std::vector<Tick> play(const Scene& scene, const LiveScript& script) {
  return play(
      scene, [&](std::int64_t n) { return script.at(n); }, static_cast<std::int64_t>(script.seconds() * script.rate));
}

double in_sight(const Tick& tick, int v) {
  const auto k = static_cast<std::size_t>(v);
  return tick.volume[k] + tick.arrived[k] + tick.spilt[k];
}

// Straight above the hand's own frame: the gripper at NO_ROTATION.
GripperState held_at(Vec3 middle, double gap) {
  GripperState state;
  state.position = to_triple(middle);
  state.gap = gap;
  return state;
}

// ---- states ----

TEST(Session, GoesThroughTheStatesOfTheExperiment) {
  const Scene scene = live_scene();
  const std::vector<Tick> record = play(scene, script_for(scene));
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
  const std::vector<Tick> record = play(scene, script_for(scene));
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
  const std::vector<Tick> record = play(scene, script_for(scene));
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

// Turning by 5 degrees or more within half a second is tilt; then, within half a second of standing still, maintain, or lift where it is upright.
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
    const std::vector<Tick> record = play(scene, at, 4000);
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
  for (const Tick& tick : play(scene, at, 2300 + 12000)) {
    if (tick.number > 2300 + 1300 && tick.number < 2300 + 10000) {
      ASSERT_EQ(tick.state, SessionState::tilt) << tick.number;
    } else if (tick.number > 2300 + 11000) {
      ASSERT_EQ(tick.state, SessionState::maintain) << tick.number;
    }
  }
}

// ---- slipping ----

// A hand that holds goes through other vessels. Where it lets go inside of one, that one is felt when the hand has left it, and not before.
TEST(Session, LettingGoWithinAnotherVesselPushesNobody) {
  Scene scene = scene_of({beaker1(), beaker1()});
  scene.vessels[1].name = "other";
  scene.vessels[1].place = {0.3, 0, 0};
  const auto range = own_gap(scene.hand);
  const auto at = [&](std::int64_t n) {
    // closes on the first, goes to where the index finger is in the second, opens, and goes away towards the person
    const double t = static_cast<double>(n) * 1e-3, out = range[1] - (range[1] - 0.09) * std::clamp(t / 0.3, 0.0, 1.0);
    const double x = 0.22 * std::clamp((t - 0.5) / 0.5, 0.0, 1.0), z = 0.5 * std::max(0.0, t - 1.3);
    const double gap = t < 1.05 ? out : std::min(range[1], 0.09 + 0.2 * (t - 1.05));
    return held_at(Vec3(x, 0.055, z), gap);
  };
  bool was_held = false, slipped = false;
  for (const Tick& tick : play(scene, at, 2000)) {
    was_held = was_held || is_held(tick.state);
    slipped = slipped || tick.state == SessionState::slipped;
    if (was_held && !is_held(tick.state)) {
      for (int k = 0; k < 2; ++k) ASSERT_LT(glm::length(to_vec3(tick.coupling[k])), 1e-9) << tick.number;
    }
  }
  EXPECT_TRUE(was_held);
  EXPECT_TRUE(slipped);
}

// Kernel 3's too_wide: tips that touch at more than the hand can open hold nothing.
TEST(Session, WhatIsTooWideIsNotHeld) {
  const auto range = own_gap(HandData{});
  Scene scene = scene_of({cylinder("wide", 1e3 * (range[1] - 15e-3) + 0.3, 110, 1.5)});
  bool touches = false;
  const auto at = [&](std::int64_t n) {
    // wide open, towards it from the person's side: at last both tips are within the contact tolerance
    return held_at(Vec3(0, 0.05, std::max(0.0, 0.2 - 1e-3 * static_cast<double>(n))), range[1]);
  };
  for (const Tick& tick : play(scene, at, 600)) {
    ASSERT_FALSE(is_held(tick.state)) << tick.number;
    touches = touches || tick.state == SessionState::touching;
  }
  EXPECT_TRUE(touches);
}

TEST(Session, SlipsWhenTheOpeningLeavesItsBand) {
  Scene scene = live_scene();
  scene.live.slip = 6e-3;
  const LiveScript script = script_for(scene);
  // held at 2300, then opened by a tenth of a millimetre a tick
  const auto at = [&](std::int64_t n) {
    GripperState state = script.at(std::min<std::int64_t>(n, 2300));
    state.gap += 1e-4 * static_cast<double>(std::clamp<std::int64_t>(n - 2300, 0, 200));
    if (n > 3500) state.position[0] += std::min(0.3, 1e-3 * static_cast<double>(n - 3500));
    return state;
  };
  const std::vector<Tick> record = play(scene, at, 4000);
  const auto grasp = std::find_if(record.begin(), record.end(), [](const Tick& tick) { return is_held(tick.state); });
  const double grasped = at(grasp->number).gap;
  for (const Tick& tick : record) {
    if (tick.number < grasp->number) continue;
    const bool is_within = at(tick.number).gap - grasped <= 6e-3;
    if (is_within) {
      EXPECT_TRUE(is_held(tick.state)) << tick.number;
      continue;
    }
    // let go: no force, and it goes back
    EXPECT_EQ(tick.wanted.grip, 0);
    EXPECT_EQ(tick.wanted.arm, Triple{});
    EXPECT_EQ(tick.state, SessionState::slipped);
    // and stands there after RETURN_TIME
    const std::int64_t slipped = tick.number;
    const Tick& back = record[static_cast<std::size_t>(slipped + std::lround(1000 * RETURN_TIME))];
    EXPECT_LT(glm::length(to_vec3(back.vessel_place) - to_vec3(scene.vessels[0].place)), 1e-9);
    EXPECT_LT(back.tilt, 1e-9);
    // on the way there without a leap: at most the minimum jerk's largest speed, 15/8 of the mean
    const double way = glm::length(to_vec3(tick.vessel_place) - to_vec3(scene.vessels[0].place));
    for (std::int64_t n = slipped; n < slipped + 600; ++n) {
      const double step = glm::length(to_vec3(record[static_cast<std::size_t>(n + 1)].vessel_place) -
                                      to_vec3(record[static_cast<std::size_t>(n)].vessel_place));
      if (record[static_cast<std::size_t>(n + 1)].state != SessionState::slipped) break;
      EXPECT_LE(step, 1.01 * 15.0 / 8 * way / (1000 * RETURN_TIME)) << n;
    }
    break;
  }
  EXPECT_EQ(record.back().state, SessionState::free);
  EXPECT_EQ(record.back().lost, 1);
}

// Where the fingers still stand in its place, it is not felt and not grasped until they have left it.
TEST(Session, AVesselThatCameBackWaitsForTheFingersToLeave) {
  Scene scene = live_scene();
  scene.live.slip = 0.5e-3;
  const LiveScript script = script_for(scene);
  // carried aside by 12 mm and let go: the thumb then stands in its place, until the fingers open
  const double grasped = [&] {
    for (const Tick& tick : play(scene, script))
      if (is_held(tick.state)) return script.at(tick.number).gap;
    return 0.0;
  }();
  const auto at = [&](std::int64_t n) {
    GripperState state = script.at(std::min<std::int64_t>(n, 1450));
    state.position[0] += 12e-3 * std::clamp((static_cast<double>(n) - 1455) / 1000, 0.0, 1.0);
    if (n > 2460) state.gap = grasped + 1e-3;
    if (n > 4000) state.gap = 0.125;
    return state;
  };
  const std::vector<Tick> record = play(scene, at, 4200);
  EXPECT_TRUE(is_held(record[2455].state));
  for (std::int64_t n = 2461; n <= 4000; ++n) {
    ASSERT_EQ(record[static_cast<std::size_t>(n)].state, SessionState::slipped) << n;
    ASSERT_EQ(record[static_cast<std::size_t>(n)].wanted.grip, 0);
  }
  EXPECT_EQ(record.back().state, SessionState::free);
  EXPECT_EQ(record.back().grasps, 1);
  EXPECT_EQ(record.back().lost, 0);  // put down, not lost
}

TEST(Session, SlipsWhenTheFingersOpen) {
  Scene scene = live_scene();
  scene.live.slip = 1;
  const LiveScript script = script_for(scene);
  const std::array<double, 2> range = own_gap(scene.hand);
  const double open = range[1] - OPEN_MARGIN * (range[1] - range[0]);
  const auto at = [&](std::int64_t n) {
    GripperState state = script.at(std::min<std::int64_t>(n, 2300));
    state.gap = std::min(range[1], state.gap + 1e-4 * static_cast<double>(std::max<std::int64_t>(n - 2300, 0)));
    return state;
  };
  for (const Tick& tick : play(scene, at, 2800))
    if (tick.number > 1400) {
      EXPECT_EQ(is_held(tick.state), at(tick.number).gap < open) << tick.number;
    }
}

// A vessel as wide as the hand opens: it is held within the last hundredth of the gap, whose noise is no opening.
TEST(Session, NoiseOpensNoFingers) {
  const auto range = own_gap(HandData{});
  Scene scene = scene_of({cylinder("wide", 1e3 * (range[1] - 15e-3) - 1, 110, 1.5)});
  const auto at = [&](std::int64_t n) {
    return held_at(Vec3(-0.5e-3, 0.05, 0), range[1] - (n < 100 ? 0 : 1e-3) +
                                               (n > 200 && n < 800 ? 2e-5 * static_cast<double>(n % 3) : 0) + (n > 900 ? 1e-3 : 0));
  };
  const std::vector<Tick> record = play(scene, at, 1000);
  for (std::size_t n = 150; n < 900; ++n) ASSERT_TRUE(is_held(record[n].state)) << n;
  EXPECT_EQ(record[950].state, SessionState::slipped);
}

// ---- forces before the grasp ----

// The thumb, 8 mm of radius, pressed in by a depth from the side: K times the depth outwards, less B times the speed; nothing on the other tip.
TEST(Session, TheCouplingIsThatOfAWall) {
  Scene scene = scene_of({beaker1()});
  scene.force.friction = 0;
  const Vec3 place(0.1, 0.02, 0.05);
  scene.vessels[0].place = to_triple(place);
  const double gap = 0.1, speed = 0.02;
  const auto at = [&](std::int64_t n) {
    // the thumb, on the gripper's -x side, comes from the right
    const double thumb = 0.050 - speed * 1e-3 * static_cast<double>(n);
    return held_at(place + Vec3(thumb + gap / 2, 0.05, 0), gap);
  };
  int pressed = 0;
  for (const Tick& tick : play(scene, at, 300)) {
    const double depth = 0.048 - (0.050 - speed * 1e-3 * static_cast<double>(tick.number));
    if (depth < 1e-6) {
      if (depth < -1e-6) {
        EXPECT_EQ(tick.wanted.arm, Triple{});
      }
      continue;
    }
    ++pressed;
    const double force = scene.live.stiffness * depth + scene.live.damping * speed;
    // 1e-5 N: what 1e-8 m of a proxy's place is
    EXPECT_NEAR(tick.coupling[0][0], force, 1e-5);
    EXPECT_NEAR(tick.coupling[0][1], 0, 1e-5);
    EXPECT_NEAR(tick.coupling[0][2], 0, 1e-5);
    EXPECT_EQ(tick.coupling[1], Triple{});
    EXPECT_NEAR(tick.wanted.arm[0], force, 1e-5);
    // it opens what closes: half of the difference along the gripper's axis
    EXPECT_NEAR(tick.wanted.grip, -force / 2, 1e-5);
    EXPECT_EQ(tick.state, SessionState::touching);
    EXPECT_EQ(tick.vessel, 0);
  }
  EXPECT_GT(pressed, 150);
}

TEST(Session, APressThatGoesBackNeverPulls) {
  const Scene scene = [] {
    Scene s = scene_of({beaker1()});
    s.live.damping = 20;
    s.force.friction = 0;
    return s;
  }();
  for (const Tick& tick : play(
           scene,
           [](std::int64_t n) {
             // in and out again at 0.1 m/s
             return held_at(Vec3(0.053 - 1e-4 * std::min<double>(static_cast<double>(n), 70) +
                                     1e-4 * std::max(0.0, static_cast<double>(n) - 70) + 0.05,
                                 0.05, 0),
                            0.1);
           },
           200)) {
    EXPECT_GE(tick.coupling[0][0], -1e-12);
  }
}

// A shell, bare points: a tip that closes at 1 m/s and is through the wall before the next tick still stands outside, and is still felt; and the
// grasp comes about.
TEST(Session, AThinWallHoldsAFastFinger) {
  for (const double rate : {1000.0, 3000.0}) {
    HandData hand;
    for (FingerData& finger : hand.fingers) finger.radii = {};
    Scene scene = scene_of({shell_of(beaker1())}, Pose::rigged, hand);
    scene.live.rate = rate;
    const auto range = own_gap(hand);
    const auto at = [&](std::int64_t n) {
      return held_at(Vec3(4e-3, 0.06, 0), std::max(0.066, range[1] - 2 * static_cast<double>(n) / rate));  // each tip 1 m/s
    };
    bool touched = false, held = false;
    for (const Tick& tick : play(scene, at, 100)) {
      for (const Triple& proxy : tick.proxies) EXPECT_GE(std::hypot(proxy[0], proxy[2]), 40e-3 - 1e-8);
      touched = touched || tick.state == SessionState::touching;
      held = held || is_held(tick.state);
    }
    EXPECT_TRUE(touched);
    EXPECT_TRUE(held);
  }
}

// A vessel in which a tip stands at the start is not felt until both have left it.
TEST(Session, StartsWithoutAForce) {
  Scene scene = scene_of({beaker1()});
  const auto at = [](std::int64_t n) {
    return held_at(
        Vec3(0.02 + 1e-4 * std::min<double>(static_cast<double>(n), 1300) - 1e-4 * std::max(0.0, static_cast<double>(n) - 1300),
             0.05, 0),
        0.1);
  };
  const std::vector<Tick> record = play(scene, at, 2000);
  for (std::int64_t n = 0; n < 1300; ++n) EXPECT_EQ(record[static_cast<std::size_t>(n)].wanted.arm, Triple{}) << n;
  EXPECT_GT(record.back().wanted.arm[0], 1);
}

// ---- forces after it ----

// What a sweep says of the same grip, liquid and tilt.
TEST(Session, FeelsExactlyWhatTheSweepSays) {
  int compared = 0;
  for (std::size_t v = 0; v < 3; ++v) {
    for (const Torque torque : {Torque::paper, Torque::exact}) {
      for (const double azimuth : {0.0, 2.1}) {
        for (const double fill : {0.0, 0.3}) {
          Scene scene = three_beakers();
          scene.force.torque = torque;
          scene.vessels = {scene.vessels[v]};
          if (fill > 0) {
            scene.vessels[0].liquid_name = "water";
            scene.vessels[0].liquid_fill = fill;
          }
          scene.vessels[0].place = {0.03, 0.01, -0.02};
          const auto evaluator = make_core_evaluator(scene);
          const double floor = ready_vessel(scene.vessels[0]).floor_height;
          LiveScript script = script_for(scene);
          script.azimuth = azimuth;
          script.height = 0.45 * scene.vessels[0].height;
          script.tilt = fill > 0 ? radians(35) : radians(140);
          // flask and cone are of other widths than the script's cylinder: it closes until they are held
          double grasped = 0;
          const auto at = [&](std::int64_t n) {
            GripperState state = script.at(n);
            if (n < 1500) {
              state.gap = 0.127 - 5e-5 * static_cast<double>(n);
              state.position = scene.vessels[0].place;
              state.position[1] += script.height;
            }
            if (grasped > 0) state.gap = grasped - 1e-3;  // squeezed by a millimetre
            return state;
          };
          Session session(scene, own_gap(scene.hand));
          Tick tick;
          GripInput grip;
          GripResult result;
          for (std::int64_t n = 0; n < 5400; ++n) {
            const GripperState now = at(n);
            session.step(now, n, tick);
            if (!is_held(tick.state)) continue;
            if (grasped == 0) {
              grasped = now.gap;
              const Vec3 a = to_vec3(tick.proxies[0]) - to_vec3(scene.vessels[0].place),
                         b = to_vec3(tick.proxies[1]) - to_vec3(scene.vessels[0].place);
              const Vec3 d = glm::normalize(b - a);
              grip.azimuth = std::atan2(-d.z, d.x);
              grip.obliquity = std::asin(d.y);
              result.midpoint = to_triple(0.5 * (a + b));
              const core_f64::Vessel vessel = ready_vessel(scene.vessels[0]);
              const core_f64::Hand hand = ready_hand(scene.hand);
              int element = 0;
              const double thumb = core_f64::angle_between(core_f64::distance_gradient(vessel, a, element), -d);
              const double index = core_f64::angle_between(core_f64::distance_gradient(vessel, b, element), d);
              result.antipodal = std::max(thumb, index) <= std::atan(scene.force.friction);
            }
            if (n % 50 != 0 && tick.tilt > 0) continue;
            const LiquidResult liquid = fill > 0 ? evaluator->liquid(0, fill, tick.tilt) : LiquidResult{0, 0, 0, floor, 0};
            ASSERT_LT(liquid.poured, 1e-12);
            const double squeeze = grasped - now.gap;
            const StateResult state = evaluator->state(0, grip, result, liquid, tick.tilt, squeeze);
            const auto near = [](double a, double b, const char* what) {
              if (std::isinf(b)) {
                EXPECT_EQ(a, b) << what;
              } else {
                EXPECT_NEAR(a, b, 1e-9 * std::max(1e-3, std::abs(b))) << what;
              }
            };
            near(tick.torque, state.torque, "torque");
            near(tick.exact_torque, state.exact_torque, "exact torque");
            near(tick.normal_force, state.normal_force, "normal force");
            near(tick.feedback, state.feedback_force, "feedback");
            near(tick.hold_force, state.hold_force, "hold force");
            near(tick.wanted.grip, state.feedback_force, "grip");
            ++compared;
          }
          EXPECT_GT(grasped, 0) << scene.vessels[0].name;
        }
      }
    }
  }
  EXPECT_GT(compared, 3000);
}

// The weight comes on over FULL_WEIGHT of lifting, and is then that of glass and liquid; the user's force is the feedback less what the torque
// added since the grasp.
TEST(Session, TheWeightComesOnWithTheLift) {
  const Scene scene = live_scene();
  const auto evaluator = make_core_evaluator(scene);
  const double glass = evaluator->constants(0).mass;
  double normal_at_grasp = -1;
  int full = 0;
  for (const Tick& tick : play(scene, script_for(scene))) {
    if (!is_held(tick.state)) continue;
    if (normal_at_grasp < 0) normal_at_grasp = tick.normal_force;
    const double whole = (glass + 1000 * tick.volume[0]) * G, lifted = tick.vessel_place[1] - scene.vessels[0].place[1];
    EXPECT_LE(tick.weight, whole * (1 + 1e-12));
    EXPECT_EQ(tick.weight > 0, lifted > 0) << lifted;
    if (lifted >= FULL_WEIGHT) {
      EXPECT_NEAR(tick.weight, whole, 1e-9);
      ++full;
    }
    EXPECT_EQ(tick.wanted.arm, (Triple{0, -tick.weight, 0}));
    EXPECT_NEAR(tick.user_force, tick.feedback - (tick.normal_force - normal_at_grasp), 1e-15);
    EXPECT_NEAR(tick.feedback, std::clamp(tick.normal_force + tick.opening_force, 0.0, scene.force.max), 1e-15);
  }
  EXPECT_GT(full, 1000);
}

// ---- liquid ----

TEST(Session, LosesNoLiquid) {
  for (const bool hits : {true, false}) {
    Scene scene = live_scene();
    if (!hits) scene.task->target_place[2] += 1;
    const std::vector<Tick> record = play(scene, script_for(scene));
    const double whole = record[0].volume[0];
    EXPECT_NEAR(whole, 0.5 * make_core_evaluator(scene)->capacity(0), 1e-15);
    double flowed = 0;
    for (const Tick& tick : record) {
      ASSERT_LE(in_sight(tick, 0), whole + 1e-15);
      ASSERT_GE(tick.flow, 0);
      flowed += tick.flow * 1e-3;
      // what left the lip is in the air, arrived or spilt
      ASSERT_NEAR(whole - tick.volume[0], flowed, 1e-12);
      if (tick.tilt == 0 && is_held(tick.state)) {
        EXPECT_EQ(tick.flow, 0);
      }
    }
    EXPECT_NEAR(in_sight(record.back(), 0), whole, 1e-15);  // seconds after: all has landed
    EXPECT_GT(hits ? record.back().arrived[0] : record.back().spilt[0], 50e-6);
    EXPECT_EQ(hits ? record.back().spilt[0] : record.back().arrived[0], hits ? record.back().spilt[0] : 0);
  }
}

// Held still long enough at a tilt, what is left is what the lip holds back there.
TEST(Session, PoursDownToWhatTheLipHolds) {
  Scene scene = live_scene();
  LiveScript script = script_for(scene);
  script.tilt = radians(75);
  const auto at = [&](std::int64_t n) { return script.at(std::min<std::int64_t>(n, 3900)); };
  const std::vector<Tick> record = play(scene, at, 3900 + 5000);  // 33 time constants
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
  EXPECT_EQ(a.spilt, b.spilt);
  EXPECT_EQ(a.torque, b.torque);
  EXPECT_EQ(a.vessel_place, b.vessel_place);
}

TEST(Session, TheSameStatesGiveTheSameForcesToTheBit) {
  const Scene scene = live_scene();
  const LiveScript script = script_for(scene);
  const auto next = [](std::int64_t n) { return n + 1 + n % 3; };
  const auto at = [&](std::int64_t n) { return script.at(n); };
  const std::vector<Tick> a = play(scene, at, 7000, next), b = play(scene, at, 7000, next);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_same_to_the_bit(a[k], b[k]);
}

// Ticks that are missed change neither the states that are gone through nor, beyond what a tick is long, what pours.
TEST(Session, MissedTicksAreOnlyTime) {
  const Scene scene = live_scene();
  const LiveScript script = script_for(scene);
  const auto at = [&](std::int64_t n) { return script.at(n); };
  const std::vector<Tick> all = play(scene, at, 7000), some = play(scene, at, 7000, [](std::int64_t n) { return n + 1 + n % 4; });
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
  EXPECT_NEAR(in_sight(some.back(), 0), some[0].volume[0], 1e-15);
}

TEST(Session, ALeftHandIsMirrored) {
  Scene right = live_scene();
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
    const std::vector<Tick> a = play(
                                right, [&](std::int64_t n) { return script.at(n); }, 7000),
                            b = play(left, at_left, 7000);
    int held = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].state, b[k].state);
      // 1e-12: the same to rounding
      EXPECT_LT(glm::length(to_vec3(a[k].wanted.arm) - to_vec3(mirrored_x(b[k].wanted.arm))), 1e-12);
      EXPECT_NEAR(a[k].wanted.grip, b[k].wanted.grip, 1e-12);
      EXPECT_LT(glm::length(to_vec3(a[k].tips[1]) - to_vec3(mirrored_x(b[k].tips[1]))), 1e-12);
      EXPECT_LT(glm::length(to_vec3(a[k].proxies[0]) - to_vec3(mirrored_x(b[k].proxies[0]))), 1e-12);
      EXPECT_LT(glm::length(to_vec3(a[k].vessel_place) - to_vec3(mirrored_x(b[k].vessel_place))), 1e-12);
      EXPECT_NEAR(a[k].torque, b[k].torque, 1e-12);
      EXPECT_EQ(a[k].touch_mask, b[k].touch_mask);
      EXPECT_NEAR(a[k].volume[0], b[k].volume[0], 1e-15);
      EXPECT_NEAR(a[k].arrived[0], b[k].arrived[0], 1e-15);
      held += is_held(a[k].state);
    }
    EXPECT_GT(held, 1000);
  }
}

// ---- clutch and task ----

TEST(Session, TheClutchTakesTheForceAway) {
  Scene scene = scene_of({beaker1()});
  scene.device.clutch_button = 0;
  const auto at = [](std::int64_t n) {
    GripperState state = held_at(Vec3(0.102 - 1e-4 * std::min<double>(static_cast<double>(n), 70), 0.05, 0), 0.1);
    if (n >= 100 && n < 200) {
      state.buttons = 1;
      state.position[0] -= 1e-4 * static_cast<double>(n - 99);  // on through the glass, were it not for the clutch
    }
    if (n >= 200) state.position[0] -= 1e-2;
    return state;
  };
  const std::vector<Tick> record = play(scene, at, 300);
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
  const std::vector<Tick> first = play(scene, script_for(scene));
  scene.task->amounts[0].second = first.back().arrived[0];
  scene.task->tolerance = 1e-6;
  const std::vector<Tick> record = play(scene, script_for(scene));
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
  const std::vector<Tick> carried = play(scene, at, 3500);
  EXPECT_EQ(carried[2290].vessel, 1);
  EXPECT_EQ(carried.back().destinations, 1);
}

// ---- the hand ----

// The rotation of a gripper whose first axis is the line through the tips and whose second is against the little finger's side.
TEST(PlaceLiveHand, IsTheSweepsHand) {
  Random random(12);
  for (const HandData& data : {HandData{}, odd_hand(), large_hand()}) {
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
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The forces of a live session, before the grasp against closed forms and after it against a sweep.
// sanitizers: address
#include "core/vectors.h"
#include "device/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/trig.h"
#include "device/session/workspace.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

// ---- forces before the grasp ----

// The thumb, 8 mm of radius, pressed in by a depth from the side: K times the depth outwards, less B times the speed; nothing on
// the other tip.
TEST(Session, TheCouplingIsThatOfAWall) {
  Scene scene = scene_of({beaker1()});
  scene.force.friction = 0;
  const Vec3 place(0.1, 0.02, 0.05);
  scene.vessels[0].place = to_triple(place);
  const double gap = 0.1, speed = 0.02;
  const auto at = [&](std::int64_t n) {
    // the thumb, on the gripper's -x side, comes from the right
    const double thumb = 0.050 - speed * 1e-3 * static_cast<double>(n);
    return gripper_at(place + Vec3(thumb + gap / 2, 0.05, 0), gap);
  };
  int pressed = 0;
  for (const Tick& tick : play_session(scene, at, 300)) {
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
  for (const Tick& tick : play_session(
           scene,
           [](std::int64_t n) {
             // in and out again at 0.1 m/s
             return gripper_at(Vec3(0.053 - 1e-4 * std::min<double>(static_cast<double>(n), 70) +
                                        1e-4 * std::max(0.0, static_cast<double>(n) - 70) + 0.05,
                                    0.05, 0),
                               0.1);
           },
           200)) {
    EXPECT_GE(tick.coupling[0][0], -1e-12);
  }
}

// A shell, bare points: a tip that closes at 1 m/s and is through the wall before the next tick still stands outside, and is still
// felt; and the grasp comes about.
TEST(Session, AThinWallHoldsAFastFinger) {
  for (const double rate : {1000.0, 3000.0}) {
    HandData hand = paper_hand();
    for (FingerData& finger : hand.fingers) finger.radii = {};
    Scene scene = scene_of({shell_of(beaker1())}, Pose::rigged, hand);
    scene.live.rate = rate;
    const auto range = own_gap(hand);
    const auto at = [&](std::int64_t n) {
      return gripper_at(Vec3(4e-3, 0.06, 0), std::max(0.066, range[1] - 2 * static_cast<double>(n) / rate));  // each tip 1 m/s
    };
    bool touched = false, held = false;
    for (const Tick& tick : play_session(scene, at, 100)) {
      for (const Triple& proxy : tick.proxies) EXPECT_GE(std::hypot(proxy[0], proxy[2]), 40e-3 - 1e-8);
      touched = touched || tick.state == SessionState::touching;
      held = held || is_held(tick.state);
    }
    EXPECT_TRUE(touched);
    EXPECT_TRUE(held);
  }
}

// A vessel in which a tip is at the start is not felt until both have left it.
TEST(Session, StartsWithoutAForce) {
  Scene scene = scene_of({beaker1()});
  const auto at = [](std::int64_t n) {
    return gripper_at(
        Vec3(0.02 + 1e-4 * std::min<double>(static_cast<double>(n), 1300) - 1e-4 * std::max(0.0, static_cast<double>(n) - 1300),
             0.05, 0),
        0.1);
  };
  const std::vector<Tick> record = play_session(scene, at, 2000);
  for (std::int64_t n = 0; n < 1300; ++n) EXPECT_EQ(record[static_cast<std::size_t>(n)].wanted.arm, Triple{}) << n;
  EXPECT_GT(record.back().wanted.arm[0], 1);
}

// ---- forces after it ----

// A grip that is lifted and tilted: a vessel of the three, held from `azimuth`, filled to `fill` of its cavity.
struct FeltGrip {
  std::size_t vessel;
  Torque torque;
  double azimuth;  // rad
  double fill;

  std::string name() const {
    return "vessel " + std::to_string(vessel) + (torque == Torque::paper ? ", paper" : ", exact") + ", azimuth " +
           std::to_string(azimuth) + ", fill " + std::to_string(fill);
  }
};

constexpr FeltGrip FELT_GRIPS[] = {
    {0, Torque::paper, 0, 0}, {0, Torque::paper, 0, 0.3}, {0, Torque::paper, 2.1, 0}, {0, Torque::paper, 2.1, 0.3},
    {0, Torque::exact, 0, 0}, {0, Torque::exact, 0, 0.3}, {0, Torque::exact, 2.1, 0}, {0, Torque::exact, 2.1, 0.3},
    {1, Torque::paper, 0, 0}, {1, Torque::paper, 0, 0.3}, {1, Torque::paper, 2.1, 0}, {1, Torque::paper, 2.1, 0.3},
    {1, Torque::exact, 0, 0}, {1, Torque::exact, 0, 0.3}, {1, Torque::exact, 2.1, 0}, {1, Torque::exact, 2.1, 0.3},
    {2, Torque::paper, 0, 0}, {2, Torque::paper, 0, 0.3}, {2, Torque::paper, 2.1, 0}, {2, Torque::paper, 2.1, 0.3},
    {2, Torque::exact, 0, 0}, {2, Torque::exact, 0, 0.3}, {2, Torque::exact, 2.1, 0}, {2, Torque::exact, 2.1, 0.3},
};

// A value of a tick, and the same of a sweep's state.
struct FeltValue {
  const char* name;
  double (*felt)(const Tick&);
  double (*swept)(const StateResult&);
};

constexpr FeltValue FELT_VALUES[] = {
    {"torque", [](const Tick& t) { return t.torque; }, [](const StateResult& s) { return s.torque; }},
    {"exact torque", [](const Tick& t) { return t.exact_torque; }, [](const StateResult& s) { return s.exact_torque; }},
    {"normal force", [](const Tick& t) { return t.normal_force; }, [](const StateResult& s) { return s.normal_force; }},
    {"feedback", [](const Tick& t) { return t.feedback; }, [](const StateResult& s) { return s.feedback_force; }},
    {"hold force", [](const Tick& t) { return t.hold_force; }, [](const StateResult& s) { return s.hold_force; }},
    {"grip", [](const Tick& t) { return t.wanted.grip; }, [](const StateResult& s) { return s.feedback_force; }},
};

void expect_felt(const Tick& tick, const StateResult& state) {
  for (const auto& [name, felt, swept] : FELT_VALUES) {
    const double a = felt(tick), b = swept(state);
    if (std::isinf(b)) {
      EXPECT_EQ(a, b) << name;
    } else {
      EXPECT_NEAR(a, b, 1e-9 * std::max(1e-3, std::abs(b))) << name;
    }
  }
}

Scene felt_scene(const FeltGrip& felt) {
  Scene scene = three_beakers();
  scene.force.torque = felt.torque;
  scene.vessels = {scene.vessels[felt.vessel]};
  if (felt.fill > 0) {
    scene.vessels[0].liquid_name = "water";
    scene.vessels[0].liquid_fill = felt.fill;
  }
  scene.vessels[0].place = {0.03, 0.01, -0.02};
  return scene;
}

// The grip of the tips where they are, as a sweep would have it.
void sweeps_grip(const Scene& scene, const Tick& tick, GripInput& grip, GripResult& result) {
  const Vec3 place = to_vec3(scene.vessels[0].place), a = to_vec3(tick.proxies[0]) - place, b = to_vec3(tick.proxies[1]) - place;
  const Vec3 d = glm::normalize(b - a);
  grip.azimuth = std::atan2(-d.z, d.x);
  grip.obliquity = std::asin(d.y);
  result.midpoint = to_triple(0.5 * (a + b));
  const core_f64::Vessel vessel = ready_vessel(scene.vessels[0]);
  int element = 0;
  const double thumb = core_f64::angle_between(core_f64::distance_gradient(vessel, a, element), -d);
  const double index = core_f64::angle_between(core_f64::distance_gradient(vessel, b, element), d);
  result.antipodal = std::max(thumb, index) <= std::atan(scene.force.friction);
}

// The force on the tip at the gripper's +x (`side` 1) or on the other one, device frame, which is that
// of the scene here.
Vec3 tip_force(const Tick& tick, double side) {
  const Vec3 line = to_mat3(tick.hand_rotation)[0];
  return 0.5 * to_vec3(tick.wanted.arm) + side * (tick.wanted.grip * line + to_vec3(tick.wanted.across));
}

// Before the grasp each tip feels its own coupling. The thumb is at the gripper's -x on a right hand, at its +x on a left one.
TEST(Session, EachTipFeelsItsOwnCoupling) {
  Scene right = scene_of({beaker1()});
  right.force.friction = 0;
  Scene left = right;
  left.hand.handedness = Handedness::left;
  const double gap = 0.1;
  // the thumb comes from the right, beside the axis, so that no normal runs along the closing line
  const auto at = [gap](std::int64_t n) {
    return gripper_at(Vec3(0.050 - 2e-5 * static_cast<double>(n) + gap / 2, 0.05, 0.012), gap);
  };
  const auto mirrored_at = [&](std::int64_t n) {
    GripperState state = at(n);
    state.position = mirrored(state.position, Handedness::left);
    return state;
  };
  const auto check = [](const std::vector<Tick>& ticks, double index) {
    int across = 0;
    for (const Tick& tick : ticks) {
      // rounding of sums of forces under 10 N
      EXPECT_LT(glm::length(tip_force(tick, index) - to_vec3(tick.coupling[1])), 1e-13);
      EXPECT_LT(glm::length(tip_force(tick, -index) - to_vec3(tick.coupling[0])), 1e-13);
      across += norm(tick.wanted.across) > 0.1;
    }
    EXPECT_GT(across, 50);
  };
  check(play_session(right, at, 300), 1);
  check(play_session(left, mirrored_at, 300), -1);
}

// In the hand the two tips' forces are the weight's reaction: their sum is the weight, and they balance its torque about the middle of the contacts
// but for its part along the closing line.
TEST(Session, TheTwoTipsCarryTheWeightAndItsTorque) {
  Scene scene = scene_of({lopsided()});
  scene.force.base = 5;
  LiveScript script = script_for(scene);
  script.azimuth = 0.4;
  const Vec3 center = to_vec3(scene.vessels[0].center_of_mass);
  int held = 0, turned = 0;
  for (const Tick& tick : play_session(
           scene, [&](std::int64_t n) { return script.at(n); }, 7000)) {
    if (!is_held(tick.state) || tick.weight == 0) continue;
    ++held;
    const Vec3 line = to_mat3(tick.hand_rotation)[0];
    const Vec3 index = tip_force(tick, 1), thumb = tip_force(tick, -1);
    EXPECT_LT(glm::length(index + thumb - Vec3(0, -tick.weight, 0)), 1e-12);
    EXPECT_NEAR(glm::dot(index - thumb, line), 2 * tick.feedback, 1e-12);
    const Vec3 at_thumb = to_vec3(tick.proxies[0]), at_index = to_vec3(tick.proxies[1]), middle = 0.5 * (at_thumb + at_index);
    const Vec3 at = to_vec3(tick.vessel_place) + to_mat3(tick.vessel_rotation) * center;
    const Vec3 wanted = glm::cross(at - middle, Vec3(0, -tick.weight, 0));
    const Vec3 apart = glm::length(at_index - at_thumb) * line;
    const Vec3 carried = 0.5 * glm::cross(apart, index - thumb);
    EXPECT_LT(glm::length(wanted - glm::dot(wanted, line) * line - carried), 1e-12);
    turned += glm::length(carried) > 1e-3;
  }
  EXPECT_GT(held, 1000);
  EXPECT_GT(turned, 100);
}

// What a sweep says of the same grip, liquid and tilt.
TEST(Session, FeelsExactlyWhatTheSweepSays) {
  int compared = 0;
  for (const FeltGrip& felt : FELT_GRIPS) {
    SCOPED_TRACE(felt.name());
    const Scene scene = felt_scene(felt);
    const auto evaluator = make_core_evaluator(scene);
    const double floor = ready_vessel(scene.vessels[0]).floor_height;
    LiveScript script = script_for(scene);
    script.azimuth = felt.azimuth;
    script.height = 0.45 * scene.vessels[0].height;
    script.tilt = felt.fill > 0 ? radians(35) : radians(140);
    // flask and cone are of other widths than the script's cylinder: it closes until they are held
    double grasped = 0;
    const auto at = [&](std::int64_t n) {
      GripperState state = script.at(n);
      if (n < 1500) {
        state.gap = 0.127 - 5e-5 * static_cast<double>(n);
        state.position = scene.vessels[0].place;
        state.position[1] += script.height;
      }
      if (grasped > 0) state.gap = grasped - 1e-3;  // squeezed by a millimeter
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
        sweeps_grip(scene, tick, grip, result);
      }
      if (n % 50 != 0 && tick.tilt > 0) continue;
      const LiquidResult liquid = felt.fill > 0 ? evaluator->liquid(0, felt.fill, tick.tilt) : LiquidResult{0, 0, 0, floor, 0};
      ASSERT_LT(liquid.poured, 1e-12);
      const double squeeze = grasped - now.gap;
      expect_felt(tick, evaluator->state(0, grip, result, liquid, tick.tilt, squeeze));
      ++compared;
    }
    EXPECT_GT(grasped, 0) << scene.vessels[0].name;
  }
  EXPECT_GT(compared, 3000);
}

// The weight comes on over FULL_WEIGHT of lifting, and is then that of glass and liquid; the user's force is the feedback less what
// the torque added since the grasp.
TEST(Session, TheWeightComesOnWithTheLift) {
  const Scene scene = live_scene();
  const auto evaluator = make_core_evaluator(scene);
  const double glass = evaluator->constants(0).mass;
  double normal_at_grasp = -1;
  int full = 0;
  for (const Tick& tick : play_session(scene, script_for(scene))) {
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

}  // namespace
}  // namespace wholehand::device

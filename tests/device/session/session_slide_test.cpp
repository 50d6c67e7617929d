// SPDX-License-Identifier: MIT
// A vessel that slides in the fingers of a live session: when it begins, how it moves, how it is caught and lost.
// sanitizers: address
#include "device/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/contact.h"
#include "core/vectors.h"
#include "device/session/hand_view.h"
#include "device/session/inertia.h"
#include "device/session/workspace.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand::device {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

constexpr std::int64_t LIFTED = 2250;  // a tick at which the script's hand is up and has not tilted yet

// The script's grip holds the beaker upright with 3.7 N where 2.9 are needed, and not as it tilts.
Scene sliding_scene() {
  Scene scene = live_scene();
  scene.force.base = 3;
  scene.force.max = 12;
  scene.live.slide = true;
  return scene;
}

// The script up to LIFTED, then at rest, with the fingers opened by `opening` m.
template <class Opening>
std::vector<Tick> play_opened(const Scene& scene, Opening opening, std::int64_t ticks) {
  const LiveScript script = script_for(scene);
  return play_session(
      scene,
      [&](std::int64_t n) {
        GripperState state = script.at(std::min(n, LIFTED));
        state.gap += n < LIFTED ? 0 : opening(n - LIFTED);
        return state;
      },
      LIFTED + ticks);
}

// The vessel in the gripper's axes.
struct InHand {
  Mat3 rotation;
  Vec3 place;
  explicit InHand(const Tick& tick)
      : rotation(glm::transpose(to_mat3(tick.hand_rotation)) * to_mat3(tick.vessel_rotation)),
        place(glm::transpose(to_mat3(tick.hand_rotation)) * (to_vec3(tick.vessel_place) - to_vec3(tick.middle))) {}
};

double lifted_share(const Scene& scene, const Tick& tick) {
  return minimum_jerk((tick.vessel_place[1] - scene.vessels[0].place[1]) / FULL_WEIGHT);
}

// A grip that holds at rest keeps the vessel where it is; one that does not lets it slide. This is the law of all sessions: the limit is the hold force.
void expect_law(const Scene& scene, const std::vector<Tick>& record, int& held, int& sliding) {
  bool was_sliding = false;
  double normal_at_grasp = 0;
  for (std::size_t k = 1; k < record.size(); ++k) {
    const Tick &before = record[k - 1], &tick = record[k];
    if (is_held(tick.state) && !is_held(before.state)) normal_at_grasp = tick.normal_force;
    if (!is_held(tick.state) || !is_held(before.state)) {
      was_sliding = false;
      continue;
    }
    if (scene.live.slide_by == SlideBy::tips && std::isfinite(tick.hold_force)) {
      const double needed = lifted_share(scene, tick) * tick.hold_force;
      const double grip = std::clamp(normal_at_grasp + tick.opening_force, 0.0, scene.force.max);
      ASSERT_NEAR(tick.safety_margin, grip - needed, 1e-9) << tick.number;
      if (tick.feedback > 0 && tick.feedback < scene.force.max) {
        ASSERT_NEAR(grip, tick.user_force, 1e-9) << tick.number;
      }
    }
    const bool is_on_table = lifted_share(scene, tick) == 0;
    if (tick.safety_margin >= 0 && !was_sliding) {
      ++held;
      ASSERT_EQ(tick.slip_speed, 0) << tick.number;
    }
    if (is_on_table) {
      ASSERT_EQ(tick.slip_speed, 0) << tick.number;
    }
    // 1e-9 N: rounding decides at the limit itself
    if (tick.safety_margin < -1e-9 && !is_on_table) {
      ++sliding;
      ASSERT_GT(tick.slip_speed, 0) << tick.number;
    }
    was_sliding = tick.slip_speed > 0;
  }
}

TEST(SessionSlide, StartsWhereTheGripIsLessThanTheHoldForce) {
  const Scene scene = sliding_scene();
  const std::vector<Tick> record = play_opened(
      scene, [](std::int64_t n) { return 4e-6 * static_cast<double>(std::max<std::int64_t>(0, n - 50)); }, 700);
  const Tick& first = record[LIFTED];
  ASSERT_TRUE(is_held(first.state));
  ASSERT_GT(first.safety_margin, 0.1);
  const InHand rest(first);
  int still = 0, slid = 0;
  for (std::size_t k = LIFTED; k < record.size() && is_held(record[k].state); ++k) {
    const InHand now(record[k]);
    if (record[k].slip_distance == 0) {
      ++still;
      ASSERT_LT(glm::length(now.place - rest.place), 1e-15) << k;  // rounding of the way into the world and back
    } else {
      ++slid;
      ASSERT_LT(now.place.y, rest.place.y) << k;
    }
  }
  EXPECT_GT(still, 100);
  EXPECT_GT(slid, 100);
  int held = 0, sliding = 0;
  expect_law(scene, record, held, sliding);
  EXPECT_GT(sliding, 50);
}

// A cylinder and a ball with a neck, random frictions, fills, places and tilts; the whole way from grasp to pouring.
TEST(SessionSlide, TheLimitIsTheHoldForceInAnySession) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int held = 0, sliding = 0;
  for (int n = 0; n < 12; ++n) {
    Scene scene = sliding_scene();
    const bool is_ball = n % 3 == 1;
    if (is_ball) {
      const VesselData before = scene.vessels[0];
      scene.vessels[0] = beaker2();
      scene.vessels[0].liquid_name = before.liquid_name;
      scene.vessels[0].place = before.place;
    }
    scene.force.friction = between(0.4, 1.2);
    scene.force.torsion = n % 4 == 3 ? 0 : between(2e-3, 1e-2);
    scene.vessels[0].liquid_fill = between(0, 0.6);
    LiveScript script = script_for(scene);
    script.azimuth = between(-0.5, 0.5);
    script.height = is_ball ? between(35e-3, 50e-3) : between(40e-3, 75e-3);
    script.tilt = radians(between(20, 115));
    expect_law(scene, play_session(scene, script), held, sliding);
  }
  EXPECT_GT(held, 5000);
  EXPECT_GT(sliding, 500);
}

// With a steady grip it falls with a = g - 2 mu F / m, upright and straight.
TEST(SessionSlide, FallsWithWhatFrictionLeavesOfGravity) {
  const Scene scene = sliding_scene();
  const std::vector<Tick> record = play_opened(
      scene, [](std::int64_t n) { return n < 50 ? 0 : 3e-3; }, 110);
  const Tick& last = record.back();
  ASSERT_TRUE(is_held(last.state));
  const double mass = last.weight / scene.gravity, force = last.user_force;
  const double acceleration = scene.gravity - 2 * scene.force.friction * force / mass;
  ASSERT_GT(acceleration, 2);
  // the step of tick 50 is in the vessel's place one tick later
  const double seconds = 1e-3 * 59, way = 0.5 * acceleration * seconds * (seconds + LONGEST_SLIDE);
  // 1e-6 m: the liquid weighs on as it is, and the grip force is steady to 1e-3
  EXPECT_NEAR(last.slip_distance, way, 1e-6);
  EXPECT_NEAR(InHand(record[LIFTED]).place.y - InHand(last).place.y, way, 1e-6);
  // the arm carries what friction carries
  EXPECT_NEAR(last.wanted.arm[1], -2 * scene.force.friction * force, 1e-6);
  EXPECT_NEAR(record[LIFTED].wanted.arm[1], -last.weight, 1e-6);
  EXPECT_LT(std::abs(last.slip_angle), 1e-6);
  EXPECT_LT(last.tilt, 1e-6);
}

TEST(SessionSlide, ASqueezeCatchesIt) {
  const Scene scene = sliding_scene();
  const std::vector<Tick> record = play_opened(
      scene, [](std::int64_t n) { return n < 50 || n > 100 ? -2e-3 : 3e-3; }, 600);
  const Tick& last = record.back();
  EXPECT_TRUE(is_held(last.state));
  EXPECT_EQ(last.lost, 0);
  EXPECT_EQ(last.slip_speed, 0);
  EXPECT_GT(last.slip_distance, 5e-3);
  EXPECT_GT(last.safety_margin, 0);
  const Tick& caught = record[LIFTED + 300];
  EXPECT_EQ(caught.slip_distance, last.slip_distance);
  EXPECT_LT(glm::length(InHand(caught).place - InHand(last).place), 1e-15);
  // the hand took it again where it now is
  EXPECT_EQ(last.grasp_height, record[LIFTED].grasp_height);
  const double height = 0.5 * (last.proxies[0][1] + last.proxies[1][1]) - last.vessel_place[1];
  EXPECT_NEAR(height - last.grasp_height, last.slip_distance, 1e-6);
}

// Let go of, it falls out of the fingers: contact ends at the rim.
TEST(SessionSlide, ItIsLostWhereContactIsLost) {
  const Scene scene = sliding_scene();
  const std::vector<Tick> record = play_opened(
      scene, [](std::int64_t n) { return n < 50 ? 0 : 6e-3; }, 600);
  const auto lost = std::find_if(record.begin() + LIFTED, record.end(), [](const Tick& tick) { return !is_held(tick.state); });
  ASSERT_NE(lost, record.end());
  EXPECT_EQ(lost->state, SessionState::slipped);
  EXPECT_EQ(lost->lost, 1);
  EXPECT_EQ(lost->wanted.grip, 0);
  EXPECT_EQ(lost->wanted.arm, Triple{});
  const double way = scene.vessels[0].height - lost->grasp_height;
  // the tips roll over the rim: at most by their radius, and a tick of 1 m/s
  EXPECT_GT(lost->slip_distance, way);
  EXPECT_LT(lost->slip_distance, way + LiveScene(scene).hand.radius[0][3] + 1.5e-3);
  const double fall = std::sqrt(2 * way / scene.gravity);
  EXPECT_NEAR(1e-3 * static_cast<double>(lost->number - LIFTED - 50), fall, 0.1 * fall);  // the last of the grip slows it a little
}

// Without [live] slide nothing of it is there.
TEST(SessionSlide, IsOffByDefault) {
  EXPECT_FALSE(LiveData{}.slide);
  for (const Tick& tick : play_opened(
           live_scene(), [](std::int64_t n) { return n < 50 ? 0 : 6e-3; }, 600)) {
    EXPECT_TRUE(std::isnan(tick.safety_margin));
    EXPECT_EQ(tick.slip_distance, 0);
    EXPECT_EQ(tick.slip_speed, 0);
    EXPECT_EQ(tick.lost, 0);
  }
}

// The tips rest on the surface, and their line stays in the gripper's axes, however the vessel slides and turns.
TEST(SessionSlide, TheTipsStayOnTheirLineAndOnTheSurface) {
  Scene scene = sliding_scene();
  scene.force.torsion = 2e-3;
  LiveScript script = script_for(scene);
  const LiveScene live(scene);
  const std::array<double, 2> radii{live.hand.scale * live.hand.radius[0][3], live.hand.scale * live.hand.radius[1][4]};
  Vec3 line(0);
  int turned_ticks = 0;
  for (const Tick& tick : play_session(scene, script)) {
    if (!is_held(tick.state)) continue;
    turned_ticks += std::abs(tick.slip_angle) > radians(5);
    const Stance stance{to_vec3(tick.vessel_place), to_mat3(tick.vessel_rotation)};
    for (std::size_t k = 0; k < 2; ++k) {
      const double away = core_f64::separation_at(live.vessels[0].vessel, stance.inward(to_vec3(tick.proxies[k])), radii[k]);
      // at the grasp a proxy may be as far away as the contact tolerance
      if (tick.slip_distance > 0) {
        EXPECT_LT(std::abs(away), 1e-7) << tick.number;
      }
    }
    const Vec3 now =
        glm::transpose(to_mat3(tick.hand_rotation)) * glm::normalize(to_vec3(tick.proxies[1]) - to_vec3(tick.proxies[0]));
    if (line == Vec3(0)) line = now;
    EXPECT_LT(glm::length(now - line), 1e-9) << tick.number;
  }
  EXPECT_GT(turned_ticks, 100);
}

// By effort: the margin is the grip force less the effort times the weaker tip's strength, as the display computes it.
TEST(SessionSlide, ByTheWholeHandTheLimitIsEffortOne) {
  Scene scene = sliding_scene();
  scene.strength.emplace();
  scene.live.slide_by = SlideBy::hand;
  LiveScript script = script_for(scene);
  const LiveScene live(scene);
  Session session(scene, own_gap(scene.hand));
  std::vector<Tick> record;
  int compared = 0, held = 0, sliding = 0;
  for (std::int64_t n = 0; n < 5000; ++n) {
    Tick& tick = record.emplace_back();
    session.step(script.at(n), n, tick);
    // the displayed hand is posed anew in each tick, the session's only after a slip of POSE_SLIP
    if (n % 50 != 0 || !is_held(tick.state) || tick.slip_distance > 0) continue;
    const auto hold = hand_view(live, tick, session.poses()).hold;
    ASSERT_TRUE(hold);
    if (!std::isfinite(hold->effort)) continue;
    ++compared;
    // 3e-3 of the hold force: the brackets of two efforts
    EXPECT_NEAR(tick.user_force - tick.safety_margin, lifted_share(scene, tick) * hold->force(), 3e-3 * hold->force()) << n;
  }
  EXPECT_GT(compared, 10);
  expect_law(scene, record, held, sliding);
  EXPECT_GT(held, 500);
  const std::vector<Tick> opened = play_opened(
      scene, [](std::int64_t n) { return 4e-6 * static_cast<double>(std::max<std::int64_t>(0, n - 50)); }, 1000);
  expect_law(scene, opened, held, sliding);
  EXPECT_GT(sliding, 50);
}

// At F_max what tilt adds to F_n no longer shows in the feedback, and fingers that hold still do not grip less.
TEST(SessionSlide, ASaturatedFeedbackTakesNoGripAway) {
  Scene scene = sliding_scene();
  LiveScript script = script_for(scene);
  scene.force.max = 3;
  int saturated = 0;
  double normal_at_grasp = -1;
  for (const Tick& tick : play_session(scene, script)) {
    if (!is_held(tick.state)) continue;
    if (normal_at_grasp < 0) normal_at_grasp = tick.normal_force;
    if (tick.feedback < scene.force.max || tick.normal_force <= normal_at_grasp + 0.1) continue;
    ++saturated;
    const double needed = lifted_share(scene, tick) * tick.hold_force;
    EXPECT_NEAR(tick.safety_margin + needed, std::min(scene.force.max, normal_at_grasp + tick.opening_force), 1e-9) << tick.number;
    EXPECT_LT(tick.user_force, tick.safety_margin + needed) << tick.number;
  }
  EXPECT_GT(saturated, 100);
}

// ---- inertia ----

// A solid cylinder and, by difference of two, a beaker: closed forms.
TEST(SessionSlide, TheWallsInertiaIsThatOfTwoCylinders) {
  const double r = 40e-3, h = 110e-3, t = 1.5e-3, inner = r - t, depth = h - t;
  const Scene scene = sliding_scene();
  const LiveScene live(scene);
  const double density = live.vessels[0].vessel.mass / (PI * (r * r * h - inner * inner * depth));
  const auto disc = [&](double radius, double height) { return density * PI * radius * radius * height; };
  const double outer_mass = disc(r, h), hole = disc(inner, depth), mass = outer_mass - hole;
  const double center = (outer_mass * h / 2 - hole * (t + depth / 2)) / mass;
  const auto across = [&](double m, double radius, double height, double middle) {
    return m * ((3 * radius * radius + height * height) / 12 + (middle - center) * (middle - center));
  };
  const Mat3 inertia = live.vessels[0].inertia;
  // 1e-10: the rule's own error
  EXPECT_NEAR(inertia[1][1] / (0.5 * outer_mass * r * r - 0.5 * hole * inner * inner), 1, 1e-9);
  EXPECT_NEAR(inertia[0][0] / (across(outer_mass, r, h, h / 2) - across(hole, inner, depth, t + depth / 2)), 1, 1e-9);
  EXPECT_EQ(inertia[0][0], inertia[2][2]);
  EXPECT_EQ(inertia[0][1], 0);
}

}  // namespace
}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// When a live session lets go: where the opening leaves its band, where the fingers open; and what the vessel then does.
// sanitizers: address
#include "core/vectors.h"
#include "device/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "device/session/workspace.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

// A hand that holds goes through other vessels. Where it lets go inside of one, that one is felt when the hand has left it, and not
// before.
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
    return gripper_at(Vec3(x, 0.055, z), gap);
  };
  bool was_held = false, lost = false;
  for (const Tick& tick : play_session(scene, at, 2000)) {
    was_held = was_held || is_held(tick.state);
    lost = lost || tick.state == SessionState::slipped;
    if (was_held && !is_held(tick.state)) {
      for (int k = 0; k < 2; ++k) ASSERT_LT(glm::length(to_vec3(tick.coupling[k])), 1e-9) << tick.number;
    }
  }
  EXPECT_TRUE(was_held);
  EXPECT_TRUE(lost);
}

// Kernel 3's too_wide: tips that touch at more than the hand can open hold nothing.
TEST(Session, WhatIsTooWideIsNotHeld) {
  const auto range = own_gap(paper_hand());
  Scene scene = scene_of({cylinder("wide", 1e3 * (range[1] - 15e-3) + 0.3, 110, 1.5)});
  bool touches = false;
  const auto at = [&](std::int64_t n) {
    // wide open, towards it from the person's side: at last both tips are within the contact tolerance
    return gripper_at(Vec3(0, 0.05, std::max(0.0, 0.2 - 1e-3 * static_cast<double>(n))), range[1]);
  };
  for (const Tick& tick : play_session(scene, at, 600)) {
    ASSERT_FALSE(is_held(tick.state)) << tick.number;
    touches = touches || tick.state == SessionState::touching;
  }
  EXPECT_TRUE(touches);
}

TEST(Session, SlipsWhenTheOpeningLeavesItsBand) {
  Scene scene = live_scene();
  scene.live.slip = 6e-3;
  const LiveScript script = script_for(scene);
  // held at 2300, then opened by a tenth of a millimeter a tick
  const auto at = [&](std::int64_t n) {
    GripperState state = script.at(std::min<std::int64_t>(n, 2300));
    state.gap += 1e-4 * static_cast<double>(std::clamp<std::int64_t>(n - 2300, 0, 200));
    if (n > 3500) state.position[0] += std::min(0.3, 1e-3 * static_cast<double>(n - 3500));
    return state;
  };
  const std::vector<Tick> record = play_session(scene, at, 4000);
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
    // and is there after RETURN_TIME
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

// Where the fingers are still in its place, it is not felt and not grasped until they have left it.
TEST(Session, AVesselThatCameBackWaitsForTheFingersToLeave) {
  Scene scene = live_scene();
  scene.live.slip = 0.5e-3;
  const LiveScript script = script_for(scene);
  // carried aside by 12 mm and let go: the thumb is then in its place, until the fingers open
  const double grasped = [&] {
    for (const Tick& tick : play_session(scene, script))
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
  const std::vector<Tick> record = play_session(scene, at, 4200);
  EXPECT_TRUE(is_held(record[2455].state));
  for (std::int64_t n = 2461; n <= 4000; ++n) {
    ASSERT_EQ(record[static_cast<std::size_t>(n)].state, SessionState::let_go) << n;
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
  for (const Tick& tick : play_session(scene, at, 2800))
    if (tick.number > 1400) {
      EXPECT_EQ(is_held(tick.state), at(tick.number).gap < open) << tick.number;
    }
}

// A vessel as wide as the hand opens: it is held within the last hundredth of the gap, whose noise is no opening.
TEST(Session, NoiseOpensNoFingers) {
  const auto range = own_gap(paper_hand());
  Scene scene = scene_of({cylinder("wide", 1e3 * (range[1] - 15e-3) - 1, 110, 1.5)});
  const auto at = [&](std::int64_t n) {
    return gripper_at(
        Vec3(-0.5e-3, 0.05, 0),
        range[1] - (n < 100 ? 0 : 1e-3) + (n > 200 && n < 800 ? 2e-5 * static_cast<double>(n % 3) : 0) + (n > 900 ? 1e-3 : 0));
  };
  const std::vector<Tick> record = play_session(scene, at, 1000);
  for (std::size_t n = 150; n < 900; ++n) ASSERT_TRUE(is_held(record[n].state)) << n;
  EXPECT_EQ(record[950].state, SessionState::let_go);
}

}  // namespace
}  // namespace wholehand::device

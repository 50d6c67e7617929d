// SPDX-License-Identifier: MIT
// A session through the C face is the session of the program, to the bit.
// sanitizers: address
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "app/c/scene.h"
#include "app/c/wholehand/wholehand.h"
#include "device/session/hand_view.h"
#include "device/session/session.h"
#include "device/session/workspace.h"
#include "sweeps/grips/hand_nodes.h"
#include "tests/app/c/expect_same.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand {
namespace {

using wholehand::expect_same;

wh_measurement measured(const device::GripperState& state, std::int64_t tick) {
  wh_measurement in;
  WH_INIT(&in);
  in.tick = tick;
  for (std::size_t k = 0; k < 3; ++k) in.position[k] = state.position[k];
  for (std::size_t k = 0; k < 9; ++k) in.rotation[k] = state.rotation[k];
  in.gap = state.gap;
  in.buttons = state.buttons;
  return in;
}

void expect_same(const wh_session_output& out, const device::Tick& tick) {
  EXPECT_EQ(out.state, static_cast<int>(tick.state));
  EXPECT_EQ(out.vessel, tick.vessel);
  expect_same(out.arm_force, tick.wanted.arm, "arm_force");
  expect_same(out.grip_force, tick.wanted.grip, "grip_force");
  expect_same(out.normal_force, tick.normal_force, "normal_force");
  expect_same(out.feedback_force, tick.feedback, "feedback_force");
  expect_same(out.user_force, tick.user_force, "user_force");
  expect_same(out.weight, tick.weight, "weight");
  expect_same(out.torque, tick.torque, "torque");
  expect_same(out.tilt, tick.tilt, "tilt");
  expect_same(out.flow, tick.flow, "flow");
  expect_same(out.closure, tick.closure, "closure");
  expect_same(out.gap, tick.gap, "gap");
  expect_same(out.vessel_place, tick.vessel_place, "vessel_place");
  expect_same(out.vessel_rotation, tick.vessel_rotation, "vessel_rotation");
  for (std::size_t k = 0; k < 2; ++k) expect_same(out.tips[k], tick.tips[k], "tips");
  EXPECT_EQ(out.touch_mask, tick.touch_mask);
  EXPECT_EQ(out.used_mask, tick.used_mask);
  EXPECT_EQ(out.grasps, tick.grasps);
  EXPECT_EQ(out.lost, tick.lost);
  EXPECT_EQ(out.destinations, tick.destinations);
  EXPECT_EQ(out.is_task_done, tick.task_done ? 1 : 0);
}

void expect_same(const wh_hand& hand, const device::HandView& view, const sweeps::HandNodes& nodes) {
  for (std::size_t j = 0; j < WH_JOINTS; ++j) {
    expect_same(hand.joints[j], view.proxies[j], "joints");
    expect_same(hand.radii[j], nodes.joints[j].radius, "radii");
    expect_same(hand.quaternions[j], nodes.joints[j].rotation, "quaternions");
    EXPECT_EQ(hand.contacts[j], static_cast<int>(view.contact[j]));
  }
  expect_same(hand.wrist, view.wrist, "wrist");
  expect_same(hand.rotation, view.rotation, "rotation");
  expect_same(hand.wrist_quaternion, nodes.wrist.rotation, "wrist_quaternion");
}

TEST(LibrarySession, StepsAsTheProgramDoes) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    Scene scene = live_scene();
    scene.hand.handedness = handedness;
    const auto ready = std::make_shared<ReadyScene>(ReadyScene{scene, make_core_evaluator(scene), AskedGrips(scene)});
    const wh_scene handle{ready};
    const auto gap = own_gap(scene.hand);
    wh_session* session = nullptr;
    ASSERT_EQ(wh_session_open(&handle, gap[0], gap[1], &session), WH_OK) << wh_message();
    device::Session truth(scene, gap);
    const LiveScript script = script_for(scene);
    device::Tick tick;
    wh_session_output out;
    wh_hand hand;
    wh_session_vessel vessel;
    WH_INIT(&out);
    WH_INIT(&hand);
    WH_INIT(&vessel);
    const auto ticks = static_cast<std::int64_t>(script.seconds() * script.rate);
    int held = 0;
    for (std::int64_t n = 0; n < ticks; ++n) {
      const device::GripperState state = script.at(n);
      const wh_measurement in = measured(state, n);
      ASSERT_EQ(wh_session_step(session, &in, &out), WH_OK) << wh_message();
      truth.step(state, n, tick);
      held += device::is_held(tick.state);
      expect_same(out, tick);
      ASSERT_EQ(wh_session_vessel_at(session, 0, &vessel), WH_OK);
      expect_same(vessel.place, truth.poses()[0].place, "place");
      expect_same(vessel.rotation, truth.poses()[0].rotation, "rotation");
      expect_same(vessel.volume, tick.volume[0], "volume");
      expect_same(vessel.arrived, tick.arrived[0], "arrived");
      expect_same(vessel.spilled, tick.spilled[0], "spilled");
      if (n % 20 == 0) {
        ASSERT_EQ(wh_session_hand(session, &hand), WH_OK);
        const device::HandView view = device::hand_view(truth.live(), tick, truth.poses());
        expect_same(hand, view,
                    sweeps::hand_nodes(truth.live().scene.hand, truth.live().hand, view.wrist, view.rotation, view.proxies));
      }
      ASSERT_FALSE(HasFailure()) << "at tick " << n;
    }
    EXPECT_GT(held, 1000);
    wh_session_free(&session);
  }
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// A session through the C face is the session of the program, to the bit.
// sanitizers: address
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <memory>

#include "include/wholehand/wholehand.h"
#include "library/scene.h"
#include "live/hand_view.h"
#include "live/session.h"
#include "live/vessel_tracker.h"
#include "live/workspace.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand {
namespace {

wh_measurement measured(const GripperState& state, std::int64_t tick) {
  wh_measurement in;
  WH_INIT(&in);
  in.tick = tick;
  for (std::size_t k = 0; k < 3; ++k) in.position[k] = state.position[k];
  for (std::size_t k = 0; k < 9; ++k) in.rotation[k] = state.rotation[k];
  in.gap = state.gap;
  in.buttons = state.buttons;
  return in;
}

template <std::size_t N>
bool are_same(const double* c, const std::array<double, N>& cpp) {
  return std::memcmp(c, cpp.data(), sizeof cpp) == 0;
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
    Session truth(scene, gap);
    VesselTracker tracker(truth.live().scene);
    const LiveScript script = script_for(scene);
    Tick tick;
    wh_session_output out;
    wh_hand hand;
    wh_session_vessel vessel;
    WH_INIT(&out);
    WH_INIT(&hand);
    WH_INIT(&vessel);
    const auto ticks = static_cast<std::int64_t>(script.seconds() * script.rate);
    int held = 0;
    for (std::int64_t n = 0; n < ticks; ++n) {
      const GripperState state = script.at(n);
      const wh_measurement in = measured(state, n);
      ASSERT_EQ(wh_session_step(session, &in, &out), WH_OK) << wh_message();
      truth.step(state, n, tick);
      tracker.follow(tick);
      held += is_held(tick.state);
      ASSERT_EQ(static_cast<int>(out.state), static_cast<int>(tick.state)) << n;
      ASSERT_EQ(out.vessel, tick.vessel);
      ASSERT_TRUE(are_same(out.arm_force, tick.wanted.arm)) << n;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(out.grip_force), std::bit_cast<std::uint64_t>(tick.wanted.grip)) << n;
      ASSERT_EQ(out.touch_mask, tick.touch_mask);
      ASSERT_EQ(out.lost, tick.lost);
      ASSERT_EQ(wh_session_vessel_at(session, 0, &vessel), WH_OK);
      ASSERT_TRUE(are_same(vessel.place, tracker.poses()[0].place) && are_same(vessel.rotation, tracker.poses()[0].rotation));
      ASSERT_EQ(vessel.volume, tick.volume[0]);
      if (n % 20 != 0) continue;
      ASSERT_EQ(wh_session_hand(session, &hand), WH_OK);
      const HandView view = hand_view(truth.live(), tick, tracker.poses());
      for (std::size_t j = 0; j < WH_JOINTS; ++j) ASSERT_TRUE(are_same(hand.joints[j], view.proxies[j])) << n << " joint " << j;
    }
    EXPECT_GT(held, 1000);
    wh_session_free(&session);
  }
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// A session as OSC: every frame against the ticks it was made of.
// sanitizers: address
#include "app/viewer/osc_stream.h"
#include "core/joints.h"

#include <gtest/gtest.h>
#include <lo/lo.h>
#include <sys/socket.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "sweeps/grips/hand_nodes.h"
#include "tests/support/files.h"
#include "tests/support/live_script.h"
#include "tests/support/osc_listener.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

std::map<std::string, OscMessage> by_address(const std::vector<OscMessage>& messages) {
  std::map<std::string, OscMessage> found;
  for (const OscMessage& message : messages)
    EXPECT_TRUE(found.emplace(message.address, message).second) << "twice: " << message.address;
  return found;
}

using Turn = std::array<double, 9>;  // row-major
Turn turn_of(const OscMessage& pose) {
  const double x = number(pose, 3), y = number(pose, 4), z = number(pose, 5), w = number(pose, 6);
  EXPECT_NEAR(x * x + y * y + z * z + w * w, 1, 1e-6) << pose.address;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 2 * (x * y + z * w),    1 - 2 * (x * x + z * z),
          2 * (y * z - x * w),     2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)};
}

void expect_place(const OscMessage& pose, const Triple& place) {
  ASSERT_EQ(pose.arguments.size(), 7u) << pose.address;
  for (int k = 0; k < 3; ++k) EXPECT_EQ(number(pose, k), static_cast<float>(place[k])) << pose.address;
}

// -1 for what is infinite, 0 where there is none.
void expect_holding(const OscMessage& message, double truth) {
  EXPECT_EQ(number(message), std::isnan(truth) ? 0 : std::isinf(truth) ? -1 : static_cast<float>(truth)) << message.address;
}

// A frame of which each message is taken once.
struct Frame {
  std::map<std::string, OscMessage> messages;
  OscMessage take(const std::string& address) {
    const auto found = messages.find(address);
    EXPECT_NE(found, messages.end()) << address;
    OscMessage message = found == messages.end() ? OscMessage{address, {}} : found->second;
    messages.erase(address);
    return message;
  }
};

void expect_joints(Frame& frame, const device::HandView& hand) {
  const OscMessage contacts = frame.take("/wholehand/hand/contacts");
  ASSERT_EQ(contacts.arguments.size(), 24u);
  expect_place(frame.take("/wholehand/joint/XR_HAND_JOINT_WRIST_EXT"), hand.wrist);
  for (int f = 0; f < FINGER_COUNT; ++f) {
    for (int k = 0; k < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      const OscMessage joint = frame.take(std::string("/wholehand/joint/") + JOINT_NAMES[j].openxr);
      expect_place(joint, hand.proxies[j]);
      EXPECT_EQ(whole(contacts, j), static_cast<int>(hand.contact[j]));
      const Turn turn = turn_of(joint);
      if (k + 1 == finger_joints(f)) continue;
      // OpenXR: the bone to the next joint runs along -z
      const Triple &from = hand.proxies[j], &to = hand.proxies[j + 1];
      const double length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
      for (int row = 0; row < 3; ++row) EXPECT_NEAR(-turn[3 * row + 2], (to[row] - from[row]) / length, 1e-5) << joint.address;
    }
  }
}

void expect_forces(Frame& frame, const Scene& scene, const device::DisplayMoment& moment) {
  const device::Tick& tick = moment.tick;
  EXPECT_EQ(number(frame.take("/wholehand/force/feedback")), static_cast<float>(tick.feedback));
  EXPECT_EQ(number(frame.take("/wholehand/force/base")), device::is_held(tick.state) ? static_cast<float>(scene.force.base) : 0);
  EXPECT_EQ(number(frame.take("/wholehand/force/normal")), static_cast<float>(tick.normal_force));
  EXPECT_EQ(number(frame.take("/wholehand/force/opening")), static_cast<float>(tick.opening_force));
  EXPECT_EQ(number(frame.take("/wholehand/force/user")), static_cast<float>(tick.user_force));
  const std::optional<device::HandHold>& hold = moment.hand.hold;
  expect_holding(frame.take("/wholehand/force/hold"), hold ? hold->force() : tick.hold_force);
  if (scene.strength) {
    EXPECT_EQ(hold.has_value(), device::is_held(tick.state));
    expect_holding(frame.take("/wholehand/force/tips_hold"), hold ? hold->tips_force() : device::Tick::NONE);
    expect_holding(frame.take("/wholehand/hand/effort"), hold ? hold->effort : device::Tick::NONE);
    expect_holding(frame.take("/wholehand/hand/tips_effort"), hold ? hold->tips : device::Tick::NONE);
  }
  EXPECT_EQ(number(frame.take("/wholehand/force/weight")), static_cast<float>(tick.weight));
  EXPECT_EQ(number(frame.take("/wholehand/force/torque")), static_cast<float>(tick.torque));
}

void expect_frame(const std::map<std::string, OscMessage>& messages, const Scene& scene, const device::DisplayMoment& moment) {
  Frame frame{messages};
  const device::Tick& tick = moment.tick;
  const OscMessage state = frame.take("/wholehand/state");
  EXPECT_EQ(whole(state), static_cast<int>(tick.state));
  EXPECT_EQ(text(state, 1), device::SESSION_STATE_NAMES[static_cast<std::size_t>(tick.state)]);
  EXPECT_EQ(text(frame.take("/wholehand/hand/side")), scene.hand.handedness == Handedness::left ? "left" : "right");
  EXPECT_EQ(number(frame.take("/wholehand/hand/closure")), static_cast<float>(tick.closure));
  EXPECT_EQ(number(frame.take("/wholehand/hand/gap")), static_cast<float>(tick.gap));
  EXPECT_EQ(number(frame.take("/wholehand/hand/tilt")), static_cast<float>(tick.tilt));
  EXPECT_EQ(number(frame.take("/wholehand/hand/flow")), static_cast<float>(tick.flow));
  const OscMessage vessel = frame.take("/wholehand/hand/vessel");
  EXPECT_EQ(whole(vessel), tick.vessel);
  EXPECT_EQ(text(vessel, 1), tick.vessel < 0 ? "" : scene.vessels[static_cast<std::size_t>(tick.vessel)].name);
  expect_joints(frame, moment.hand);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const std::string address = "/wholehand/vessel/" + scene.vessels[v].name;
    const OscMessage pose = frame.take(address + "/pose");
    expect_place(pose, moment.poses[v].place);
    const Turn turn = turn_of(pose);
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(turn[k], moment.poses[v].rotation[k], 1e-6) << address;
    EXPECT_EQ(number(frame.take(address + "/liquid")), static_cast<float>(tick.volume[v]));
  }
  expect_forces(frame, scene, moment);
  const OscMessage amount = frame.take("/wholehand/amount/water");
  EXPECT_EQ(number(amount), static_cast<float>(tick.arrived[0]));
  EXPECT_EQ(number(amount, 1), 200e-6f);
  EXPECT_EQ(number(frame.take("/wholehand/task/spilled")), static_cast<float>(tick.spilled[0]));
  EXPECT_EQ(whole(frame.take("/wholehand/task/guidance")), tick.guidance);
  EXPECT_EQ(whole(frame.take("/wholehand/task/done")), tick.task_done ? 1 : 0);
  EXPECT_EQ(whole(frame.take("/wholehand/end")), tick.number);
  EXPECT_TRUE(frame.messages.empty()) << "not documented: " << frame.messages.begin()->first;
}

// docs/stream.md has a line for each address, names left open.
void expect_documented(const std::vector<OscMessage>& messages, const Scene& scene) {
  const std::string page = file_text(std::string(WHOLEHAND_SOURCE_DIR) + "/docs/stream.md");
  for (const OscMessage& message : messages) {
    std::string address = message.address;
    if (address.rfind("/wholehand/joint/", 0) == 0) address = "/wholehand/joint/JOINT";
    if (address == "/wholehand/amount/water") address = "/wholehand/amount/LIQUID";
    for (const VesselData& vessel : scene.vessels) {
      const std::size_t at = address.find("/" + vessel.name + "/");
      if (at != std::string::npos) address.replace(at + 1, vessel.name.size(), "NAME");
    }
    EXPECT_NE(page.find("| `" + address + "` |"), std::string::npos) << address;
  }
}

TEST(OscStream, FramesSayWhatTheTicksDo) {
  for (const bool is_left : {false, true}) {
    Scene scene = live_scene();
    if (is_left) scene.hand = left_hand();
    if (is_left) scene.strength.emplace();
    PlayedSession played(scene);
    OscListener listener;
    OscStream stream(listener.target(), played.session.live());
    EXPECT_EQ(stream.note(), "");
    std::map<device::SessionState, int> states;
    double poured = 0;
    for (std::int64_t number = 0; number < played.ticks(); number += 97) {
      const device::DisplayMoment moment = played.at(number);
      stream.show(moment);
      const auto messages = listener.frame();
      EXPECT_EQ(listener.frame_, number);
      EXPECT_EQ(listener.time_, static_cast<float>(static_cast<double>(number) / scene.live.rate));
      expect_frame(by_address(messages), scene, moment);
      if (number == 0) expect_documented(messages, scene);
      ++states[moment.tick.state];
      poured = std::max(poured, moment.tick.flow);
      if (HasFailure()) return;
    }
    EXPECT_EQ(states.size(), 6u) << "all but released";
    EXPECT_GT(poured, 0);
  }
}

// What a filter of single numbers needs: of a turn's two quaternions the one that goes on from the frame before.
TEST(OscStream, TurnsDoNotChangeTheirSign) {
  const Scene scene = live_scene();
  PlayedSession played(scene);
  OscListener listener;
  OscStream stream(listener.target(), played.session.live());
  std::map<std::string, OscMessage> before;
  int compared = 0;
  for (std::int64_t number = 0; number < played.ticks(); number += 17) {
    stream.show(played.at(number));
    for (const OscMessage& message : listener.frame()) {
      if (message.arguments.size() != 7) continue;
      const auto then = before.find(message.address);
      if (then != before.end()) {
        float dot = 0;
        for (std::size_t k = 3; k < 7; ++k)
          dot += std::get<float>(message.arguments[k]) * std::get<float>(then->second.arguments[k]);
        ASSERT_GE(dot, 0) << message.address << " at " << number;
        ++compared;
      }
      before[message.address] = message;
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(OscStream, NumbersThatDoNotExistAreNumbersAllTheSame) {
  const Scene scene = live_scene();
  PlayedSession played(scene);
  OscListener listener;
  OscStream stream(listener.target(), played.session.live());
  played.at(0);
  played.tick.hold_force = std::numeric_limits<double>::infinity();
  played.tick.torque = device::Tick::NONE;
  stream.show(played.moment());
  auto messages = by_address(listener.frame());
  EXPECT_EQ(number(messages["/wholehand/force/hold"]), -1) << "no grip holds it";
  EXPECT_EQ(number(messages["/wholehand/force/torque"]), 0);
  played.tick.hold_force = device::Tick::NONE;
  stream.show(played.moment());
  messages = by_address(listener.frame());
  EXPECT_EQ(number(messages["/wholehand/force/hold"]), 0) << "nothing is held";
}

TEST(OscStream, AHandThatHoldsNothingHasNoNumbersOfIt) {
  Scene scene = live_scene();
  scene.strength.emplace();
  PlayedSession played(scene);
  OscListener listener;
  OscStream stream(listener.target(), played.session.live());
  const device::DisplayMoment moment = played.at(0);
  constexpr double INFINITE = std::numeric_limits<double>::infinity();
  const char* const addresses[] = {"/wholehand/force/hold", "/wholehand/force/tips_hold", "/wholehand/hand/effort",
                                   "/wholehand/hand/tips_effort"};
  for (const bool is_holding : {false, true}) {
    if (is_holding) played.hand.hold = device::HandHold{INFINITE, INFINITE, INFINITE, 25, {}};
    stream.show(moment);
    auto messages = by_address(listener.frame());
    for (const char* address : addresses) EXPECT_EQ(number(messages[address]), is_holding ? -1 : 0) << address;
  }
}

}  // namespace
}  // namespace wholehand

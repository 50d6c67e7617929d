// SPDX-License-Identifier: MIT
// A hand over the network: the obeyed sender, the fate of all other datagrams, and that no force is left on any way out. The ticks are
// counted by the tests; only the datagrams are real.
// sanitizers: thread
#include "device/grippers/osc_gripper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "base/system/clock.h"
#include "base/text/error.h"
#include "core/vectors.h"
#include "device/grippers/osc_messages.h"
#include "device/loop/haptic_loop.h"
#include "tests/support/files.h"
#include "tests/support/hex_blocks.h"
#include "tests/support/live_script.h"
#include "tests/support/osc_peer.h"

namespace wholehand::device {
namespace {

GripperState hand_at(double x, double gap = 0.1) {
  GripperState state;
  state.position = {x, 0.1, 0.2};
  state.gap = gap;
  return state;
}

// An open gripper, its peer, and what the loop would read.
struct OscRig {
  explicit OscRig(const std::vector<std::string>& words, const Scene& rig_scene = live_scene())
      : scene(rig_scene), gripper(open_said(scene, peer, words)), port(port_of(gripper->limits().address)) {}

  void send(const std::string& bytes) const { peer.send(bytes, port); }
  ReadOutcome read(std::int64_t tick) { return gripper->read(state, tick); }
  // What was sent is there at once or, on a machine that is busy, soon: reads the same tick until `holds`.
  bool reads_until(std::int64_t tick, const std::function<bool()>& holds) {
    const double end = monotonic_now() + 10;
    do {
      if (read(tick) == ReadOutcome::error) return false;
      if (holds()) return true;
    } while (monotonic_now() < end);
    return false;
  }
  // Sends a state with these buttons as a sign, and reads until it is there: all that was sent before is there then too.
  bool comes_through(std::int64_t tick, std::int64_t sequence, std::uint32_t sign, double x = 0) {
    GripperState signed_state = hand_at(x);
    signed_state.buttons = sign;
    send(osc_state(sequence, signed_state));
    return reads_until(tick, [&] { return state.buttons == sign; });
  }

  Scene scene;
  OscPeer peer;
  std::unique_ptr<Gripper> gripper;
  int port;
  GripperState state;
};

TEST(OscGripper, ItsLimitsAreTheHandsOrThoseOfItsHello) {
  for (const bool is_left : {false, true}) {
    Scene scene = live_scene();
    if (is_left) scene.hand.handedness = Handedness::left;
    const OscRig rig({osc_state(1, hand_at(0))}, scene);
    const GripperLimits& limits = rig.gripper->limits();
    EXPECT_EQ(limits.gap, own_gap(scene.hand));
    EXPECT_EQ(limits.force, PAPER_FORCE);
    EXPECT_EQ(limits.grip, PAPER_GRIP);
    EXPECT_EQ(limits.is_left_handed, is_left);
    EXPECT_TRUE(limits.has_rotation);
    EXPECT_EQ(limits.watchdog, UNKNOWN_WATCHDOG);
    EXPECT_EQ(limits.address, "osc:127.0.0.1:" + std::to_string(rig.port));
  }
  const std::string hello = osc_hello({0.0, 0.0625, 5, 3});
  for (const auto& words : std::vector<std::vector<std::string>>{{hello, osc_state(1, hand_at(0))},
                                                                 {osc_bundle({hello, osc_state(1, hand_at(0))})},
                                                                 {osc_hello({0, 1, 1, 1}), hello, osc_state(1, hand_at(0))}}) {
    const OscRig rig(words);
    EXPECT_EQ(rig.gripper->limits().gap, (std::array<double, 2>{0, 0.0625}));
    EXPECT_EQ(rig.gripper->limits().force, 5);
    EXPECT_EQ(rig.gripper->limits().grip, 3);
  }
}

TEST(OscGripper, AHelloOfASessionAllowsNoMoreForce) {
  OscRig rig({osc_hello({0, 0.0625, 5, 3}), osc_state(1, hand_at(0))});
  rig.send(osc_hello({0, 0.5, 500, 300, static_cast<double>(rig.port)}));
  rig.send(osc_hello({0, 0.5, 5, 3}));
  ASSERT_TRUE(rig.comes_through(0, 2, 7));
  EXPECT_EQ(rig.gripper->limits().force, 5);
  EXPECT_EQ(rig.gripper->limits().grip, 3);
  EXPECT_EQ(rig.gripper->limits().gap[1], 0.0625);
}

// The hello comes after the hand's first state: from then on no force that the hand cannot bear may be sent.
TEST(OscGripper, AHandThatBearsLessThanItSaidIsAFault) {
  for (const auto& numbers : std::vector<std::vector<double>>{{0, 0.1, 11.9, 8}, {0, 0.1, 12, 7.9}}) {
    OscRig rig({osc_state(1, hand_at(0))});
    ASSERT_EQ(rig.read(0), ReadOutcome::value);
    rig.send(osc_hello(numbers));
    EXPECT_FALSE(rig.comes_through(1, 2, 7));
    EXPECT_EQ(rig.read(2), ReadOutcome::error) << "and stays so";
    EXPECT_STREQ(rig.gripper->last_error(), "the hand says in the session that it bears less force");
  }
}

TEST(OscGripper, ALateHelloThatCannotBeReadIsAFaultWhereItIsTheFirst) {
  const std::string cut = osc_hello({0, 0.1, -1, 3});
  OscRig rig({osc_state(1, hand_at(0))});
  rig.send(cut);
  EXPECT_FALSE(rig.comes_through(0, 2, 7));
  EXPECT_STREQ(rig.gripper->last_error(), "a hello of the hand cannot be read");
  OscRig greeted({osc_hello({0, 0.1, 5, 3}), osc_state(1, hand_at(0))});
  greeted.send(cut);
  EXPECT_TRUE(greeted.comes_through(0, 2, 7)) << "what it bears is known";
  EXPECT_EQ(greeted.gripper->notes_for_report().size(), 1u);
}

// If a hand sent a hello, its largest forces are never guessed, even if the hello is unreadable.
TEST(OscGripper, AHelloThatCannotBeReadIsAFailure) {
  const std::string state = osc_state(1, hand_at(0)), good = osc_hello({0, 0.1, 5, 3});
  const std::string no_force = osc_hello({0, 0.1, -1, 3}), cut = good.substr(0, good.size() - 4);
  std::string too_long = osc_bundle({good, state, osc_message("/x", std::string(600, 'i'), std::vector<double>(600, 1))});
  for (const auto& [words, wrong] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{no_force, state}, "a largest force out of range"},
           {{osc_bundle({no_force, state})}, "a largest force out of range"},
           {{osc_bundle({state, no_force})}, "a largest force out of range"},
           {{cut, state}, "arguments of another number or type"},
           {{osc_bundle({"nonsense", good}), state}, "a message without an address"},
           {{no_force, good, state}, "a largest force out of range"},
           {{too_long}, "a datagram that is too long"}}) {
    const OscPeer peer;
    try {
      open_said(live_scene(), peer, words);
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::failure);
      const std::string line = error.what();
      EXPECT_EQ(line.substr(line.find(": ") + 2),
                "the hello of 127.0.0.1 port " + std::to_string(peer.port()) + " cannot be read: " + wrong);
    }
  }
}

// Opens a gripper to which two peers send before the first state.
TEST(OscGripper, TheFirstStateMakesTheHandAndNothingElse) {
  const OscPeer other, hand;
  const std::string bye = osc_message("/wholehand/gripper/bye", "", {}), hello = osc_hello({0, 0.5, 500, 300});
  std::string said;
  const auto gripper = open_osc({"127.0.0.1", 0}, live_scene(), [&](const std::string& line) {
    said = line;
    const std::size_t at = line.find(": waiting");
    if (at == std::string::npos) return;
    const int port = port_of(line.substr(0, at));
    other.send(hello, port);
    other.send(osc_hello({0, 0.5, -1, 300}), port);
    hand.send(bye, port);
    other.send(bye, port);
    hand.send(osc_hello({0, 0.0625, 5, 3}), port);
    hand.send(osc_state(1, hand_at(0)), port);
  });
  EXPECT_EQ(said, gripper->limits().address + ": the hand is 127.0.0.1 port " + std::to_string(hand.port()) +
                      "; its hello says that it bears 5 N at the arm and 3 N on each finger");
  EXPECT_EQ(gripper->limits().gap[1], 0.0625);
  EXPECT_FALSE(gripper->is_done()) << "a bye before is of no session";
  GripperState state;
  EXPECT_EQ(gripper->read(state, 0), ReadOutcome::value);
  ASSERT_TRUE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_TRUE(hand.hear());
  EXPECT_FALSE(other.hear(0.01));
}

// Seconds may pass between the first state and the first tick.
TEST(OscGripper, TheSessionBeginsWhereTheHandIsNow) {
  OscRig rig({osc_state(1, hand_at(0))});
  for (int k = 0; k < 100; ++k) rig.send(osc_state(2 + k, hand_at(0.1 * k)));
  std::atomic<bool> is_over{false};
  std::thread sending([&] {
    for (std::int64_t sequence = 1000; !is_over; ++sequence, pause_for(0.001)) rig.send(osc_state(sequence, hand_at(50)));
  });
  // on a machine that is busy the sender may be silent for the 50 ms: then it is another attempt
  for (int attempt = 0; attempt < 100; ++attempt) {
    rig.gripper->begin();
    if (rig.read(attempt) == ReadOutcome::value) break;
  }
  is_over = true;
  sending.join();
  EXPECT_EQ(rig.state.position[0], 50) << "and not on the way there from what is old";
}

TEST(OscGripper, AHandThatIsGoneWhenTheSessionBeginsIsATimeout) {
  OscRig rig({osc_state(1, hand_at(0))});
  for (int k = 0; k < 20; ++k) rig.send(osc_state(2 + k, hand_at(0)));
  rig.gripper->begin();
  EXPECT_EQ(rig.read(0), ReadOutcome::timeout);
  EXPECT_STREQ(rig.gripper->last_error(), "no new state for 50 ms");
  OscRig left({osc_state(1, hand_at(0))});
  left.send(osc_message("/wholehand/gripper/bye", "", {}));
  left.gripper->begin();
  EXPECT_TRUE(left.gripper->is_done()) << "which is no fault";
}

TEST(OscGripper, TheHandGoesWhereItSays) {
  GripperState truth = hand_at(0.25, 0.0625);
  truth.rotation = product(turned('z', 0.3), turned('x', 1.2));
  OscRig rig({osc_state(1, truth, "iddddddddi")});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  EXPECT_LT(distance(rig.state.position, truth.position), 1e-15);
  EXPECT_EQ(rig.state.gap, truth.gap);
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(rig.state.rotation[k], truth.rotation[k], 1e-14) << k;
  const std::uint32_t first = rig.state.sequence;
  ASSERT_EQ(rig.read(1), ReadOutcome::value);
  EXPECT_NE(rig.state.sequence, first) << "what is between two messages is no stale measurement";
  EXPECT_EQ(rig.state.time, 1e-3);
  // and on to the next, which is there after the longest way at the latest
  GripperState next = truth;
  next.position[0] = 0.3;
  next.buttons = 1;
  rig.send(osc_state(2, next, "iddddddddi"));
  ASSERT_TRUE(rig.reads_until(17, [&] { return rig.state.buttons == 1; }));
  EXPECT_GT(rig.state.position[0], 0.25);
  EXPECT_LT(rig.state.position[0], 0.3);
  ASSERT_EQ(rig.read(67), ReadOutcome::value);
  EXPECT_DOUBLE_EQ(rig.state.position[0], 0.3);
}

TEST(OscGripper, ForcesGoToTheHandWithWhatItWasHeardToSay) {
  OscRig rig({osc_state(41, hand_at(0))});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  Tick tick;
  tick.state = SessionState::touching;
  rig.gripper->show(tick);
  ASSERT_TRUE(rig.gripper->write({{1.5, -0.25, 0.125}, 2.5}));
  const auto first = rig.peer.hear();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->number, 1);
  EXPECT_EQ(first->heard, 41);
  EXPECT_EQ(first->force, (std::array<float, 4>{1.5f, -0.25f, 0.125f, 2.5f}));
  EXPECT_EQ(first->state, static_cast<int>(SessionState::touching));
  ASSERT_TRUE(rig.comes_through(1, 42, 3));
  ASSERT_TRUE(rig.gripper->write({}));
  const auto second = rig.peer.hear();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->number, 2);
  EXPECT_EQ(second->heard, 42);
  EXPECT_TRUE(second->is_zero());
}

// docs/devices.md, "A hand over the network": its bytes, and a line for each address.
TEST(OscGripper, DocumentsExampleIsWhatIsReadAndSent) {
  const auto blocks = hex_blocks("devices.md");
  const auto bytes = [&blocks](const char* name) { return std::string(blocks.at(name).begin(), blocks.at(name).end()); };
  OscRig rig({bytes("state")});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  EXPECT_EQ(rig.state.position, (Triple{0.25, -0.5, 0.125}));
  EXPECT_EQ(rig.state.rotation, NO_ROTATION);
  EXPECT_EQ(rig.state.gap, 0.0625);
  EXPECT_EQ(rig.state.buttons, 1u);
  Tick tick;
  tick.state = SessionState::lift;
  rig.gripper->show(tick);
  std::optional<HeardForce> heard;
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(rig.gripper->write({{0, -1.5, 0}, 2.5}));
    heard = rig.peer.hear();
    ASSERT_TRUE(heard) << k;
  }
  EXPECT_EQ(heard->bytes, bytes("force"));
  const std::string page = file_text(WHOLEHAND_SOURCE_DIR "/docs/devices.md");
  for (const char* address : {osc::HELLO, osc::STATE, osc::BYE, osc::FORCE})
    EXPECT_NE(page.find(std::string("| `") + address + "` |"), std::string::npos) << address;
}

TEST(OscGripper, ForcesGoToThePortThatTheHelloNames) {
  const OscPeer ear;
  OscRig rig({osc_hello({0, 0.1, 12, 8, static_cast<double>(ear.port())}), osc_state(1, hand_at(0))});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  ASSERT_TRUE(rig.gripper->write({{1, 0, 0}, 0}));
  const auto heard = ear.hear();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->force[0], 1);
  EXPECT_EQ(rig.gripper->release(), ReleaseResult::written);
  EXPECT_TRUE(ear.hear()->is_zero());
  EXPECT_FALSE(rig.peer.hear(0.01)) << "only there";
}

TEST(OscGripper, NoForceIsBeyondTheHandsLimits) {
  OscRig rig({osc_hello({0, 0.1, 5, 3}), osc_state(1, hand_at(0))});
  ASSERT_TRUE(rig.gripper->write({{30, 0, -40}, -100}));
  const auto heard = rig.peer.hear();
  ASSERT_TRUE(heard);
  EXPECT_FLOAT_EQ(heard->force[0], 3);
  EXPECT_FLOAT_EQ(heard->force[2], -4) << "the direction is kept";
  EXPECT_EQ(heard->force[3], -3);
  for (const double none : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(rig.gripper->write({{1, none, 0}, 1}));
    EXPECT_STREQ(rig.gripper->last_error(), "a force that is NaN or infinite");
    const auto nothing = rig.peer.hear();
    ASSERT_TRUE(nothing);
    EXPECT_TRUE(nothing->is_zero());
  }
}

TEST(OscGripper, LateAndDoubledStatesAreIgnoredAndCounted) {
  OscRig rig({osc_state(10, hand_at(0))});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  for (const std::int64_t sequence : {10, 9, 1, -5}) rig.send(osc_state(sequence, hand_at(50)));
  ASSERT_TRUE(rig.comes_through(1, 11, 1));
  EXPECT_LT(std::abs(rig.state.position[0]), 1e-12);
  EXPECT_EQ(rig.gripper->notes_for_report(),
            std::vector<std::string>{rig.gripper->limits().address + ": states that came late or twice: 4"});
}

TEST(OscGripper, SequencesGoOnWhereTheyWrap) {
  OscRig rig({osc_state(0x7FFFFFFF, hand_at(0))});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  ASSERT_TRUE(rig.comes_through(1, -0x7FFFFFFF - 1, 1));
  ASSERT_TRUE(rig.comes_through(2, -1, 2));
  ASSERT_TRUE(rig.comes_through(3, 0, 3));
  EXPECT_TRUE(rig.gripper->notes_for_report().empty());
}

TEST(OscGripper, WhatCannotBeReadIsIgnoredAndCounted) {
  OscRig rig({"nonsense", osc_state(1, hand_at(0))});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  const std::string good = osc_state(5, hand_at(50));
  rig.send(good.substr(0, good.size() - 4));
  rig.send(osc_state(5, hand_at(1000)));
  rig.send(osc_message("/wholehand/gripper/state", "iff", {5, 1, 2}));
  rig.send(std::string(5000, 'x'));
  rig.send(osc_message("/another/program", "f", {1}));  // which is none of them
  rig.send("");
  ASSERT_TRUE(rig.comes_through(1, 2, 1));
  EXPECT_LT(std::abs(rig.state.position[0]), 1e-12);
  const std::vector<std::string> notes = rig.gripper->notes_for_report();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], rig.gripper->limits().address +
                          ": datagrams that could not be read: 6, the first of them: a message without an address");
}

TEST(OscGripper, OnlyTheFirstIsObeyed) {
  OscRig rig({osc_state(1, hand_at(0))});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  EXPECT_FALSE(rig.gripper->take_warning());
  const OscPeer second;
  second.send(osc_state(1000, hand_at(50)), rig.port);
  second.send(osc_message("/wholehand/gripper/bye", "", {}), rig.port);
  ASSERT_TRUE(rig.comes_through(1, 2, 1));
  std::optional<std::string> warning;
  ASSERT_TRUE(rig.reads_until(1, [&] {
    if (!warning) warning = rig.gripper->take_warning();
    return warning.has_value() && !rig.gripper->notes_for_report().empty();
  }));
  EXPECT_EQ(*warning, rig.gripper->limits().address + ": 127.0.0.1 port " + std::to_string(second.port()) +
                          " sends too, and is not obeyed: the hand is 127.0.0.1 port " + std::to_string(rig.peer.port()) +
                          ", which came first");
  EXPECT_FALSE(rig.gripper->take_warning()) << "once";
  EXPECT_LT(std::abs(rig.state.position[0]), 1e-12);
  EXPECT_FALSE(rig.gripper->is_done());
  ASSERT_TRUE(rig.gripper->write({{1, 0, 0}, 0}));
  EXPECT_TRUE(rig.peer.hear());
  EXPECT_FALSE(second.hear(0.01));
}

// Another thread asks meanwhile, and a third takes the force away.
TEST(OscGripper, OtherThreadsMayAskAndLetGo) {
  OscRig rig({osc_state(1, hand_at(0))});
  const OscPeer second;
  std::atomic<bool> is_over{false};
  std::atomic<int> warnings{0};
  std::thread asking([&] {
    while (!is_over) {
      warnings += rig.gripper->take_warning().has_value();
      rig.gripper->notes_for_report();
    }
    warnings += rig.gripper->take_warning().has_value();
  });
  std::thread letting_go([&] {
    while (!is_over) EXPECT_EQ(rig.gripper->release_from_watchdog(), ReleaseResult::written);
  });
  for (std::int64_t tick = 0; tick < 2000; ++tick) {
    if (tick % 10 == 0) rig.send(osc_state(2 + tick, hand_at(0)));
    if (tick % 100 == 0) second.send("nonsense", rig.port);
    rig.read(tick);
    EXPECT_TRUE(rig.gripper->write({{1, 0, 0}, 0}));
  }
  ASSERT_TRUE(rig.comes_through(2000, 5000, 1));
  is_over = true;
  asking.join();
  letting_go.join();
  EXPECT_EQ(warnings, 1);
}

TEST(OscGripper, SilenceOf50MillisecondsIsATimeout) {
  OscRig rig({osc_state(1, hand_at(0))});
  for (std::int64_t tick = 0; tick <= 50; ++tick) ASSERT_EQ(rig.read(tick), ReadOutcome::value) << tick;
  const GripperState before = rig.state;
  EXPECT_EQ(rig.read(51), ReadOutcome::timeout);
  EXPECT_STREQ(rig.gripper->last_error(), "no new state for 50 ms");
  EXPECT_EQ(rig.state.sequence, before.sequence) << "left alone";
}

// Neither unreadable messages, nor repeated ones, nor other senders keep a session alive.
TEST(OscGripper, OnlyANewStateEndsTheSilence) {
  OscRig rig({osc_state(1, hand_at(0))});
  const OscPeer second;
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  for (std::int64_t tick = 1; tick <= 51; ++tick) {
    rig.send("nonsense");
    rig.send(osc_state(1, hand_at(0)));
    rig.send(osc_hello({0, 0.1, 12, 8}));
    second.send(osc_state(100 + tick, hand_at(0)), rig.port);
    ASSERT_EQ(rig.read(tick), tick <= 50 ? ReadOutcome::value : ReadOutcome::timeout) << tick;
  }
  // all of it came: a new state as a sign, and the counts
  ASSERT_TRUE(rig.comes_through(52, 2, 1));
  const std::string place = rig.gripper->limits().address;
  ASSERT_TRUE(rig.reads_until(
      52, [&] { return rig.gripper->notes_for_report().back() == place + ": datagrams of others than the hand: 51"; }));
  EXPECT_EQ(rig.gripper->notes_for_report(),
            (std::vector<std::string>{
                place + ": datagrams that could not be read: 51, the first of them: a message without an address",
                place + ": states that came late or twice: 51", place + ": datagrams of others than the hand: 51"}));
}

// A good state after a NaN in the same tick does not hide the NaN.
TEST(OscGripper, ANaNIsNotOvertaken) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const bool is_bundle : {false, true}) {
    OscRig rig({osc_state(1, hand_at(0))});
    const std::string wrong = osc_state(2, hand_at(none)), good = osc_state(3, hand_at(0));
    if (is_bundle) {
      rig.send(osc_bundle({wrong, good}));
    } else {
      rig.send(wrong);
      rig.send(good);
    }
    ASSERT_TRUE(rig.reads_until(0, [&] { return std::isnan(rig.state.position[0]); })) << is_bundle;
    rig.send(osc_state(4, hand_at(0)));
    ASSERT_EQ(rig.read(1), ReadOutcome::value);
    EXPECT_TRUE(std::isnan(rig.state.position[0]));
  }
}

// Runs a whole session, without a clock. Ticks are then quick, and a busy machine may deliver a datagram many ticks later, so a missing hand gets
// half a second of patience.
LoopReport run_session(OscRig& rig, double seconds, const std::function<void(std::int64_t)>& before) {
  class Fed final : public Gripper {
   public:
    Fed(OscRig& fed_rig, std::function<void(std::int64_t)> fed_before) : rig_(fed_rig), before_(std::move(fed_before)) {}
    const GripperLimits& limits() const noexcept override { return rig_.gripper->limits(); }
    ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
      before_(tick);
      ReadOutcome outcome = rig_.gripper->read(state, tick);
      for (int k = 0; k < 50 && outcome == ReadOutcome::timeout; ++k) {
        pause_for(0.01);
        outcome = rig_.gripper->read(state, tick);
      }
      return outcome;
    }
    bool write(const GripperForce& force) noexcept override { return rig_.gripper->write(force); }
    ReleaseResult release() noexcept override { return rig_.gripper->release(); }
    const char* last_error() const noexcept override { return rig_.gripper->last_error(); }
    bool is_done() const noexcept override { return rig_.gripper->is_done(); }
    void show(const Tick& tick) noexcept override { rig_.gripper->show(tick); }

   private:
    OscRig& rig_;
    std::function<void(std::int64_t)> before_;
  } fed(rig, before);
  Session session(rig.scene, rig.gripper->limits().gap);
  LoopOptions options;
  options.seconds = seconds;
  options.is_simulated = true;
  HapticLoop loop(rig.scene.live, fed, session, {}, options);
  const std::atomic<bool> stop{false};
  loop.run(stop);
  return loop.report();
}

TEST(OscGripper, WhateverIsWrongEndsInNoForce) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  GripperState no_place = hand_at(none), no_gap = hand_at(0, none), jump = hand_at(2);
  const struct {
    std::string bytes;
    Fault fault;
  } cases[] = {
      {osc_state(1000, no_place), Fault::not_finite},
      {osc_state(1000, no_gap), Fault::not_finite},
      {osc_message("/wholehand/gripper/state", STATE_TYPES, {1000, 0, 0, 0, 0, 0, 0, 0.5, 0.1, 0}), Fault::not_finite},
      {osc_state(1000, jump), Fault::jump},
      {"", Fault::timeout},
  };
  for (const auto& [bytes, fault] : cases) {
    OscRig rig({osc_state(1, hand_at(0))});
    const LoopReport report = run_session(rig, 1, [&, &said_last = bytes](std::int64_t tick) {
      if (tick < 100 && tick % 10 == 0) rig.send(osc_state(2 + tick, hand_at(0)));
      if (tick == 100) rig.send(said_last);
    });
    EXPECT_EQ(report.fault, fault) << FAULT_NAMES[static_cast<std::size_t>(report.fault)] << report.error;
    EXPECT_LT(report.last.number, 160);
    EXPECT_EQ(report.release, ReleaseResult::written);
    const HeardForce last = rig.peer.hear_until([](const HeardForce& heard) { return heard.number == 0; });
    EXPECT_TRUE(last.is_zero());
    EXPECT_EQ(last.state, static_cast<int>(SessionState::released));
  }
}

// The largest force at the fingers where the loop sees every millisecond of the script.
double largest_grip(const Scene& scene, const LiveScript& script) {
  Session session(scene, own_gap(scene.hand));
  GripperLimits limits;
  limits.force = PAPER_FORCE;
  limits.grip = PAPER_GRIP;
  Guard guard(scene.live, limits);
  Tick tick;
  double most = 0;
  for (std::int64_t number = 0; number < script.seconds() * script.rate; ++number) {
    session.step(script.at(number), number, tick);
    most = std::max(most, guard.limit(tick.wanted, number).grip);
  }
  return most;
}

TEST(OscGripper, ABeakerIsGraspedBySixtyStatesASecond) {
  for (const int rate : {60, 90, 240}) {
    const Scene scene = live_scene();
    LiveScript script;
    script.vessel = scene.vessels[0].place;
    OscRig rig({osc_state(1, script.at(0))}, scene);
    double next = 0;
    std::int32_t sequence = 1;
    float most = 0;
    std::set<int> states;
    const LoopReport report = run_session(rig, script.seconds() + 0.2, [&](std::int64_t tick) {
      while (const auto heard = rig.peer.hear(0)) {
        most = std::max(most, heard->force[3]);
        states.insert(heard->state);
      }
      const double time = static_cast<double>(tick) * 1e-3;
      if (time < next) return;
      rig.send(osc_state(++sequence, script.at(tick)));
      next += 1.0 / rate;
    });
    EXPECT_EQ(report.fault, Fault::none) << rate << report.error;
    EXPECT_EQ(report.last.grasps, 1) << rate;
    // which closes and tilts slowly: what the hand is behind changes little
    EXPECT_NEAR(most, largest_grip(scene, script), 0.02 * PAPER_GRIP) << rate;
    for (const SessionState state :
         {SessionState::free, SessionState::lift, SessionState::tilt, SessionState::maintain, SessionState::slipped})
      EXPECT_TRUE(states.count(static_cast<int>(state))) << rate << SESSION_STATE_NAMES[static_cast<std::size_t>(state)];
  }
}

// A jump that interpolation would turn into an allowed motion: it spreads the step over the longest of some intervals, one of which
// was long.
TEST(OscGripper, AJumpIsHandedOnAsOneStep) {
  OscRig rig({osc_state(1, hand_at(0))});
  ASSERT_EQ(rig.read(0), ReadOutcome::value);
  std::uint32_t sign = 0;
  for (std::int64_t tick = 10; tick <= 290; tick += 10)
    if (tick != 250) {
      ASSERT_TRUE(rig.comes_through(tick, 10 + tick, ++sign));
    }
  // 20 ms were between two messages: 0.08 m within them are 4 m/s, and within 10 ms more than 5
  ASSERT_TRUE(rig.comes_through(300, 1000, ++sign, 0.08));
  EXPECT_FLOAT_EQ(static_cast<float>(rig.state.position[0]), 0.08f);
  ASSERT_TRUE(rig.comes_through(310, 1010, ++sign, 0.08 + 0.04));
  EXPECT_LT(rig.state.position[0], 0.1) << "4 m/s, which is allowed, is a motion";
}

TEST(OscGripper, AByeEndsTheSessionWithoutAFault) {
  OscRig rig({osc_state(1, hand_at(0))});
  const LoopReport report = run_session(rig, 1, [&](std::int64_t tick) {
    if (tick % 10 == 0) rig.send(osc_state(2 + tick, hand_at(0)));
    if (tick == 50) rig.send(osc_message("/wholehand/gripper/bye", "", {}));
  });
  EXPECT_EQ(report.fault, Fault::none) << report.error;
  EXPECT_LT(report.last.number, 1000);
  EXPECT_TRUE(rig.peer.hear_until([](const HeardForce& heard) { return heard.number == 0; }).is_zero());
}

TEST(OscGripper, EveryWayOutSendsZero) {
  const auto start = [](OscRig& rig) {
    ASSERT_EQ(rig.read(0), ReadOutcome::value);
    ASSERT_TRUE(rig.gripper->write({{1, 2, 3}, 4}));
    const auto heard = rig.peer.hear();
    ASSERT_TRUE(heard);
    ASSERT_FALSE(heard->is_zero());
  };
  // a network may lose a message: the last is sent several times
  const auto expect_zero = [](OscRig& rig, int state, int times) {
    for (int k = 0; k < times; ++k) {
      const auto heard = rig.peer.hear();
      ASSERT_TRUE(heard) << k;
      EXPECT_TRUE(heard->is_zero());
      EXPECT_EQ(heard->number, 0);
      EXPECT_EQ(heard->state, state);
    }
    EXPECT_FALSE(rig.peer.hear(0.01));
  };
  {
    OscRig rig({osc_state(1, hand_at(0))});
    start(rig);
    EXPECT_EQ(rig.gripper->release(), ReleaseResult::written);
    expect_zero(rig, 6, 3);
  }
  {
    OscRig rig({osc_state(1, hand_at(0))});
    start(rig);
    rig.gripper.reset();
    expect_zero(rig, 6, 3);
  }
  {
    OscRig rig({osc_state(1, hand_at(0))});
    start(rig);
    EXPECT_EQ(rig.gripper->release_from_watchdog(), ReleaseResult::written);
    expect_zero(rig, -1, 1);
    EXPECT_TRUE(rig.gripper->write({{1, 2, 3}, 4})) << "a session goes on after the second thread's";
    EXPECT_FALSE(rig.peer.hear()->is_zero());
    EXPECT_EQ(rig.gripper->panic(), ReleaseResult::written);
    expect_zero(rig, 6, 3);
    EXPECT_TRUE(rig.gripper->write({{1, 2, 3}, 4}));
    EXPECT_TRUE(rig.peer.hear()->is_zero()) << "after a panic there is no force";
  }
}

void expect_failure(const std::function<void()>& action, const std::string& start) {
  try {
    action();
    ADD_FAILURE() << "no error where this was due: " << start;
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure) << error.what();
    EXPECT_TRUE(std::string(error.what()).starts_with(start)) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST(OscGripper, AHandThatDoesNotComeIsAFailureInOneLine) {
  const Scene scene = live_scene();
  const OscPeer peer;
  const auto open = [&](const std::vector<std::string>& words) { return [&, words] { open_said(scene, peer, words, 0.05); }; };
  expect_failure(open({}), "osc:127.0.0.1:");
  const auto message_of = [&](const std::vector<std::string>& words, double patience) -> std::string {
    try {
      open_said(scene, peer, words, patience);
    } catch (const Error& error) {
      const std::string line = error.what();
      return line.substr(line.find(": ") + 2);
    }
    return "";
  };
  EXPECT_EQ(message_of({}, 0.05), "no /wholehand/gripper/state came within 0.05 s");
  const std::string sender = "127.0.0.1 port " + std::to_string(peer.port());
  EXPECT_EQ(message_of({osc_hello({0, 0.1, 12, 8})}, 0.5),
            "no /wholehand/gripper/state came within 0.5 s; " + sender + " sent something else");
  EXPECT_EQ(message_of({osc_message("/wholehand/gripper/bye", "", {})}, 0.5),
            "no /wholehand/gripper/state came within 0.5 s; " + sender + " sent something else");
  EXPECT_EQ(
      message_of({"/ab", osc_message("/wholehand/gripper/state", "f", {1})}, 0.5),
      "no /wholehand/gripper/state came within 0.5 s; " + sender +
          " sent something else; datagrams that could not be read: 2, the first of them: a length that is not a multiple of 4 "
          "bytes");
}

TEST(OscGripper, APortOrAnAddressThatCannotBeUsedIsAFailureInOneLine) {
  const Scene scene = live_scene();
  const OscPeer taken;
  const auto silent = [](const std::string&) {};
  const std::string place = "osc:127.0.0.1:" + std::to_string(taken.port());
  expect_failure(
      [&] {
        open_osc({"127.0.0.1", taken.port()}, scene, silent, 0.05);
      },
      place + ": the port is in use, by another session perhaps; give another port");
  const OscPeer peer;
  EXPECT_NE(open_said(scene, peer, {osc_state(1, hand_at(0))}), nullptr) << "at another port";
  expect_failure(
      [&] {
        open_osc({"192.0.2.7", 9000}, scene, silent, 0.05);
      },
      "osc:192.0.2.7:9000: this machine cannot listen there: ");
  expect_failure([&] { open_osc({"a..b", 9000}, scene, silent, 0.05); }, "osc: host 'a..b' is not found: ");
}

TEST(OscGripper, AnAddressThatOthersReachIsSaidAndRemarked) {
  const Scene scene = live_scene();
  const OscPeer peer;
  std::vector<std::string> lines;
  const auto gripper = open_osc({"0.0.0.0", 0}, scene, [&](const std::string& line) {
    lines.push_back(line);
    const std::size_t at = line.find(": waiting for a hand, 10 s at most");
    if (at != std::string::npos) peer.send(osc_state(1, hand_at(0)), port_of(line.substr(0, at)));
  });
  const std::string place = "osc:0.0.0.0:" + std::to_string(port_of(gripper->limits().address));
  const std::string open = place + ": whoever reaches this port first is the hand, and the forces go there unencrypted";
  EXPECT_EQ(lines, (std::vector<std::string>{open, place + ": waiting for a hand, 10 s at most",
                                             place + ": the hand is 127.0.0.1 port " + std::to_string(peer.port()) +
                                                 ", without a hello; so it has to bear 12 N at the arm and 8 N on each finger"}));
  EXPECT_EQ(gripper->notes_for_report(), std::vector<std::string>{open});
}

}  // namespace
}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// A hand reports its place some dozen times a second, and the loop sees it a thousand times a second: never faster than the hand, never ahead of it,
// and no further behind than the interval between packets.
// sanitizers: address
#include "device/grippers/packet_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "base/numbers/random_bits.h"
#include "core/vectors.h"
#include "device/loop/guard.h"
#include "tests/support/live_script.h"

namespace wholehand::device {
namespace {

constexpr double PACKET_RATE = 1000;  // Hz, of the loop
constexpr double PACKET_TICK = 1 / PACKET_RATE;

struct Packet {
  double made = 0;        // s
  std::int64_t tick = 0;  // in which it is there
};

// Evenly, each there in the first tick after it was made.
std::vector<Packet> even_packets(double rate, double seconds) {
  std::vector<Packet> packets;
  for (int k = 0; k < seconds * rate; ++k)
    packets.push_back({k / rate, static_cast<std::int64_t>(std::ceil(k / rate * PACKET_RATE - 1e-9))});
  return packets;
}

// Each is made up to half an interval late, and comes up to `jitter` later, never before the one before it; one in ten is lost, but not
// two in a row.
std::vector<Packet> rough_packets(double rate, double seconds, double jitter, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto share = [&random] { return unit_interval(random()); };
  std::vector<Packet> packets;
  bool was_lost = false;
  for (int k = 0; k < seconds * rate; ++k) {
    const double made = (k + 0.5 * share()) / rate, there = made + jitter * share();
    was_lost = !was_lost && k > 0 && share() < 0.1;
    if (was_lost) continue;
    const auto tick = static_cast<std::int64_t>(std::ceil(there * PACKET_RATE));
    packets.push_back({made, packets.empty() ? tick : std::max(tick, packets.back().tick)});
  }
  return packets;
}

// A reach there and back, with rests, each way in 0.4 s; the largest speed is that of 3 s^2 - 2 s^3 in the middle.
constexpr double REACH = 0.6, REACH_SPEED = 1.5 * REACH / 0.4;  // m, m/s
double reach(double time) { return REACH * (ease(time, 0.5, 0.9) - ease(time, 1.2, 1.6)); }

GripperState reaching(double time) {
  GripperState state;
  state.position = {0.1 + reach(time), 0.2 - 0.5 * reach(time), 0.05};
  state.gap = 0.12 - 0.08 * ease(time, 0.9, 1.1);
  state.rotation = turned('y', 2 * reach(time));
  state.buttons = time > 1 ? 1 : 0;
  return state;
}

// What the loop sees at each tick, the newest of each tick's packets counting.
template <class Truth>
std::vector<GripperState> seen(const std::vector<Packet>& packets, const Truth& truth, double seconds) {
  PacketMotion motion(PACKET_RATE);
  std::vector<GripperState> states;
  std::size_t next = 0;
  for (std::int64_t tick = packets.front().tick; tick < seconds * PACKET_RATE; ++tick) {
    const std::size_t before = next;
    while (next < packets.size() && packets[next].tick <= tick) ++next;
    if (next > before) {
      const GripperState state = truth(packets[next - 1].made);
      if (before == 0)
        motion.start(state, tick);
      else
        motion.aim(state, tick);
    }
    motion.move(states.emplace_back(), tick);
  }
  return states;
}

double fastest(const std::vector<GripperState>& states) {
  double most = 0;
  for (std::size_t k = 1; k < states.size(); ++k)
    most = std::max(most, distance(states[k].position, states[k - 1].position) * PACKET_RATE);
  return most;
}

// The guard's verdict on the states; Fault::none: they all pass.
Fault judged(std::vector<GripperState> states) {
  Guard guard(LiveData{}, GripperLimits{});
  for (std::size_t k = 0; k < states.size(); ++k) {
    states[k].sequence = static_cast<std::uint32_t>(k + 1);
    const Fault fault = guard.check(ReadOutcome::value, states[k], static_cast<std::int64_t>(k));
    if (fault != Fault::none) return fault;
  }
  return Fault::none;
}

// A move of constant speed, once the first interval, which is not known, is forgotten: at that speed, between one and two intervals behind.
TEST(PacketMotion, AnEvenMoveIsFollowedEvenlyOneIntervalBehind) {
  constexpr double SPEED = 0.8, SETTLED = 1.5;
  const auto truth = [](double time) {
    GripperState state;
    state.position = {SPEED * time, 0, 0};
    return state;
  };
  for (const double rate : {30.0, 60.0, 72.0, 90.0, 120.0, 240.0, 500.0, 1000.0}) {
    const auto states = seen(even_packets(rate, 3), truth, 2.9);
    const double interval = std::ceil(PACKET_RATE / rate - 1e-9) * PACKET_TICK;  // the longest, in whole ticks
    for (auto tick = static_cast<std::size_t>(SETTLED * PACKET_RATE); tick < states.size(); ++tick) {
      const double speed = (states[tick].position[0] - states[tick - 1].position[0]) * PACKET_RATE;
      // packets are there in whole ticks, so that an interval is a tick longer than another: of one of T, 1 in T ticks
      const double uneven = 2 * PACKET_TICK / interval;
      ASSERT_NEAR(speed / SPEED, 1, rate == 1000 ? 1e-9 : uneven) << rate << ' ' << tick;
      const double behind = static_cast<double>(tick) * PACKET_TICK - states[tick].position[0] / SPEED;
      ASSERT_LE(behind, 2 * interval + 1e-9) << rate << ' ' << tick;
      ASSERT_GE(behind, -1e-9) << rate;
    }
  }
}

TEST(PacketMotion, ASenderAsFastAsTheLoopIsFollowedAtOnce) {
  const auto states = seen(even_packets(PACKET_RATE, 3), reaching, 2.9);
  for (std::size_t tick = 1000; tick < states.size(); ++tick)
    ASSERT_LT(distance(states[tick].position, reaching(static_cast<double>(tick) * PACKET_TICK).position), 1e-12) << tick;
}

// The motion never goes beyond the last measurement, nor back before the one before it.
TEST(PacketMotion, NothingIsExtrapolated) {
  for (const double rate : {60.0, 90.0, 240.0}) {
    const auto states = seen(even_packets(rate, 0.9), reaching, 0.95);
    double before = states[0].position[0];
    for (const GripperState& state : states) {
      ASSERT_GE(state.position[0], before - 1e-15) << "there without a way back";
      before = state.position[0];
    }
    EXPECT_LE(before, 0.1 + REACH + 1e-12);
  }
}

// A quick reach at the rates of engines, with long frames, packets in bunches, and lost packets: the guard must let it pass. It would not if the hand
// stood still between packets.
TEST(PacketMotion, TheStepsOfAnEngineAreNoJumpsForTheGuard) {
  for (const double rate : {60.0, 90.0, 240.0}) {
    double most = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      const auto packets = rough_packets(rate, 2.2, 0.8 / rate, seed);
      const auto states = seen(packets, reaching, 2.1);
      ASSERT_EQ(judged(states), Fault::none) << rate << " Hz, seed " << seed;
      most = std::max(most, fastest(states));
      const Triple end = reaching(2.1).position;
      // half a second after it, of 0.6 m: at 60 Hz 30 intervals, each a third of the span at least, as no three of them are one gap
      ASSERT_LT(distance(states.back().position, end), 1e-5) << "it arrives";
    }
    const double speed = std::sqrt(1.25) * REACH_SPEED;
    EXPECT_LT(most, 2 * speed) << rate;
    EXPECT_GT(most, 0.9 * speed) << "the reach is there";
    std::vector<GripperState> held;
    for (int tick = 0; tick < 1000; ++tick) held.push_back(reaching(std::floor(tick * PACKET_TICK * rate) / rate));
    EXPECT_EQ(judged(held), Fault::jump) << "what this test would see";
  }
}

// A bunch of packets after the longest allowed silence, from a sender that is otherwise quick.
TEST(PacketMotion, ABunchAfterAPauseIsNotRunThrough) {
  for (const double rate : {60.0, 240.0, 1000.0}) {
    auto packets = even_packets(rate, 2.2);
    for (Packet& packet : packets)
      if (packet.tick > 680 && packet.tick < 725) packet.tick = 725;  // in the middle of the reach
    const auto states = seen(packets, reaching, 2.1);
    EXPECT_EQ(judged(states), Fault::none) << rate;
    EXPECT_LT(fastest(states), 2 * std::sqrt(1.25) * REACH_SPEED) << rate;
  }
}

TEST(PacketMotion, ATeleportIsAJump) {
  for (const double rate : {60.0, 90.0, 240.0}) {
    const auto teleport = [](double time) {
      GripperState state;
      state.position = {time < 1 ? 0 : 0.5, 0, 0};
      return state;
    };
    EXPECT_EQ(judged(seen(even_packets(rate, 2), teleport, 1.9)), Fault::jump) << rate;
  }
}

// Whether PacketSteps allows every step of the sender. It judges each state, not only the newest of a tick.
template <class Truth>
bool are_allowed(const std::vector<Packet>& packets, const Truth& truth) {
  PacketSteps steps(PACKET_RATE, LiveData{}.jump, JUMP_TURN);
  steps.start(truth(packets[0].made), packets[0].tick);
  bool holds = true;
  for (std::size_t k = 1; k < packets.size(); ++k) holds = steps.allows(truth(packets[k].made), packets[k].tick) && holds;
  return holds;
}

TEST(PacketSteps, AQuickReachIsNoJump) {
  for (const double rate : {30.0, 60.0, 90.0, 240.0, 1000.0}) {
    EXPECT_TRUE(are_allowed(even_packets(rate, 2.2), reaching)) << rate;
    for (std::uint64_t seed = 1; seed <= 200; ++seed)
      ASSERT_TRUE(are_allowed(rough_packets(rate, 2.2, 0.8 / rate, seed), reaching)) << rate << " Hz, seed " << seed;
  }
}

// The bunch arrives in two ticks, half in each.
TEST(PacketSteps, ABunchAfterAPauseIsNoJump) {
  for (const double rate : {60.0, 240.0, 1000.0}) {
    auto packets = even_packets(rate, 2.2);
    for (Packet& packet : packets)
      if (packet.tick > 680 && packet.tick < 725) packet.tick = packet.tick < 702 ? 725 : 726;  // in the middle of the reach
    EXPECT_TRUE(are_allowed(packets, reaching)) << rate;
  }
}

// A hand at rest that is suddenly elsewhere, at any rate; also some packets after a lost one, when the way to the newest measurement takes two
// intervals. The allowed motion is a fifth less than the first size, and more than the second.
TEST(PacketSteps, ATeleportIsAJumpAlsoAfterALoss) {
  for (const double rate : {30.0, 60.0, 90.0, 240.0}) {
    for (const int lost : {0, 1}) {
      auto packets = even_packets(rate, 2);
      const auto of_jump = static_cast<std::size_t>(rate);
      const double moment = packets[of_jump].made;
      if (lost) packets.erase(packets.begin() + static_cast<std::ptrdiff_t>(of_jump) - 4);
      // of 16 intervals one is twice as long; in whole ticks an interval may be a tick longer, and a tick more is allowed
      const double seconds = (16.0 + lost) / 16 / rate + 2 * PACKET_TICK;
      const auto moved = [&](double place, double gap, double angle) {
        return are_allowed(packets, [=](double time) {
          GripperState state;
          if (time < moment) return state;
          state.position[1] += place;
          state.gap += gap;
          state.rotation = turned('x', angle);
          return state;
        });
      };
      const double most = 1.2 * LiveData{}.jump * seconds, less = 0.5 * LiveData{}.jump * seconds;
      EXPECT_FALSE(moved(most, 0, 0)) << rate << ' ' << lost;
      EXPECT_FALSE(moved(0, most, 0)) << rate << ' ' << lost;
      EXPECT_TRUE(moved(less, less, 0)) << rate << ' ' << lost;
      // angles by the length of their difference, which is 2 sin(angle / 2) and never more than 2
      if (rate > 60) {
        EXPECT_FALSE(moved(0, 0, 3)) << rate << ' ' << lost;
      }
      EXPECT_TRUE(moved(0, 0, 0.5 * JUMP_TURN / rate / 2)) << rate << ' ' << lost;
    }
  }
}

TEST(PacketMotion, TurnsTheShortWayAndStaysARotation) {
  const auto spun = [](double time) {
    GripperState state;
    state.rotation = product(turned('x', 0.4), turned('z', 7 * time));  // several rounds: its quaternion changes its sign
    return state;
  };
  const auto states = seen(even_packets(60, 3), spun, 2.9);
  EXPECT_EQ(judged(states), Fault::none);
  for (std::size_t tick = 1500; tick < states.size(); ++tick) {
    // between one and two intervals behind, in an even turn
    double least = 10;
    for (double behind = 0; behind <= 2.0 / 60 + 2 * PACKET_TICK; behind += PACKET_TICK / 4) {
      const Rotation truth = spun(static_cast<double>(tick) * PACKET_TICK - behind).rotation;
      double apart = 0;
      for (int k = 0; k < 9; ++k) apart = std::max(apart, std::abs(truth[k] - states[tick].rotation[k]));
      least = std::min(least, apart);
    }
    ASSERT_LT(least, 7 * PACKET_TICK / 4) << tick;
  }
}

TEST(PacketMotion, ButtonsCountAtOnce) {
  PacketMotion motion(PACKET_RATE);
  GripperState state, seen_now;
  motion.start(state, 0);
  state.buttons = 5;
  state.gap = 0.1;
  motion.move(seen_now, 15);
  motion.aim(state, 16);
  motion.move(seen_now, 16);
  EXPECT_EQ(seen_now.buttons, 5u);
  EXPECT_LE(seen_now.gap, 0.1 / 16) << "of 16 ticks or more the first";
}

// Ticks that the loop missed are time that passed: the motion is then where it would have been.
TEST(PacketMotion, MissedTicksChangeNothing) {
  PacketMotion all(PACKET_RATE), some(PACKET_RATE);
  for (PacketMotion* motion : {&all, &some}) motion->start(reaching(0.6), 0);
  GripperState of_all, of_some;
  for (std::int64_t tick = 1; tick <= 60; ++tick) {
    const bool is_missed = tick > 21 && tick < 30;
    for (PacketMotion* motion : {&all, &some}) {
      if (motion == &some && is_missed) continue;
      if (tick == 20) motion->aim(reaching(0.62), tick);
      motion->move(motion == &all ? of_all : of_some, tick);
    }
    if (is_missed) continue;
    ASSERT_LT(distance(of_all.position, of_some.position), 1e-15) << tick;
    ASSERT_DOUBLE_EQ(all.silence(tick), some.silence(tick));
  }
  EXPECT_DOUBLE_EQ(all.silence(60), 0.04);
}

}  // namespace
}  // namespace wholehand::device

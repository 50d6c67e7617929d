// SPDX-License-Identifier: MIT
// The guard: each fault injected, each limit checked tick by tick against its own definition.
// sanitizers: address
#include "device/loop/guard.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "tests/support/scenes.h"
#include "tests/support/special_values.h"

namespace wholehand::device {
namespace {

// Rounding of a few products and sums of forces of some newtons.
constexpr double ROUNDING = 1e-12;

GripperLimits limits_of(double force, double grip) {
  GripperLimits limits;
  limits.force = force;
  limits.grip = grip;
  limits.gap = {0, 25e-3};
  limits.rate = 1000;
  return limits;
}

GripperState state_at(std::uint32_t sequence) {
  GripperState state;
  state.position = {0.1, 0.2, 0.3};
  state.gap = 0.02;
  state.sequence = sequence;
  return state;
}

Rotation turned_about_y(double angle) {
  return {std::cos(angle), 0, std::sin(angle), 0, 1, 0, -std::sin(angle), 0, std::cos(angle)};
}

// ---- faults ----

TEST(Guard, LetsAGoodMeasurementPass) {
  Guard guard(LiveData{}, limits_of(12, 8));
  for (std::uint32_t n = 0; n < 10; ++n) EXPECT_EQ(guard.check(ReadOutcome::value, state_at(n), n), Fault::none);
}

TEST(Guard, TellsReadErrorsAndTimeouts) {
  Guard guard(LiveData{}, limits_of(12, 8));
  EXPECT_EQ(guard.check(ReadOutcome::error, state_at(0), 0), Fault::read_error);
  EXPECT_EQ(guard.check(ReadOutcome::timeout, state_at(0), 0), Fault::timeout);
}

TEST(Guard, TellsTheSameMeasurementTwice) {
  Guard guard(LiveData{}, limits_of(12, 8));
  EXPECT_EQ(guard.check(ReadOutcome::value, state_at(0), 0), Fault::none);  // the first may have any number, 0 as well
  EXPECT_EQ(guard.check(ReadOutcome::value, state_at(0), 1), Fault::stale);
  EXPECT_EQ(guard.check(ReadOutcome::value, state_at(1), 2), Fault::none);
  // numbers wrap round
  EXPECT_EQ(guard.check(ReadOutcome::value, state_at(0xFFFFFFFFu), 3), Fault::none);
  EXPECT_EQ(guard.check(ReadOutcome::value, state_at(0), 4), Fault::none);
}

TEST(Guard, TellsEveryNumberThatIsNone) {
  std::vector<std::function<double&(GripperState&)>> numbers{[](GripperState& s) -> double& { return s.gap; },
                                                             [](GripperState& s) -> double& { return s.time; }};
  for (int k = 0; k < 3; ++k) numbers.push_back([k](GripperState& s) -> double& { return s.position[k]; });
  for (int k = 0; k < 9; ++k) numbers.push_back([k](GripperState& s) -> double& { return s.rotation[k]; });
  for (const auto& number : numbers)
    for (const double value : {NOT_A_NUMBER, INFINITE, -INFINITE}) {
      Guard guard(LiveData{}, limits_of(12, 8));
      ASSERT_EQ(guard.check(ReadOutcome::value, state_at(0), 0), Fault::none);
      GripperState bad = state_at(1);
      number(bad) = value;
      EXPECT_EQ(guard.check(ReadOutcome::value, bad, 1), Fault::not_finite);
    }
}

TEST(Guard, TellsARotationThatIsNone) {
  const auto check = [](const Rotation& rotation) {
    Guard guard(LiveData{}, limits_of(12, 8));
    GripperState state = state_at(0);
    state.rotation = rotation;
    return guard.check(ReadOutcome::value, state, 0);
  };
  EXPECT_EQ(check(turned_about_y(1)), Fault::none);
  EXPECT_EQ(check({}), Fault::not_finite);
  EXPECT_EQ(check({-1, 0, 0, 0, 1, 0, 0, 0, 1}), Fault::not_finite);  // a mirror
  EXPECT_EQ(check({1, 0, 0, 0, 1, 0, 0, 0, 0}), Fault::not_finite);   // flat
  // a column of length 1 + e has the square 1 + 2 e; a skew of e the product e
  EXPECT_EQ(check({1 + 0.49e-3, 0, 0, 0, 1, 0, 0, 0, 1}), Fault::none);
  EXPECT_EQ(check({1 + 0.51e-3, 0, 0, 0, 1, 0, 0, 0, 1}), Fault::not_finite);
  EXPECT_EQ(check({1, 0.99e-3, 0, 0, 1, 0, 0, 0, 1}), Fault::none);
  EXPECT_EQ(check({1, 1.01e-3, 0, 0, 1, 0, 0, 0, 1}), Fault::not_finite);
}

// [live] jump_m_s for arm and gap and JUMP_TURN for the rotation, over the time since the tick before, skipped ones included.
TEST(Guard, TellsAJump) {
  LiveData live;
  live.rate = 2000;
  live.jump = 4;
  for (const std::int64_t ticks : {1, 3}) {
    const double way = 4.0 * static_cast<double>(ticks) / 2000, turn = JUMP_TURN * static_cast<double>(ticks) / 2000;
    const auto after = [&](const std::function<void(GripperState&)>& change) {
      Guard guard(live, limits_of(12, 8));
      EXPECT_EQ(guard.check(ReadOutcome::value, state_at(0), 7), Fault::none);
      GripperState state = state_at(1);
      change(state);
      return guard.check(ReadOutcome::value, state, 7 + ticks);
    };
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(after([&](GripperState& s) { s.position[k] -= 0.999 * way; }), Fault::none);
      EXPECT_EQ(after([&](GripperState& s) { s.position[k] += 1.001 * way; }), Fault::jump);
    }
    EXPECT_EQ(after([&](GripperState& s) { s.gap += 0.999 * way; }), Fault::none);
    EXPECT_EQ(after([&](GripperState& s) { s.gap -= 1.001 * way; }), Fault::jump);
    // the chord 2 sin(angle / 2) is up to 0.1 % shorter than an angle of 0.15
    EXPECT_EQ(after([&](GripperState& s) { s.rotation = turned_about_y(0.999 * turn); }), Fault::none);
    EXPECT_EQ(after([&](GripperState& s) { s.rotation = turned_about_y(-1.002 * turn); }), Fault::jump);
  }
}

// A measurement that came after a gap of 40 ticks may be of the tick before it: what moves 1 m/s is then 41 mm further a tick later, and no jump.
// One tick later the allowed way is that of one tick again. A gap shorter than CALL_PATIENCE changes nothing.
TEST(Guard, AMeasurementAfterAGapMayBeOld) {
  const auto check = [](Guard& guard, std::int64_t tick, double place) {
    GripperState state = state_at(static_cast<std::uint32_t>(tick));
    state.position[1] += place;
    return guard.check(ReadOutcome::value, state, tick);
  };
  for (const double allowed : {1.0, 0.999}) {
    Guard guard(LiveData{}, limits_of(12, 8));
    ASSERT_EQ(check(guard, 0, 0), Fault::none);
    ASSERT_EQ(check(guard, 40, 0), Fault::none);
    EXPECT_EQ(check(guard, 41, 5e-3 * 41 / allowed * 0.9995), allowed == 1.0 ? Fault::none : Fault::jump);
    if (allowed < 1.0) continue;
    EXPECT_EQ(check(guard, 42, 5e-3 * 41 * 0.9995 + 5.01e-3), Fault::jump);
  }
  Guard guard(LiveData{}, limits_of(12, 8));
  ASSERT_EQ(check(guard, 0, 0), Fault::none);
  ASSERT_EQ(check(guard, 11, 0), Fault::none);
  EXPECT_EQ(check(guard, 12, 5.01e-3), Fault::jump);
}

TEST(Guard, TheFirstMeasurementMayBeAnywhere) {
  Guard guard(LiveData{}, limits_of(12, 8));
  GripperState far = state_at(0);
  far.position = {100, 0, 0};
  EXPECT_EQ(guard.check(ReadOutcome::value, far, 0), Fault::none);
}

// The guard does not compare the next measurement with a refused one.
TEST(Guard, ARefusedMeasurementIsForgotten) {
  Guard guard(LiveData{}, limits_of(12, 8));
  EXPECT_EQ(guard.check(ReadOutcome::value, state_at(0), 0), Fault::none);
  GripperState far = state_at(1);
  far.gap = 1;
  EXPECT_EQ(guard.check(ReadOutcome::value, far, 1), Fault::jump);
  EXPECT_EQ(guard.check(ReadOutcome::value, state_at(2), 2), Fault::none);
}

// ---- limits ----

// A constant request: at tick n no more than the ramp's share, in its direction, and all of it once the ramp is over.
TEST(Guard, RampsUpFromZero) {
  LiveData live;
  Guard guard(live, limits_of(12, 8));
  const GripperForce wanted{{3, -4, 0}, 2};
  for (int n = 0; n <= 700; ++n) {
    const GripperForce force = guard.limit(wanted, n + 40);
    const double share = std::min(1.0, n * 1e-3 / live.ramp);
    EXPECT_NEAR(force.arm[0], 3 * share, ROUNDING);
    EXPECT_NEAR(force.arm[1], -4 * share, ROUNDING);
    EXPECT_NEAR(force.grip, 2 * share, ROUNDING);
  }
}

TEST(Guard, ClampsToTheDevicesLimitsAndKeepsTheArmsDirection) {
  LiveData live;
  live.ramp = 0;
  live.slew = 1e9;
  Guard guard(live, limits_of(5, 2));
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    GripperForce wanted{{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-20, 20)}, random.uniform(-8, 8)};
    const GripperForce force = guard.limit(wanted, n);
    const double size = norm(wanted.arm), factor = std::min(1.0, 5 / size);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(force.arm[k], factor * wanted.arm[k], ROUNDING);
    EXPECT_LE(norm(force.arm), 5 + ROUNDING);
    EXPECT_NEAR(force.grip, std::clamp(wanted.grip, -2.0, 2.0), ROUNDING);
  }
}

// Limited as the grip, in its direction; without tips of their own no device gets any.
TEST(Guard, LimitsWhatIsAcrossTheClosingLine) {
  LiveData live;
  live.ramp = 0;
  live.slew = 1e9;
  GripperLimits limits = limits_of(12, 2);
  const GripperForce wanted{{0, -4, 0}, 1, {0, 3, 4}};
  EXPECT_EQ(Guard(live, limits).limit(wanted, 0).across, Triple{});
  limits.pushes_each_tip = true;
  const GripperForce force = Guard(live, limits).limit(wanted, 0);
  EXPECT_NEAR(force.across[1], 3 * 2 / 5.0, ROUNDING);
  EXPECT_NEAR(force.across[2], 4 * 2 / 5.0, ROUNDING);
  live.slew = 1000;  // 1 N a tick
  EXPECT_NEAR(norm(Guard(live, limits).limit(wanted, 0).across), 1, ROUNDING);
  EXPECT_TRUE(is_none(Guard(live, limits).limit({{}, 0, {0, std::nan(""), 0}}, 0)));
}

// Whatever is wished: never over the limits, never over the ramp, never further from the force before than the slew, ticks skipped
// or not.
TEST(Guard, HoldsEveryLimitAgainstWildWishes) {
  LiveData live;
  live.rate = 3000;
  live.slew = 500;
  Random random(9);
  Guard guard(live, limits_of(6, 3));
  GripperForce before;
  std::int64_t tick = 11;
  const std::int64_t first = tick;
  int at_slew = 0, at_limit = 0;
  for (int n = 0; n < 20000; ++n) {
    const double wild = n % 7 == 0 ? 1e3 : 8;
    const GripperForce wanted{{random.uniform(-wild, wild), random.uniform(-wild, wild), random.uniform(-wild, wild)},
                              random.uniform(-wild, wild)};
    const GripperForce force = guard.limit(n % 50 < 25 ? wanted : GripperForce{{0, 40, 0}, 40}, tick);
    const std::int64_t passed = n == 0 ? 1 : n % 5 == 0 ? 4 : 1;
    const double share = std::min(1.0, static_cast<double>(tick - first) / 3000 / live.ramp);
    // a force that the ramp of a moment ago allowed is within the ramp of now
    EXPECT_LE(norm(force.arm), 6 * share + ROUNDING);
    EXPECT_LE(std::abs(force.grip), 3 * share + ROUNDING);
    const double most = 500 * static_cast<double>(passed) / 3000;
    const double changed = distance(force.arm, before.arm);
    EXPECT_LE(changed, most + ROUNDING);
    EXPECT_LE(std::abs(force.grip - before.grip), most + ROUNDING);
    at_slew += changed > 0.999 * most;
    at_limit += norm(force.arm) > 0.999 * 6;
    before = force;
    tick += (n + 1) % 5 == 0 ? 4 : 1;
  }
  EXPECT_GT(at_slew, 1000);
  EXPECT_GT(at_limit, 500);
}

// A device's own watchdog may have dropped the force while the loop stalled, so the force starts again from zero.
TEST(Guard, AfterAStallItBeginsAtZeroAgain) {
  LiveData live;
  Guard guard(live, limits_of(12, 8));
  const GripperForce wanted{{0, -4, 0}, 7};
  std::int64_t n = 0;
  for (; n < 1000; ++n) guard.limit(wanted, n);
  const auto longest = static_cast<std::int64_t>(STALL * live.rate);
  n += longest - 2;
  EXPECT_NEAR(guard.limit(wanted, n).grip, 7, ROUNDING) << "a short one is only time";
  n += longest;
  const std::int64_t again = n;
  for (; n < again + 600; ++n) {
    const double share = std::min(1.0, static_cast<double>(n - again) * 1e-3 / live.ramp);
    const GripperForce force = guard.limit(wanted, n);
    EXPECT_NEAR(force.grip, 7 * share, ROUNDING) << n - again;
    EXPECT_NEAR(force.arm[1], -4 * share, ROUNDING) << n - again;
  }
}

// Without a ramp, too: one force of zero, then what the slew allows from there.
TEST(Guard, TheFirstForceAfterAStallIsZeroWithoutARamp) {
  LiveData live;
  live.ramp = 0;
  live.slew = 1000;
  for (const double rate : {250.0, 1000.0, 3000.0, 8000.0}) {
    live.rate = rate;
    Guard guard(live, limits_of(12, 8));
    const std::int64_t stall = guard.stall_periods();
    EXPECT_GE(static_cast<double>(stall) / rate, STALL);
    EXPECT_LT(static_cast<double>(stall - 1) / rate, STALL);
    for (int n = 0; n < 1000; ++n) guard.limit({{0, -4, 0}, 7}, n);
    EXPECT_NEAR(guard.limit({{0, -4, 0}, 7}, 999 + stall - 1).grip, 7, ROUNDING);
    const std::int64_t again = 999 + 2 * stall - 1;
    EXPECT_EQ(norm(guard.limit({{0, -4, 0}, 7}, again).arm), 0);
    EXPECT_NEAR(guard.limit({{0, -4, 0}, 7}, again + 1).grip, live.slew / rate, ROUNDING);
  }
}

TEST(Guard, AForceThatIsNoNumberIsNone) {
  LiveData live;
  live.ramp = 0;
  for (const double bad : {NOT_A_NUMBER, INFINITE, -INFINITE}) {
    for (int k = 0; k < 8; ++k) {
      Guard guard(live, limits_of(5, 2));
      guard.limit({{1, 1, 1}, 1}, 0);
      GripperForce wanted{{1, 1, 1}, 1};
      if (k >= 4) wanted = {};  // hypot of three numbers may lose a NaN beside zeros
      (k % 4 < 3 ? wanted.arm[k % 4] : wanted.grip) = bad;
      const GripperForce force = guard.limit(wanted, 1);
      EXPECT_EQ(norm(force.arm), 0);
      EXPECT_EQ(force.grip, 0);
      // and goes on from there within the slew
      EXPECT_LE(guard.limit({{1, 1, 1}, 1}, 2).grip, live.slew * 1e-3 + ROUNDING);
    }
  }
}

}  // namespace
}  // namespace wholehand::device

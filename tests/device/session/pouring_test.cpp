// SPDX-License-Identifier: MIT
// Liquid that runs, falls and arrives: against closed forms, and its sum at every tick.
// sanitizers: address
#include "device/session/pouring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

constexpr double MILLILITRE = 1e-6;  // m3
// Sums of some thousand parts of at most 1e-3 m3, each rounded to 1e-19.
constexpr double ROUNDING = 1e-15;

TaskData target_at(const Triple& place, double diameter) {
  TaskData task;
  task.target_place = place;
  task.target_diameter = diameter;
  return task;
}

double in_sight(const Pouring& pouring, int vessel) {
  return pouring.volume(vessel) + pouring.arrived(vessel) + pouring.spilled(vessel);
}

// What is above what the lip holds back leaves with a time constant, however time is cut into ticks.
TEST(Pouring, AnExcessLeavesExponentially) {
  for (const int ticks : {1, 7, 400}) {
    Pouring pouring({200 * MILLILITRE}, std::nullopt, G, 1000);
    for (int n = 0; n < ticks; ++n) pouring.pour(0, 120 * MILLILITRE, Vec3(0, 1, 0), n, 0.4 / ticks);
    const double left = 120 * MILLILITRE + 80 * MILLILITRE * std::exp(-0.4 / POUR_TIME);
    EXPECT_NEAR(pouring.volume(0), left, ROUNDING) << ticks;
    EXPECT_NEAR(pouring.spilled(0), 200 * MILLILITRE - left, ROUNDING) << ticks;
  }
}

TEST(Pouring, TheFlowIsWhatLeavesInATick) {
  Pouring pouring({200 * MILLILITRE}, std::nullopt, G, 1000);
  const double before = pouring.volume(0);
  const double flow = pouring.pour(0, 50 * MILLILITRE, Vec3(0, 1, 0), 0, 1e-3);
  EXPECT_NEAR(flow * 1e-3, before - pouring.volume(0), 1e-18);
  // at the start the excess over the time constant, less what half a tick has taken of it
  EXPECT_NEAR(flow / (150 * MILLILITRE / POUR_TIME), 1 - 0.5e-3 / POUR_TIME, 1e-5);
}

TEST(Pouring, NothingLeavesBelowTheLip) {
  Pouring pouring({100 * MILLILITRE}, std::nullopt, G, 1000);
  EXPECT_EQ(pouring.pour(0, 100 * MILLILITRE, Vec3(0, 1, 0), 0, 1e-3), 0);
  EXPECT_EQ(pouring.pour(0, 300 * MILLILITRE, Vec3(0, 1, 0), 1, 1e-3), 0);
  EXPECT_EQ(pouring.pour(0, 0, Vec3(0, 1, 0), 2, 0), 0);  // no time passes at the grasp
  EXPECT_EQ(pouring.volume(0), 100 * MILLILITRE);
}

TEST(Pouring, EmptiesAndIsNeverNegative) {
  Pouring pouring({100 * MILLILITRE}, std::nullopt, G, 1000);
  for (int n = 0; n < 20000; ++n) {
    pouring.pour(0, 0, Vec3(0, 1, 0), n, 1e-3);
    ASSERT_GE(pouring.volume(0), 0);
  }
  EXPECT_LE(pouring.volume(0), LEAST_DROP);
  EXPECT_NEAR(in_sight(pouring, 0), 100 * MILLILITRE, ROUNDING);
}

// sqrt(2 h / g), rounded to a tick; not a tick earlier.
TEST(Pouring, ADropArrivesAfterTheTimeOfItsFall) {
  for (const double rate : {250.0, 1000.0, 8000.0}) {
    for (const double height : {0.0, 1e-4, 0.05, 0.3, 1.7}) {
      Pouring pouring({100 * MILLILITRE}, target_at({0.2, 0.1, -0.1}, 0.08), G, rate);
      const std::int64_t start = 123;
      pouring.pour(0, 0, Vec3(0.2, 0.1 + height, -0.1), start, 1e-3);
      const double drop = 100 * MILLILITRE - pouring.volume(0);
      ASSERT_GT(drop, 0);
      const auto lands = start + static_cast<std::int64_t>(std::lround(std::sqrt(2 * height / G) * rate));
      if (lands > start) {
        pouring.land(lands - 1);
        EXPECT_EQ(pouring.arrived(0), 0) << height;
      }
      pouring.land(lands);
      EXPECT_NEAR(pouring.arrived(0), drop, 1e-19) << height;  // of 1e-4 less what is left of it
      EXPECT_EQ(pouring.spilled(0), 0);
    }
  }
}

// The mouth is a level disc: a lip over its edge hits, a hair further out or a hair below it misses.
TEST(Pouring, WhatMissesTheMouthByAHairIsSpilled) {
  const double radius = 0.04;
  for (int k = 0; k < 12; ++k) {
    const double a = 2 * PI * k / 12;
    for (const double hair : {-1e-9, 1e-9}) {
      Pouring pouring({100 * MILLILITRE}, target_at({0.2, 0.1, -0.1}, 2 * radius), G, 1000);
      const double r = radius + hair;
      pouring.pour(0, 0, Vec3(0.2 + r * std::cos(a), 0.3, -0.1 + r * std::sin(a)), 0, 1e-3);
      pouring.land(1000);
      EXPECT_EQ(pouring.spilled(0) > 0, hair > 0);
      EXPECT_EQ(pouring.arrived(0) > 0, hair < 0);
    }
  }
  for (const double hair : {-1e-9, 1e-9}) {
    Pouring pouring({100 * MILLILITRE}, target_at({0.2, 0.1, -0.1}, 2 * radius), G, 1000);
    pouring.pour(0, 0, Vec3(0.2, 0.1 + hair, -0.1), 0, 1e-3);
    pouring.land(1000);
    EXPECT_EQ(pouring.spilled(0) > 0, hair < 0);
  }
}

// Several vessels, a lip that moves, hits and misses, ticks that are skipped, heights beyond the longest fall: at every tick
// nothing is lost, and what is in the air is what left within the longest fall.
TEST(Pouring, TheSumIsKeptAtEveryTick) {
  for (const double rate : {250.0, 1000.0}) {
    Random random(8);
    const std::vector<double> start{300 * MILLILITRE, 0, 500 * MILLILITRE};
    Pouring pouring(start, target_at({0, 0, 0}, 0.1), G, rate);
    std::int64_t number = 0;
    for (int n = 0; n < 6000; ++n) {
      const std::int64_t passed = n % 97 == 0 ? 5 : 1;
      number += passed;
      const int vessel = n % 400 < 200 ? 0 : 2;
      const double height = n % 1000 < 100 ? 30 : random.uniform(-0.01, 0.5);
      pouring.land(number);
      pouring.pour(vessel, start[static_cast<std::size_t>(vessel)] * (1 - n / 6000.0), Vec3(random.uniform(-0.08, 0.08), height, 0),
                   number, static_cast<double>(passed) / rate);
      for (int v = 0; v < 3; ++v) {
        const double whole = start[static_cast<std::size_t>(v)], air = whole - in_sight(pouring, v);
        ASSERT_GE(air, -ROUNDING) << n;
        ASSERT_GE(pouring.volume(v), 0);
        ASSERT_LE(air, whole + ROUNDING);
      }
    }
    EXPECT_GT(pouring.arrived(0), 10 * MILLILITRE);
    EXPECT_GT(pouring.spilled(0), 10 * MILLILITRE);
    pouring.land(number + static_cast<std::int64_t>(LONGEST_FALL * rate) + 1);
    for (int v = 0; v < 3; ++v) EXPECT_NEAR(in_sight(pouring, v), start[static_cast<std::size_t>(v)], ROUNDING);
  }
}

// The list of what falls never overflows: a drop a tick, each for the longest fall.
TEST(Pouring, HoldsAllThatCanBeInTheAir) {
  const double rate = 8000;
  Pouring pouring({1.0}, target_at({0, 0, 0}, 1), 0, rate);  // without gravity everything takes the longest time
  for (int n = 0; n < 40000; ++n) {
    pouring.land(n);
    pouring.pour(0, 1 - n / 40000.0, Vec3(0, 1, 0), n, 1 / rate);
    ASSERT_EQ(pouring.spilled(0), 0) << n;
  }
}

}  // namespace
}  // namespace wholehand::device

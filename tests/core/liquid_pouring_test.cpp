// SPDX-License-Identifier: MIT
// Kernel 6 at the lip: what a tilted vessel holds back and what has poured.
#include "core/liquid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/evaluator.h"
#include "tests/support/liquid_reference.h"
#include "tests/support/liquid_samples.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

namespace reference = liquid_reference;
using core_f64::LiquidState;
using reference::Wide;

// ---- pouring ----

TEST(Liquid, LipHoldsWhatLiesUnderTheMouthsLowestPoint) {
  for (const double degree : {5.0, 30.0, 54.0}) {  // the surface meets only the wall: h = depth - r tan t
    const Wide tangent = std::tan(Wide(radians(degree)));
    EXPECT_NEAR(lip_capacity(beaker1_ready(), radians(degree)),
                double(PI_L * BEAKER1_RADIUS * BEAKER1_RADIUS * (BEAKER1_DEPTH - BEAKER1_RADIUS * tangent)),
                LIQUID_VOLUME_SHARE * double(BEAKER1_CAPACITY))
        << degree;
  }
  for (const double degree : {55.0, 70.0, 85.0, 89.9}) {  // a hoof that reaches the mouth
    const Wide tangent = std::tan(Wide(radians(degree)));
    EXPECT_NEAR(lip_capacity(beaker1_ready(), radians(degree)),
                double(hoof(BEAKER1_RADIUS, BEAKER1_RADIUS - BEAKER1_DEPTH / tangent, tangent).volume),
                LIQUID_VOLUME_SHARE * double(BEAKER1_CAPACITY))
        << degree;
  }
  for (const CavitySample& s : cavity_samples()) {
    for (double degree = 2.5; degree < 180; degree += 12.5) {
      const Wide tilt = radians(degree);
      EXPECT_NEAR(lip_capacity(s.vessel, radians(degree)),
                  double(reference::below(s.cavity, reference::lip_level(s.cavity, tilt), tilt).volume),
                  LIQUID_VOLUME_SHARE * s.vessel.capacity)
          << s.name << " " << degree;
    }
  }
}

TEST(Liquid, LipCapacityNeverGrowsWithTheTilt) {
  for (const CavitySample& s : cavity_samples()) {
    ASSERT_EQ(s.vessel.lip_capacity.size(), core_f64::WHOLE_DEGREES);
    double last = s.vessel.capacity;
    for (double degree = 0; degree <= 180; degree += 0.5) {
      const double capacity = lip_capacity(s.vessel, radians(degree));
      EXPECT_LE(capacity, last + LIQUID_LEVEL_SHARE * s.vessel.capacity) << s.name << " " << degree;
      EXPECT_GE(capacity, 0) << s.name << " " << degree;
      last = capacity;
      if (degree == std::floor(degree)) {
        EXPECT_NEAR(s.vessel.lip_capacity[std::size_t(degree)], capacity, LIQUID_LEVEL_SHARE * s.vessel.capacity)
            << s.name << " " << degree;
      }
    }
    EXPECT_EQ(lip_capacity(s.vessel, PI), 0) << s.name;
  }
}

TEST(Liquid, RemainingIsTheFillOrWhatTheLipHoldsAndTheRestHasPoured) {
  const Scene scene = liquid_scene();
  const auto evaluator = make_core_evaluator(scene);
  for (std::size_t v = 0; v < cavity_samples().size(); ++v) {
    const CavitySample& s = cavity_samples()[v];
    for (const double fill : {0.0, 0.25, 0.5, 1.0}) {
      const double given = fill * s.vessel.capacity;
      double last = given;
      for (double degree = 0; degree <= 180; degree += 4.5) {
        const LiquidResult result = evaluator->liquid(v, fill, radians(degree));
        const double held = std::min(given, lip_capacity(s.vessel, radians(degree)));
        EXPECT_NEAR(result.volume, held, LIQUID_LEVEL_SHARE * s.vessel.capacity) << s.name << " " << fill << " " << degree;
        EXPECT_NEAR(result.poured, given - result.volume, LIQUID_LEVEL_SHARE * s.vessel.capacity)
            << s.name << " " << fill << " " << degree;
        EXPECT_GE(result.poured, 0);
        EXPECT_DOUBLE_EQ(result.mass, 1000 * result.volume);
        EXPECT_LE(result.volume, last) << s.name << " " << fill << " " << degree;
        const LiquidState state = liquid_at_rest(s.vessel, result.volume, radians(degree));
        EXPECT_NEAR(result.lean, state.lean, 1e-9);  // m: one stopping tolerance of the level apart
        EXPECT_NEAR(result.height, state.height, 1e-9);
        last = result.volume;
      }
    }
  }
}

TEST(Liquid, CenterOfAVesselThatPoursIsThatUnderTheLip) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < cavity_samples().size(); ++v) {
    const reference::Cavity& cavity = cavity_samples()[v].cavity;
    for (const double degree : {20.0, 47.5, 66.0, 81.0, 88.0}) {
      const Wide tilt = radians(degree);
      const reference::Body body = reference::below(cavity, reference::lip_level(cavity, tilt), tilt);
      const LiquidResult result = evaluator->liquid(v, 1, radians(degree));
      ASSERT_GT(result.poured, 0);
      EXPECT_NEAR(result.lean, double(body.lean), LIQUID_CENTER) << v << " " << degree;
      EXPECT_NEAR(result.height, double(body.height), LIQUID_CENTER) << v << " " << degree;
    }
  }
}

TEST(Liquid, AtNinetyDegreesAFullCylinderIsEmptyAndABellyKeepsItsPuddle) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  const LiquidResult cylinder_left = evaluator->liquid(0, 1, PI / 2);
  EXPECT_EQ(cylinder_left.mass, 0);
  EXPECT_EQ(cylinder_left.height, BEAKER1_FLOOR);
  EXPECT_NEAR(cylinder_left.poured, double(BEAKER1_CAPACITY), LIQUID_LEVEL_SHARE * double(BEAKER1_CAPACITY));
  // the bottle's belly below the neck's radius of 18: a straight part of 30 mm is a segment; the rest by the other integration
  const LiquidResult puddle = evaluator->liquid(3, 1, PI / 2);
  const reference::Body body = reference::below(liquid_bottle_cavity(), -18e-3L, PI_L / 2);
  const Wide segment = 38e-3L * 38e-3L * std::acos(18.0L / 38) - 18e-3L * std::sqrt(38e-3L * 38e-3L - 18e-3L * 18e-3L);
  EXPECT_GT(double(body.volume), double(segment * 30e-3L));
  EXPECT_NEAR(puddle.volume, double(body.volume), LIQUID_VOLUME_SHARE * cavity_samples()[3].vessel.capacity);
}

TEST(Liquid, UpsideDownNothingIsLeft) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < cavity_samples().size(); ++v) {
    for (const double fill : {0.0, 1e-12, 0.5, 1.0}) {
      const LiquidResult result = evaluator->liquid(v, fill, PI);
      EXPECT_EQ(result.volume, 0);
      EXPECT_EQ(result.mass, 0);
      EXPECT_EQ(result.lean, 0);
      EXPECT_EQ(result.height, cavity_samples()[v].vessel.floor_height);
      EXPECT_DOUBLE_EQ(result.poured, fill * cavity_samples()[v].vessel.capacity);
    }
  }
}

TEST(Liquid, WhatPoursAtASmallerTiltIsGoneAtALargerOne) {
  // at and between whole degrees, never more than at any smaller tilt
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < cavity_samples().size(); ++v) {
    double least = cavity_samples()[v].vessel.capacity;
    for (int degree = 0; degree <= 180; ++degree) {
      least = std::min(least, evaluator->liquid(v, 1, radians(degree)).volume);
      EXPECT_LE(evaluator->liquid(v, 1, radians(degree) + 0.001 * (degree < 180)).volume, least) << v << " " << degree;
    }
  }
}

TEST(Liquid, HalfFullCylinderPoursWhereTheDiagonalIsLevel) {
  const auto evaluator = make_core_evaluator(three_beakers());
  // 1e-9 rad: the capacity falls by pi r^3 / cos^2 t per rad there, so that 1e-12 of it are far less
  EXPECT_NEAR(evaluator->pouring_tilt(0, 0.5), std::atan(BEAKER1_DEPTH / (2 * BEAKER1_RADIUS)), 1e-9);
  EXPECT_NEAR(evaluator->pouring_tilt(0, 0.75), std::atan(BEAKER1_DEPTH / (4 * BEAKER1_RADIUS)), 1e-9);
  EXPECT_NEAR(evaluator->pouring_tilt(0, 0.999), std::atan(0.001 * BEAKER1_DEPTH / BEAKER1_RADIUS), 1e-9);
}

TEST(Liquid, PouringStartsWhereTheLipHoldsExactlyTheFill) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < cavity_samples().size(); ++v) {
    const CavitySample& s = cavity_samples()[v];
    double last = PI;
    for (const double fill : {0.01, 0.1, 0.25, 0.5, 0.75, 0.9}) {
      const double tilt = evaluator->pouring_tilt(v, fill);
      EXPECT_LE(tilt, last) << s.name << " " << fill;
      EXPECT_NEAR(double(reference::below(s.cavity, reference::lip_level(s.cavity, tilt), tilt).volume), fill * s.vessel.capacity,
                  LIQUID_VOLUME_SHARE * s.vessel.capacity)
          << s.name << " " << fill;
      last = tilt;
    }
    EXPECT_NEAR(evaluator->pouring_tilt(v, 1), 0, 1e-8) << s.name;  // rad: under a sine of 1e-9 a vessel counts as upright
    EXPECT_TRUE(std::isnan(evaluator->pouring_tilt(v, 0))) << s.name;
  }
}

}  // namespace
}  // namespace wholehand

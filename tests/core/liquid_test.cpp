// SPDX-License-Identifier: MIT
// Kernel 6 upright: segments of a disc, the cavity, levels and capacities in closed form; and the glass around it.
#include "core/liquid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/evaluator.h"
#include "tests/support/liquid_reference.h"
#include "tests/support/liquid_samples.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

namespace reference = liquid_reference;
using core_f64::LiquidState;
using core_f64::Vec2;
using core_f64::Vessel;
using reference::Wide;

// Distance to a half outline without its last element, the mouth, from its definition: by brute force over its points.
double distance_to_wall(const VesselData& vessel, double r, double y) {
  double nearest = 1;
  std::array<double, 2> a{0, 0};
  for (std::size_t i = 0; i + 1 < vessel.outline.size(); ++i) {
    const OutlineElement& e = vessel.outline[i];
    const int steps = 20000;
    double from = 0, swing = 0;
    if (e.is_arc) {
      from = std::atan2(a[1] - e.center[1], a[0] - e.center[0]);
      swing = std::remainder(std::atan2(e.end[1] - e.center[1], e.end[0] - e.center[0]) - from, 2 * PI);
    }
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps;
      double pr = a[0] + t * (e.end[0] - a[0]), py = a[1] + t * (e.end[1] - a[1]);
      if (e.is_arc) {
        const double radius = std::hypot(e.end[0] - e.center[0], e.end[1] - e.center[1]);
        pr = e.center[0] + radius * std::cos(from + t * swing);
        py = e.center[1] + radius * std::sin(from + t * swing);
      }
      nearest = std::min(nearest, std::hypot(pr - r, py - y));
    }
    a = e.end;
  }
  return nearest;
}

// ---- segments of a disc ----

TEST(Liquid, SegmentAreaAndMomentAreThoseOfADisc) {
  for (const double r : {0.0385, 0.5}) {
    for (const double share : {-1.0, -0.999999999999999, -0.999, -0.6, -1e-9, 0.0, 0.3, 0.97, 0.999999, 0.999999999999999, 1.0}) {
      const Wide R = r, h = share * r, root = std::sqrt(std::max(Wide(0), (R - h) * (R + h)));
      // 1e-15 of r^2 and 1e-15 of r^3: rounding of terms of that size
      EXPECT_NEAR(core_f64::segment_area(r, share * r), double(R * R * std::atan2(root, h) - h * root), 1e-15 * r * r) << share;
      EXPECT_NEAR(core_f64::segment_moment(r, share * r), double(2 * root * root * root / 3), 1e-15 * r * r * r) << share;
    }
  }
}

TEST(Liquid, SegmentBeyondTheDiscIsAllOrNothing) {
  EXPECT_EQ(core_f64::segment_area(0.04, 0.041), 0);
  EXPECT_EQ(core_f64::segment_moment(0.04, 0.041), 0);
  EXPECT_DOUBLE_EQ(core_f64::segment_area(0.04, -0.041), PI * 0.04 * 0.04);
  EXPECT_EQ(core_f64::segment_moment(0.04, -0.041), 0);
  EXPECT_EQ(core_f64::segment_area(0, 0.01), 0);
  EXPECT_EQ(core_f64::segment_area(0, -0.01), 0);
  EXPECT_EQ(core_f64::segment_area(0, 0), 0);
}

// ---- the cavity ----

TEST(Liquid, CavityOfTheVesselsIsTheOneDerivedByHand) {
  for (const CavitySample& s : cavity_samples()) {
    const reference::Cavity prepared = reference::cavity_of(prepare_vessel(s.data, true).cavity);
    for (const reference::Piece& piece : s.cavity) {
      for (const Wide share : {0.001L, 0.1L, 0.5L, 0.9L, 0.999L}) {
        const Wide y = piece.low + share * (piece.high - piece.low);
        // 1e-12 m: where an arc runs smoothly into a line their ends are a root of rounding, 1e-8 m, along the tangent
        EXPECT_NEAR(double(cavity_radius(prepared, y)), double(reference::radius_at(piece, y)), 1e-12)
            << s.name << " at " << double(y);
      }
    }
    // 1e-15 m: differences of numbers under 0.2 m
    EXPECT_NEAR(s.vessel.floor_height, s.data.wall, 1e-15) << s.name;
    EXPECT_NEAR(s.vessel.mouth_height, s.data.height, 1e-15) << s.name;
    EXPECT_NEAR(s.vessel.mouth_radius, double(s.cavity.back().high_radius), 1e-15) << s.name;
  }
}

TEST(Liquid, InnerWallIsOneWallFromTheOutlineWithoutItsMouth) {
  for (const VesselData& data : {beaker2(), beaker3(), vase()}) {
    const PreparedVessel prepared = prepare_vessel(data, true);
    const reference::Cavity cavity = reference::cavity_of(prepared.cavity);
    EXPECT_NEAR(prepared.floor_height, data.wall, 1e-15) << data.name;
    Wide last = prepared.floor_height;
    for (const reference::Piece& piece : cavity) {
      EXPECT_NEAR(double(piece.low), double(last), 1e-15) << data.name;  // no gap between the pieces
      last = piece.high;
      for (const Wide share : {0.03L, 0.35L, 0.71L, 0.98L}) {
        const double y = double(piece.low + share * (piece.high - piece.low));
        // 1e-8 m: the outline's points are up to 6 um apart, 3 um off at 1 mm is 5e-9 m further
        EXPECT_NEAR(distance_to_wall(data, double(reference::radius_at(piece, y)), y), data.wall, 1e-8) << data.name << " at " << y;
      }
    }
    EXPECT_NEAR(double(last), data.height, 1e-15) << data.name;
  }
}

TEST(Liquid, ElementRadiusFollowsLinesAndArcs) {
  const core_f64::Element cone{{0.04, 0.01}, {0.02, 0.05}, {}, 0, 0};
  EXPECT_DOUBLE_EQ(core_f64::element_radius(cone, 0.01), 0.04);
  EXPECT_DOUBLE_EQ(core_f64::element_radius(cone, 0.03), 0.03);
  EXPECT_DOUBLE_EQ(core_f64::element_radius(cone, 0.05), 0.02);
  const core_f64::Element bulge{{0.02, -0.05}, {0.05, 0.02}, {0.02, 0}, 0.05, 1},
      waist{{0.05, -0.03}, {0.05, 0.03}, {0.09, 0}, 0.05, -1};
  EXPECT_DOUBLE_EQ(core_f64::element_radius(bulge, 0.03), 0.06);  // 3-4-5
  EXPECT_DOUBLE_EQ(core_f64::element_radius(bulge, -0.04), 0.05);
  EXPECT_DOUBLE_EQ(core_f64::element_radius(waist, 0), 0.04);
  EXPECT_DOUBLE_EQ(core_f64::element_radius(waist, 0.03), 0.05);
}

TEST(Liquid, PlaneCrossingsAreWhereThePlaneMeetsTheWall) {
  const std::vector<core_f64::Element> elements{{{0.04, 0.01}, {0.02, 0.05}, {}, 0, 0},
                                                {{0.03, 0.01}, {0.03, 0.05}, {}, 0, 0},
                                                {{0.02, -0.05}, {0.02, 0.05}, {0.02, 0}, 0.05, 1},
                                                {{0.05, -0.03}, {0.05, 0.03}, {0.09, 0}, 0.05, -1}};
  Random random(6);
  int met = 0, missed = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const core_f64::Element& e = elements[std::size_t(trial) % elements.size()];
    const double tilt = random.uniform(0.01, PI - 0.01), level = random.uniform(-0.1, 0.1), sigma = trial % 8 < 4 ? 1 : -1;
    const double sine = std::sin(tilt), cosine = std::cos(tilt);
    const auto height = [&](double y) { return cosine * y - sine * sigma * core_f64::element_radius(e, y) - level; };
    const Vec2 found = core_f64::plane_crossings(e, level, sine, cosine, sigma);
    // every change of sign along the element has its crossing
    const int steps = 50;
    bool any = false;
    for (int k = 0; k < steps; ++k) {
      const double y0 = e.a.y + (e.b.y - e.a.y) * k / steps, y1 = e.a.y + (e.b.y - e.a.y) * (k + 1) / steps;
      if (height(y0) * height(y1) < 0) {
        any = true;
        EXPECT_TRUE((found.x >= y0 && found.x <= y1) || (found.y >= y0 && found.y <= y1))
            << trial << " between " << y0 << " and " << y1;
      }
    }
    (any ? met : missed) += 1;
    // and what is inside the element is on the plane; 1e-9 m: at a wall that levels out a radius is the root of a rounding
    for (const double y : {found.x, found.y}) {
      EXPECT_TRUE(std::isfinite(y)) << trial;
      if (y > e.a.y && y < e.b.y) {
        EXPECT_NEAR(height(y), 0, 1e-9) << trial;
      }
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(missed, 1000);
}

TEST(Liquid, PlaneThatMissesTheElementGivesItsStart) {
  const core_f64::Element arc{{0.02, -0.05}, {0.02, 0.05}, {0.02, 0}, 0.05, 1};
  const Vec2 none = core_f64::plane_crossings(arc, 0.2, std::sin(0.5), std::cos(0.5), 1);
  EXPECT_EQ(none.x, arc.a.y);
  EXPECT_EQ(none.y, arc.a.y);
}

// ---- upright ----

TEST(Liquid, CapacityUprightIsTheClosedForm) {
  EXPECT_NEAR(beaker1_ready().capacity, double(BEAKER1_CAPACITY), LIQUID_LEVEL_SHARE * double(BEAKER1_CAPACITY));
  for (const CavitySample& s : cavity_samples()) {
    const Wide capacity = reference::revolved(s.cavity).volume;
    EXPECT_NEAR(s.vessel.capacity, double(capacity), LIQUID_VOLUME_SHARE * double(capacity)) << s.name;
  }
}

TEST(Liquid, CapacityOfAConeFrustumIsTheClosedForm) {
  // outline with a slanted wall alone: inside it is a frustum, cut by the floor at 2 and the mouth at 60 mm
  const VesselData cup = vessel_of("cup", {line_to(25, 0), line_to(40, 60), line_to(0, 60)}, 2);
  const Wide slope = 15.0L / 60, shift = 2e-3L * std::sqrt(1 + slope * slope);
  const Wide low = 25e-3L + slope * 2e-3L - shift, high = 40e-3L - shift;
  const Wide volume = PI_L * 58e-3L / 3 * (low * low + low * high + high * high);
  EXPECT_NEAR(ready_vessel(cup, true).capacity, double(volume), LIQUID_LEVEL_SHARE * double(volume));
}

TEST(Liquid, UprightCylinderStandsAtVolumeOverArea) {
  for (const double fill : {0.01, 0.25, 0.5, 0.75, 0.999}) {
    const LiquidState state = liquid_at_rest(beaker1_ready(), fill * double(BEAKER1_CAPACITY), 0);
    EXPECT_DOUBLE_EQ(state.volume, fill * double(BEAKER1_CAPACITY));
    EXPECT_EQ(state.lean, 0);
    EXPECT_NEAR(state.height, BEAKER1_FLOOR + fill * BEAKER1_DEPTH / 2, 1e-13)
        << fill;  // 1e-12 of the capacity is 1e-13 m of level
  }
}

TEST(Liquid, UprightSphereIsACap) {
  // R^2 pi h^2 - pi h^3 / 3 under the equator of the flask's body, h above its floor; center by Archimedes' ratio
  const Wide R = 41e-3L, h = 30e-3L;
  const Wide volume = PI_L * h * h * (3 * R - h) / 3, height = 1.5e-3L + h * (8 * R - 3 * h) / (4 * (3 * R - h));
  const LiquidState state = liquid_at_rest(cavity_samples()[1].vessel, double(volume), 0);
  EXPECT_NEAR(state.height, double(height), 1e-13);
  EXPECT_NEAR(level_of_volume(cavity_samples()[1].vessel, double(volume), 0), 31.5e-3, 1e-13);
}

TEST(Liquid, BrimFullUprightIsTheWholeCavity) {
  for (const CavitySample& s : cavity_samples()) {
    const reference::Body whole = reference::revolved(s.cavity);
    const LiquidState state = liquid_at_rest(s.vessel, s.vessel.capacity, 0);
    EXPECT_EQ(state.lean, 0) << s.name;
    EXPECT_NEAR(state.height, double(whole.height), 1e-12) << s.name;  // m: rounding of a moment over a volume
    EXPECT_NEAR(lip_capacity(s.vessel, 0), s.vessel.capacity, LIQUID_LEVEL_SHARE * s.vessel.capacity) << s.name;
  }
}

TEST(Liquid, EmptyVesselHasItsLiquidsCenterAtTheInnerFloor) {
  for (const CavitySample& s : cavity_samples()) {
    for (const double tilt : {0.0, 1e-12, 0.4, PI / 2, 2.0, PI}) {
      const LiquidState state = liquid_at_rest(s.vessel, 0, tilt);
      EXPECT_EQ(state.volume, 0);
      EXPECT_EQ(state.lean, 0);
      EXPECT_EQ(state.height, s.vessel.floor_height) << s.name << " " << tilt;
    }
  }
}

// ---- glass ----

reference::Cavity hull_of(const VesselData& data) {
  std::vector<PreparedElement> wall = prepare_vessel(data, true).hull;
  wall.pop_back();  // the mouth
  return reference::cavity_of(wall);
}

TEST(Liquid, GlassOfACylinderIsAHollowCylinderWithAFloor) {
  const Wide outer = PI_L * 40e-3L * 40e-3L * 110e-3L, volume = outer - BEAKER1_CAPACITY;
  const Wide center = (outer * 55e-3L - BEAKER1_CAPACITY * (BEAKER1_FLOOR + BEAKER1_DEPTH / 2.0L)) / volume;
  EXPECT_NEAR(beaker1_ready().mass, double(2230 * volume), 1e-12);  // kg, of 0.1: rounding
  EXPECT_NEAR(beaker1_ready().center_of_mass.y, double(center), 1e-12);
  EXPECT_EQ(beaker1_ready().center_of_mass.x, 0);
  EXPECT_EQ(beaker1_ready().center_of_mass.z, 0);
}

TEST(Liquid, GlassIsTheHullLessTheCavity) {
  for (const CavitySample& s : cavity_samples()) {
    const reference::Body hull = reference::revolved(hull_of(s.data)), cavity = reference::revolved(s.cavity);
    const Wide volume = hull.volume - cavity.volume;
    EXPECT_NEAR(s.vessel.mass, double(2230 * volume), 1e-12) << s.name;
    EXPECT_NEAR(s.vessel.center_of_mass.y, double((hull.volume * hull.height - cavity.volume * cavity.height) / volume), 1e-12)
        << s.name;
  }
  // the flask's hull by hand: the sphere of 42.5 up to the neck, the neck to 140
  const Wide R = 42.5e-3L, top = R + std::sqrt(R * R - 17e-3L * 17e-3L);
  const Wide sphere = PI_L * top * top * (3 * R - top) / 3, neck = PI_L * 17e-3L * 17e-3L * (140e-3L - top);
  EXPECT_NEAR(double(reference::revolved(hull_of(beaker2())).volume), double(sphere + neck), 1e-17);
}

TEST(Liquid, GivenMassAndCenterAreTakenAsTheyAre) {
  const Vessel vessel = ready_vessel(lopsided());
  EXPECT_EQ(vessel.mass, 0.2);
  EXPECT_EQ(vessel.center_of_mass, core_f64::Vec3(7e-3, 45e-3, -4e-3));
}

TEST(Liquid, ShellHoldsAndWeighsWhatTheSolidDoes) {
  for (const VesselData& data : {beaker2(), liquid_bottle(), vase()}) {
    const Vessel solid = ready_vessel(data, true), shell = ready_vessel(shell_of(data), true);
    EXPECT_NE(solid.outline.size(), shell.outline.size());
    EXPECT_EQ(solid.capacity, shell.capacity) << data.name;
    EXPECT_EQ(solid.mass, shell.mass) << data.name;
    EXPECT_EQ(solid.center_of_mass, shell.center_of_mass) << data.name;
    EXPECT_EQ(solid.lip_capacity, shell.lip_capacity) << data.name;
    const double volume = 0.4 * solid.capacity;
    EXPECT_EQ(liquid_at_rest(solid, volume, 0.7).lean, liquid_at_rest(shell, volume, 0.7).lean) << data.name;
  }
}

TEST(Liquid, EverythingScalesWithTheVessel) {
  const Vessel one = ready_vessel(beaker3(), true), twice = ready_vessel(scaled(beaker3(), 2), true);
  EXPECT_NEAR(twice.capacity, 8 * one.capacity, LIQUID_LEVEL_SHARE * twice.capacity);
  EXPECT_NEAR(twice.mass, 8 * one.mass, 1e-12);
  const LiquidState small = liquid_at_rest(one, one.capacity / 3, 0.8), large = liquid_at_rest(twice, twice.capacity / 3, 0.8);
  EXPECT_NEAR(large.lean, 2 * small.lean, LIQUID_CENTER);
  EXPECT_NEAR(large.height, 2 * small.height, LIQUID_CENTER);
}

TEST(Liquid, OptionsSetTheNumberOfQuadraturePoints) {
  const Scene scene = three_beakers();
  EvaluatorOptions few, many;
  few.quadrature_points = 4;
  many.quadrature_points = 64;
  const auto standard = make_core_evaluator(scene), coarse = make_core_evaluator(scene, few),
             fine = make_core_evaluator(scene, many);
  const double exact = fine->liquid(1, 0.5, 0.9).lean;
  EXPECT_NEAR(standard->liquid(1, 0.5, 0.9).lean, exact, LIQUID_CENTER);
  EXPECT_GT(std::abs(coarse->liquid(1, 0.5, 0.9).lean - exact), 1e-12);
}

}  // namespace
}  // namespace wholehand

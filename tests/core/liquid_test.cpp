// SPDX-License-Identifier: MIT
// Kernel 6 against closed forms and against the same volumes integrated another way round (tests/support/liquid_reference.h).
#include "core/liquid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "tests/support/liquid_reference.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

namespace reference = liquid_reference;
using core_f64::LiquidState;
using core_f64::Quadrature;
using core_f64::Slices;
using core_f64::Vec2;
using core_f64::Vessel;
using reference::Wide;

constexpr Wide PI_L = 3.14159265358979323846264338327950288L;

// The inside of beaker1: 77 mm wide, floor at 1.5, mouth at 110 mm.
constexpr double RADIUS = 38.5e-3, FLOOR = 1.5e-3, DEPTH = 108.5e-3;
constexpr Wide CYLINDER = PI_L * RADIUS * RADIUS * DEPTH;

// 1e-10 of the capacity is what is promised of volumes; 1e-9 m of the liquid's centre follows for fills that are not tiny: a centre is
// a moment over a volume, good to 1e-10 of the vessel's 0.1 m over the fill's 0.05.
constexpr double VOLUME_SHARE = 1e-10;
constexpr double CENTER = 1e-9;
// Upright there is no slanted surface, and the closed forms hold to rounding: 1e-12 of the capacity is where levels are stopped.
constexpr double LEVEL_SHARE = 1e-12;

Quadrature quadrature(int points = QUADRATURE_POINTS) { return core_f64::load_quadrature(prepare_quadrature(points)); }

// A bottle with a rounded foot, a shoulder that levels out and a waist: every piece smooth against the next. Its cavity by hand.
VesselData bottle() {
  return vessel_of("bottle",
                   {line_to(20, 0), arc_to(40, 20, 20, 20), line_to(40, 50), arc_to(30, 60, 30, 50), arc_to(20, 70, 30, 70),
                    line_to(20, 100), line_to(0, 100)},
                   2);
}

reference::Cavity bottle_cavity() {
  return {reference::arc_piece(2e-3L, 20e-3L, 20e-3L, 20e-3L, 18e-3L, 1), reference::line_piece(20e-3L, 38e-3L, 50e-3L, 38e-3L),
          reference::arc_piece(50e-3L, 58e-3L, 30e-3L, 50e-3L, 8e-3L, 1),
          reference::arc_piece(58e-3L, 70e-3L, 30e-3L, 70e-3L, 12e-3L, -1), reference::line_piece(70e-3L, 18e-3L, 100e-3L, 18e-3L)};
}

struct Sample {
  std::string name;
  VesselData data;
  reference::Cavity cavity;
  Vessel vessel;
};

const std::vector<Sample>& samples() {
  static const std::vector<Sample> all{{"beaker1", beaker1(), reference::beaker1_cavity(), ready_vessel(beaker1(), true)},
                                       {"beaker2", beaker2(), reference::beaker2_cavity(), ready_vessel(beaker2(), true)},
                                       {"beaker3", beaker3(), reference::beaker3_cavity(), ready_vessel(beaker3(), true)},
                                       {"bottle", bottle(), bottle_cavity(), ready_vessel(bottle(), true)}};
  return all;
}

const Vessel& beaker1_ready() { return samples()[0].vessel; }

Slices below(const Vessel& vessel, double level, double tilt, int points = QUADRATURE_POINTS) {
  return core_f64::liquid_below(vessel, quadrature(points), level, std::sin(tilt), std::cos(tilt));
}

double lip_capacity(const Vessel& vessel, double tilt) {
  return core_f64::lip_capacity(vessel, quadrature(), std::sin(tilt), std::cos(tilt));
}

LiquidState at_rest(const Vessel& vessel, double volume, double tilt) {
  return core_f64::liquid_at(vessel, quadrature(), volume, std::sin(tilt), std::cos(tilt));
}

// The level of a volume by bisection on the core's own volumes, to the last bit.
double level_of(const Vessel& vessel, double volume, double tilt) {
  double low = -1, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (below(vessel, middle, tilt).volume < volume ? low : high) = middle;
  }
  return high;
}

Scene liquid_scene() {
  Scene scene = three_beakers();
  scene.vessels.push_back(bottle());
  return scene;
}

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

Wide radius_at(const reference::Cavity& cavity, Wide y) {
  for (const reference::Piece& piece : cavity) {
    if (y <= piece.high) return reference::radius_at(piece, y);
  }
  return 0;
}

TEST(Liquid, CavityOfTheVesselsIsTheOneDerivedByHand) {
  for (const Sample& s : samples()) {
    const reference::Cavity prepared = reference::cavity_of(prepare_vessel(s.data, true).cavity);
    for (const reference::Piece& piece : s.cavity) {
      for (const Wide share : {0.001L, 0.1L, 0.5L, 0.9L, 0.999L}) {
        const Wide y = piece.low + share * (piece.high - piece.low);
        // 1e-12 m: where an arc runs smoothly into a line their ends are a root of rounding, 1e-8 m, along the tangent
        EXPECT_NEAR(double(radius_at(prepared, y)), double(reference::radius_at(piece, y)), 1e-12) << s.name << " at " << double(y);
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
  EXPECT_NEAR(beaker1_ready().capacity, double(CYLINDER), LEVEL_SHARE * double(CYLINDER));
  for (const Sample& s : samples()) {
    const Wide capacity = reference::revolved(s.cavity).volume;
    EXPECT_NEAR(s.vessel.capacity, double(capacity), VOLUME_SHARE * double(capacity)) << s.name;
  }
}

TEST(Liquid, CapacityOfAConeFrustumIsTheClosedForm) {
  // outline with a slanted wall alone: inside it is a frustum, cut by the floor at 2 and the mouth at 60 mm
  const VesselData cup = vessel_of("cup", {line_to(25, 0), line_to(40, 60), line_to(0, 60)}, 2);
  const Wide slope = 15.0L / 60, shift = 2e-3L * std::sqrt(1 + slope * slope);
  const Wide low = 25e-3L + slope * 2e-3L - shift, high = 40e-3L - shift;
  const Wide volume = PI_L * 58e-3L / 3 * (low * low + low * high + high * high);
  EXPECT_NEAR(ready_vessel(cup, true).capacity, double(volume), LEVEL_SHARE * double(volume));
}

TEST(Liquid, UprightCylinderStandsAtVolumeOverArea) {
  for (const double fill : {0.01, 0.25, 0.5, 0.75, 0.999}) {
    const LiquidState state = at_rest(beaker1_ready(), fill * double(CYLINDER), 0);
    EXPECT_DOUBLE_EQ(state.volume, fill * double(CYLINDER));
    EXPECT_EQ(state.lean, 0);
    EXPECT_NEAR(state.height, FLOOR + fill * DEPTH / 2, 1e-13) << fill;  // 1e-12 of the capacity is 1e-13 m of level
  }
}

TEST(Liquid, UprightSphereIsACap) {
  // R^2 pi h^2 - pi h^3 / 3 under the equator of the flask's body, h above its floor; centre by Archimedes' ratio
  const Wide R = 41e-3L, h = 30e-3L;
  const Wide volume = PI_L * h * h * (3 * R - h) / 3, height = 1.5e-3L + h * (8 * R - 3 * h) / (4 * (3 * R - h));
  const LiquidState state = at_rest(samples()[1].vessel, double(volume), 0);
  EXPECT_NEAR(state.height, double(height), 1e-13);
  EXPECT_NEAR(level_of(samples()[1].vessel, double(volume), 0), 31.5e-3, 1e-13);
}

TEST(Liquid, BrimFullUprightIsTheWholeCavity) {
  for (const Sample& s : samples()) {
    const reference::Body whole = reference::revolved(s.cavity);
    const LiquidState state = at_rest(s.vessel, s.vessel.capacity, 0);
    EXPECT_EQ(state.lean, 0) << s.name;
    EXPECT_NEAR(state.height, double(whole.height), 1e-12) << s.name;  // m: rounding of a moment over a volume
    EXPECT_NEAR(lip_capacity(s.vessel, 0), s.vessel.capacity, LEVEL_SHARE * s.vessel.capacity) << s.name;
  }
}

TEST(Liquid, EmptyVesselHasItsLiquidsCenterAtTheInnerFloor) {
  for (const Sample& s : samples()) {
    for (const double tilt : {0.0, 1e-12, 0.4, PI / 2, 2.0, PI}) {
      const LiquidState state = at_rest(s.vessel, 0, tilt);
      EXPECT_EQ(state.volume, 0);
      EXPECT_EQ(state.lean, 0);
      EXPECT_EQ(state.height, s.vessel.floor_height) << s.name << " " << tilt;
    }
  }
}

// ---- tilted, in closed form ----

// While the surface meets only the wall, the depth over the floor is h + n tan t with h = V / (pi r^2): the moments of a disc give
// lean = r^2 tan t / (4 h), height over the floor = h / 2 + r^2 tan^2 t / (8 h).
TEST(Liquid, TiltedCylinderIsTheClosedFormWhileTheSurfaceMeetsOnlyTheWall) {
  const Wide r = RADIUS;
  for (const double fill : {0.3, 0.5, 0.7}) {
    const Wide h = Wide(fill) * DEPTH, room = std::min(h, DEPTH - h);
    for (const double share : {1e-6, 0.01, 0.3, 0.7, 0.99, 1.0}) {
      const double tilt = std::atan(double(room / r) * share);
      const Wide tangent = std::tan(Wide(tilt)), cosine = std::cos(Wide(tilt));
      const LiquidState state = at_rest(beaker1_ready(), fill * double(CYLINDER), tilt);
      EXPECT_DOUBLE_EQ(state.volume, fill * double(CYLINDER));
      EXPECT_NEAR(state.lean, double(r * r * tangent / (4 * h)), CENTER) << fill << " " << tilt;
      EXPECT_NEAR(state.height, double(FLOOR + h / 2 + r * r * tangent * tangent / (8 * h)), CENTER) << fill << " " << tilt;
      const Slices slices = below(beaker1_ready(), double((FLOOR + h) * cosine), tilt);
      EXPECT_NEAR(slices.volume, double(fill * CYLINDER), VOLUME_SHARE * double(CYLINDER)) << fill << " " << tilt;
      EXPECT_NEAR(slices.surface, double(PI_L * r * r / cosine), 1e-10)
          << fill << " " << tilt;  // m2, of an ellipse of 5e-3 or more
    }
  }
}

TEST(Liquid, SmallTiltsLeanInProportion) {
  const Wide r = RADIUS, h = DEPTH / 2;
  for (const double tilt : {1e-7, 1e-6, 1e-5, 1e-4}) {
    const LiquidState state = at_rest(beaker1_ready(), double(CYLINDER) / 2, tilt);
    // 1e-12 m: a free surface that falls by r t is cut into slices whose ends are known to 1e-17 m
    EXPECT_NEAR(state.lean, double(r * r * std::tan(Wide(tilt)) / (4 * h)), 1e-12) << tilt;
  }
  for (const double tilt : {1e-10, 1e-9, 1e-8}) {
    EXPECT_NEAR(at_rest(beaker1_ready(), double(CYLINDER) / 2, tilt).lean, 0, 1e-10) << tilt;  // m: r^2 t / (4 h) is 7e-11 at most
  }
}

// A surface that cuts the floor at n = x leaves the hoof over [x, r]: depth (n - x) tan t.
struct Hoof {
  Wide volume, lean, height;  // height over the floor
};

Hoof hoof(Wide r, Wide x, Wide tangent) {
  const Wide root = std::sqrt((r - x) * (r + x)), angle = std::acos(x / r);
  const Wide m0 = r * r * angle - x * root, m1 = 2 * root * root * root / 3;       // moments of the segment n >= x
  const Wide m2 = r * r * r * r * angle / 4 + x * root * (r * r - 2 * x * x) / 4;  // of n^2
  const Wide volume = tangent * (m1 - x * m0);
  return {volume, tangent * (m2 - x * m1) / volume, tangent * tangent * (m2 - 2 * x * m1 + x * x * m0) / (2 * volume)};
}

TEST(Liquid, HoofsFormulaIsArchimedes) {
  const Hoof half = hoof(1, 0, 1);  // through the middle of the floor: 2/3 r^3 tan t, lean 3 pi r / 16, height 3 pi r tan t / 32
  EXPECT_NEAR(double(half.volume), 2.0 / 3, 1e-15);
  EXPECT_NEAR(double(half.lean), 3 * PI / 16, 1e-15);
  EXPECT_NEAR(double(half.height), 3 * PI / 32, 1e-15);
}

TEST(Liquid, SurfaceThatCutsTheFloorLeavesAHoof) {
  for (const double tilt : {0.5, 1.0, 1.2, 1.5}) {
    for (const double share : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
      const Wide x = share * RADIUS, tangent = std::tan(Wide(tilt)),
                 level = FLOOR * std::cos(Wide(tilt)) - x * std::sin(Wide(tilt));
      if ((RADIUS - x) * tangent > DEPTH) continue;  // it would cut the mouth as well
      const Hoof expected = hoof(RADIUS, x, tangent);
      const Slices slices = below(beaker1_ready(), double(level), tilt);
      EXPECT_NEAR(slices.volume, double(expected.volume), VOLUME_SHARE * double(CYLINDER)) << tilt << " " << share;
      const LiquidState state = at_rest(beaker1_ready(), double(expected.volume), tilt);
      EXPECT_NEAR(state.lean, double(expected.lean), CENTER) << tilt << " " << share;
      EXPECT_NEAR(state.height, double(FLOOR + expected.height), CENTER) << tilt << " " << share;
    }
  }
}

TEST(Liquid, SurfaceThatCutsTheMouthLacksAHoof) {
  const Wide moment_of_all = CYLINDER * (FLOOR + DEPTH / 2.0L);
  for (const double tilt : {0.5, 1.0, 1.2}) {
    for (const double share : {-0.9, -0.2, 0.4}) {
      // the air over the surface is a hoof that hangs from the mouth on the other side
      const Wide x = share * RADIUS, tangent = std::tan(Wide(tilt));
      if ((RADIUS - x) * tangent > DEPTH) continue;
      const Hoof air = hoof(RADIUS, x, tangent);
      const Slices slices = below(beaker1_ready(), double((FLOOR + DEPTH) * std::cos(Wide(tilt)) + x * std::sin(Wide(tilt))), tilt);
      const Wide volume = CYLINDER - air.volume;
      EXPECT_NEAR(slices.volume, double(volume), VOLUME_SHARE * double(CYLINDER)) << tilt << " " << share;
      EXPECT_NEAR(slices.lean, double(air.volume * air.lean), 1e-10 * double(CYLINDER) * RADIUS) << tilt << " " << share;
      EXPECT_NEAR(slices.height, double(moment_of_all - air.volume * (FLOOR + DEPTH - air.height)),
                  1e-10 * double(CYLINDER) * DEPTH)
          << tilt << " " << share;
    }
  }
}

TEST(Liquid, LiquidInASphereIsTheSameAtEveryTilt) {
  // a cap of depth h that stays clear of the neck and under the lip up to the tilt beside it
  for (const auto& [h, last] : {std::pair<Wide, int>{5e-3L, 100}, {10e-3L, 95}, {20e-3L, 90}}) {
    const Wide R = 41e-3L, volume = PI_L * h * h * (3 * R - h) / 3;
    const Wide under = R - h * (8 * R - 3 * h) / (4 * (3 * R - h));  // of its centre under the sphere's
    for (int whole = 0; whole <= last; whole += 5) {
      const double tilt = radians(whole);
      const LiquidState state = at_rest(samples()[1].vessel, double(volume), tilt);
      EXPECT_NEAR(state.lean, double(under * std::sin(Wide(tilt))), CENTER) << whole;
      EXPECT_NEAR(state.height, double(42.5e-3L - under * std::cos(Wide(tilt))), CENTER) << whole;
    }
  }
}

TEST(Liquid, AtNinetyDegreesACylinderHoldsSegmentsAlongItsWholeLength) {
  for (const double share : {-0.7, 0.0, 0.6}) {
    const Wide x = share * RADIUS;
    const Slices slices = below(beaker1_ready(), double(-x), PI / 2);  // n >= x
    const Wide area = RADIUS * RADIUS * std::acos(Wide(share)) - x * std::sqrt(Wide(RADIUS) * RADIUS - x * x);
    EXPECT_NEAR(slices.volume, double(area * DEPTH), LEVEL_SHARE * double(CYLINDER)) << share;
    EXPECT_NEAR(slices.height, double(area * DEPTH * (FLOOR + DEPTH / 2.0L)), LEVEL_SHARE * double(CYLINDER) * DEPTH) << share;
    EXPECT_NEAR(slices.surface, double(2 * std::sqrt(Wide(RADIUS) * RADIUS - x * x) * DEPTH), 1e-12) << share;  // m2, of 8e-3
  }
}

TEST(Liquid, UpsideDownTheVolumeUnderALevelLiesAtTheMouth) {
  for (const Sample& s : samples()) {
    const double level = -0.6 * s.data.height;  // everything above y = 0.6 of the height
    reference::Cavity upper;
    for (reference::Piece piece : s.cavity) {
      if (piece.high <= -level) continue;
      if (piece.low < -level) {
        piece.low_radius = reference::radius_at(piece, -level);
        piece.low = -level;
      }
      upper.push_back(piece);
    }
    const reference::Body body = reference::revolved(upper);
    const Slices slices = below(s.vessel, level, PI);
    EXPECT_NEAR(slices.volume, double(body.volume), LEVEL_SHARE * s.vessel.capacity) << s.name;
    EXPECT_NEAR(slices.height, double(body.volume * body.height), LEVEL_SHARE * s.vessel.capacity * s.data.height) << s.name;
  }
}

// ---- tilted, against the other integration ----

TEST(Liquid, TheReferenceItselfMeetsTheClosedForms) {
  const Wide tilt = 0.6L, tangent = std::tan(tilt), h = DEPTH / 2.0L;
  const reference::Body body = reference::below(reference::beaker1_cavity(), (FLOOR + h) * std::cos(tilt), tilt);
  EXPECT_NEAR(double(body.volume / CYLINDER), 0.5, 1e-14);
  EXPECT_NEAR(double(body.lean), double(Wide(RADIUS) * RADIUS * tangent / (4 * h)), 1e-15);
  for (const Sample& s : samples()) {
    const reference::Body whole = reference::revolved(s.cavity);
    for (const Wide t : {0.0L, 0.9L, 2.0L}) {  // everything is under a level of 1 m
      const reference::Body all = reference::below(s.cavity, 1, t);
      EXPECT_NEAR(double(all.volume / whole.volume), 1, 1e-13) << s.name;
      EXPECT_NEAR(double(all.height), double(whole.height), 1e-14) << s.name;
    }
  }
}

TEST(Liquid, VolumeIsConservedOverAllTiltsUntilTheLip) {
  int states = 0;
  for (const Sample& s : samples()) {
    for (const double fill : {0.02, 0.25, 0.5, 0.75, 0.98}) {
      const double volume = fill * s.vessel.capacity;
      for (double degree = 1; degree < 180; degree += 7.3) {
        const double tilt = radians(degree);
        if (lip_capacity(s.vessel, tilt) < volume) break;
        const reference::Body body = reference::below(s.cavity, level_of(s.vessel, volume, tilt), tilt);
        const LiquidState state = at_rest(s.vessel, volume, tilt);
        EXPECT_NEAR(double(body.volume), volume, VOLUME_SHARE * s.vessel.capacity) << s.name << " " << fill << " " << degree;
        EXPECT_NEAR(double(body.lean), state.lean, CENTER) << s.name << " " << fill << " " << degree;
        EXPECT_NEAR(double(body.height), state.height, CENTER) << s.name << " " << fill << " " << degree;
        ++states;
      }
    }
  }
  EXPECT_GT(states, 150);
}

// A tilt at which the lip holds something, and a level between the bottom and the lip.
std::pair<double, double> random_state(const Vessel& vessel, Random& random) {
  for (;;) {
    const double tilt = random.uniform(0.001, PI - 0.001), sine = std::sin(tilt), cosine = std::cos(tilt);
    const double bottom = core_f64::bottom_level(vessel, sine, cosine), lip = core_f64::lip_level(vessel, sine, cosine);
    if (lip > bottom) return {tilt, bottom + (lip - bottom) * random.uniform(0, 1)};
  }
}

TEST(Liquid, VolumeUnderAnyLevelUpToTheLipIsThatOfTheOtherIntegration) {
  Random random(61);
  for (const Sample& s : samples()) {
    for (int i = 0; i < 60; ++i) {
      const auto [tilt, level] = random_state(s.vessel, random);
      const reference::Body body = reference::below(s.cavity, level, tilt);
      EXPECT_NEAR(below(s.vessel, level, tilt).volume, double(body.volume), VOLUME_SHARE * s.vessel.capacity)
          << s.name << " level " << level << " tilt " << tilt;
    }
  }
}

// The level's tolerance, 1e-12 of the capacity, and rounding.
void expect_level(const VesselData& data, const Vessel& vessel, double volume, double tilt) {
  const LiquidState state = at_rest(vessel, volume, tilt);
  EXPECT_NEAR(below(vessel, state.level, tilt).volume, volume, 1e-11 * vessel.capacity)
      << data.name << ", tilt " << degrees(tilt) << ", " << volume / vessel.capacity << " of the capacity";
}

TEST(Liquid, LevelHoldsItsVolumeAtEveryFillAndTilt) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), bottle(), vase()}) {
    const Vessel vessel = ready_vessel(data, true);
    for (const double tilt : {0.0, radians(7), radians(49), radians(70)}) {
      const double lip = lip_capacity(vessel, tilt);
      for (int k = 1; k < 20 && lip > 0; ++k) expect_level(data, vessel, k / 20.0 * lip, tilt);
    }
  }
}

// A wide body under a narrow neck. From about 65.17 % on, for less than a thousandth of the capacity, Newton's steps alone go to and fro
// between the two until all are spent: each stays in a bracket that hardly shrinks.
TEST(Liquid, LevelBetweenAWideBodyAndANarrowNeckIsFound) {
  const VesselData thick = vessel_of("thick",
                                     {line_to(24.6689337, 0), line_to(24.6689337, 8.07939779), line_to(9.1716877, 16.206503),
                                      line_to(9.1716877, 34.9939849), line_to(0, 34.9939849)},
                                     6.11534834);
  const Vessel vessel = ready_vessel(thick, true);
  for (int k = 0; k <= 40; ++k) expect_level(thick, vessel, (0.651 + 5e-5 * k) * vessel.capacity, radians(36.2097766));
}

TEST(Liquid, TwelvePiecesWithArcsAndCornersAreIntegratedAsWell) {
  const Vessel vessel = ready_vessel(vase(), true);
  const reference::Cavity cavity = reference::cavity_of(prepare_vessel(vase(), true).cavity);
  EXPECT_NEAR(vessel.capacity, double(reference::revolved(cavity).volume), VOLUME_SHARE * vessel.capacity);
  Random random(62);
  for (int i = 0; i < 40; ++i) {
    const auto [tilt, level] = random_state(vessel, random);
    EXPECT_NEAR(below(vessel, level, tilt).volume, double(reference::below(cavity, level, tilt).volume),
                VOLUME_SHARE * vessel.capacity)
        << "level " << level << " tilt " << tilt;
  }
}

TEST(Liquid, MorePointsApproachTheReference) {
  for (const Sample& s : samples()) {
    Random random(64);
    std::array<double, 5> worst{};
    const std::array<int, 5> points{4, 8, 16, 32, 64};
    for (int i = 0; i < 60; ++i) {
      const auto [tilt, level] = random_state(s.vessel, random);
      const double volume = double(reference::below(s.cavity, level, tilt).volume);
      for (std::size_t k = 0; k < points.size(); ++k) {
        worst[k] = std::max(worst[k], std::abs(below(s.vessel, level, tilt, points[k]).volume - volume) / s.vessel.capacity);
      }
    }
    for (std::size_t k = 1; k < points.size(); ++k) {
      EXPECT_LT(worst[k], std::max(worst[k - 1], 1e-14)) << s.name << " " << points[k];  // 1e-14: rounding stays
    }
    EXPECT_LT(worst[4], LEVEL_SHARE) << s.name;
  }
}

TEST(Liquid, FreeSurfaceIsTheDerivativeOfTheVolumeByTheLevel) {
  Random random(63);
  int compared = 0;
  for (const Sample& s : samples()) {
    for (int i = 0; i < 60; ++i) {
      const double tilt = i == 0 ? 0 : i == 1 ? PI / 2 : random.uniform(0, PI), step = 1e-6;
      const double level = random.uniform(-0.04, 0.1);
      // a kink of the area within the step (a corner of the wall, the edge of mouth or floor) has no derivative: leave such levels out
      const double before = below(s.vessel, level - step, tilt).surface, after = below(s.vessel, level + step, tilt).surface;
      if (std::abs(after - before) > 1e-6) continue;
      compared += after > 0;
      const double slope = (below(s.vessel, level + step, tilt).volume - below(s.vessel, level - step, tilt).volume) / (2 * step);
      // 1e-7 m2 of 5e-3: what a kink of at most 1e-6 m2 within the step leaves, and volumes rounded to 1e-19 m3 over 2e-6 m
      EXPECT_NEAR(below(s.vessel, level, tilt).surface, slope, 1e-7) << s.name << " level " << level << " tilt " << tilt;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Liquid, NothingLiesUnderTheBottomLevel) {
  for (const Sample& s : samples()) {
    for (double degree = 0; degree <= 180; degree += 7.5) {
      const double tilt = radians(degree), sine = std::sin(tilt), cosine = std::cos(tilt);
      double lowest = s.vessel.floor_height * cosine;  // the floor's middle
      for (const reference::Piece& piece : s.cavity) {
        for (int k = 0; k <= 1000; ++k) {
          const Wide y = piece.low + (piece.high - piece.low) * k / 1000;
          lowest = std::min(lowest, double(cosine * y - sine * reference::radius_at(piece, y)));
        }
      }
      const double bottom = core_f64::bottom_level(s.vessel, sine, cosine);
      EXPECT_LE(bottom, lowest + 1e-15) << s.name << " " << degree;
      EXPECT_NEAR(below(s.vessel, bottom, tilt).volume, 0, LEVEL_SHARE * s.vessel.capacity) << s.name << " " << degree;
    }
  }
}

TEST(Liquid, ATraceOfLiquidLiesInTheLowestCorner) {
  const double volume = 1e-12 * double(CYLINDER);
  for (const double degree : {0.0, 1.0, 45.0, 89.0}) {
    const LiquidState state = at_rest(beaker1_ready(), volume, radians(degree));
    EXPECT_EQ(state.volume, volume);
    EXPECT_NEAR(state.lean, degree == 0 ? 0 : RADIUS, 1e-4) << degree;  // m: 5e-16 m3 on one degree reach 0.1 mm from the corner
    EXPECT_NEAR(state.height, FLOOR, 1e-4) << degree;
  }
}

// ---- pouring ----

TEST(Liquid, LipHoldsWhatLiesUnderTheMouthsLowestPoint) {
  for (const double degree : {5.0, 30.0, 54.0}) {  // the surface meets only the wall: h = depth - r tan t
    const Wide tangent = std::tan(Wide(radians(degree)));
    EXPECT_NEAR(lip_capacity(beaker1_ready(), radians(degree)), double(PI_L * RADIUS * RADIUS * (DEPTH - RADIUS * tangent)),
                VOLUME_SHARE * double(CYLINDER))
        << degree;
  }
  for (const double degree : {55.0, 70.0, 85.0, 89.9}) {  // a hoof that reaches the mouth
    const Wide tangent = std::tan(Wide(radians(degree)));
    EXPECT_NEAR(lip_capacity(beaker1_ready(), radians(degree)), double(hoof(RADIUS, RADIUS - DEPTH / tangent, tangent).volume),
                VOLUME_SHARE * double(CYLINDER))
        << degree;
  }
  for (const Sample& s : samples()) {
    for (double degree = 2.5; degree < 180; degree += 12.5) {
      const Wide tilt = radians(degree);
      EXPECT_NEAR(lip_capacity(s.vessel, radians(degree)),
                  double(reference::below(s.cavity, reference::lip_level(s.cavity, tilt), tilt).volume),
                  VOLUME_SHARE * s.vessel.capacity)
          << s.name << " " << degree;
    }
  }
}

TEST(Liquid, LipCapacityNeverGrowsWithTheTilt) {
  for (const Sample& s : samples()) {
    ASSERT_EQ(s.vessel.lip_capacity.size(), WHOLE_DEGREES);
    double last = s.vessel.capacity;
    for (double degree = 0; degree <= 180; degree += 0.5) {
      const double capacity = lip_capacity(s.vessel, radians(degree));
      EXPECT_LE(capacity, last + LEVEL_SHARE * s.vessel.capacity) << s.name << " " << degree;
      EXPECT_GE(capacity, 0) << s.name << " " << degree;
      last = capacity;
      if (degree == std::floor(degree)) {
        EXPECT_NEAR(s.vessel.lip_capacity[std::size_t(degree)], capacity, LEVEL_SHARE * s.vessel.capacity)
            << s.name << " " << degree;
      }
    }
    EXPECT_EQ(lip_capacity(s.vessel, PI), 0) << s.name;
  }
}

TEST(Liquid, RemainingIsTheFillOrWhatTheLipHoldsAndTheRestHasPoured) {
  const Scene scene = liquid_scene();
  const auto evaluator = make_core_evaluator(scene);
  for (std::size_t v = 0; v < samples().size(); ++v) {
    const Sample& s = samples()[v];
    for (const double fill : {0.0, 0.25, 0.5, 1.0}) {
      const double given = fill * s.vessel.capacity;
      double last = given;
      for (double degree = 0; degree <= 180; degree += 4.5) {
        const LiquidResult result = evaluator->liquid(v, fill, radians(degree));
        const double held = std::min(given, lip_capacity(s.vessel, radians(degree)));
        EXPECT_NEAR(result.volume, held, LEVEL_SHARE * s.vessel.capacity) << s.name << " " << fill << " " << degree;
        EXPECT_NEAR(result.poured, given - result.volume, LEVEL_SHARE * s.vessel.capacity)
            << s.name << " " << fill << " " << degree;
        EXPECT_GE(result.poured, 0);
        EXPECT_DOUBLE_EQ(result.mass, 1000 * result.volume);
        EXPECT_LE(result.volume, last) << s.name << " " << fill << " " << degree;
        const LiquidState state = at_rest(s.vessel, result.volume, radians(degree));
        EXPECT_NEAR(result.lean, state.lean, 1e-9);  // m: one stopping tolerance of the level apart
        EXPECT_NEAR(result.height, state.height, 1e-9);
        last = result.volume;
      }
    }
  }
}

TEST(Liquid, CenterOfAVesselThatPoursIsThatUnderTheLip) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < samples().size(); ++v) {
    const reference::Cavity& cavity = samples()[v].cavity;
    for (const double degree : {20.0, 47.5, 66.0, 81.0, 88.0}) {
      const Wide tilt = radians(degree);
      const reference::Body body = reference::below(cavity, reference::lip_level(cavity, tilt), tilt);
      const LiquidResult result = evaluator->liquid(v, 1, radians(degree));
      ASSERT_GT(result.poured, 0);
      EXPECT_NEAR(result.lean, double(body.lean), CENTER) << v << " " << degree;
      EXPECT_NEAR(result.height, double(body.height), CENTER) << v << " " << degree;
    }
  }
}

TEST(Liquid, AtNinetyDegreesAFullCylinderIsEmptyAndABellyKeepsItsPuddle) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  const LiquidResult cylinder_left = evaluator->liquid(0, 1, PI / 2);
  EXPECT_EQ(cylinder_left.mass, 0);
  EXPECT_EQ(cylinder_left.height, FLOOR);
  EXPECT_NEAR(cylinder_left.poured, double(CYLINDER), LEVEL_SHARE * double(CYLINDER));
  // the bottle's belly below the neck's radius of 18: a straight part of 30 mm is a segment; the rest by the other integration
  const LiquidResult puddle = evaluator->liquid(3, 1, PI / 2);
  const reference::Body body = reference::below(bottle_cavity(), -18e-3L, PI_L / 2);
  const Wide segment = 38e-3L * 38e-3L * std::acos(18.0L / 38) - 18e-3L * std::sqrt(38e-3L * 38e-3L - 18e-3L * 18e-3L);
  EXPECT_GT(double(body.volume), double(segment * 30e-3L));
  EXPECT_NEAR(puddle.volume, double(body.volume), VOLUME_SHARE * samples()[3].vessel.capacity);
}

TEST(Liquid, UpsideDownNothingIsLeft) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < samples().size(); ++v) {
    for (const double fill : {0.0, 1e-12, 0.5, 1.0}) {
      const LiquidResult result = evaluator->liquid(v, fill, PI);
      EXPECT_EQ(result.volume, 0);
      EXPECT_EQ(result.mass, 0);
      EXPECT_EQ(result.lean, 0);
      EXPECT_EQ(result.height, samples()[v].vessel.floor_height);
      EXPECT_DOUBLE_EQ(result.poured, fill * samples()[v].vessel.capacity);
    }
  }
}

TEST(Liquid, WhatPoursAtASmallerTiltIsGoneAtALargerOne) {
  // at and between whole degrees, never more than at any smaller tilt
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < samples().size(); ++v) {
    double least = samples()[v].vessel.capacity;
    for (int degree = 0; degree <= 180; ++degree) {
      least = std::min(least, evaluator->liquid(v, 1, radians(degree)).volume);
      EXPECT_LE(evaluator->liquid(v, 1, radians(degree) + 0.001 * (degree < 180)).volume, least) << v << " " << degree;
    }
  }
}

TEST(Liquid, HalfFullCylinderPoursWhereTheDiagonalIsLevel) {
  const auto evaluator = make_core_evaluator(three_beakers());
  // 1e-9 rad: the capacity falls by pi r^3 / cos^2 t per rad there, so that 1e-12 of it are far less
  EXPECT_NEAR(evaluator->pouring_tilt(0, 0.5), std::atan(DEPTH / (2 * RADIUS)), 1e-9);
  EXPECT_NEAR(evaluator->pouring_tilt(0, 0.75), std::atan(DEPTH / (4 * RADIUS)), 1e-9);
  EXPECT_NEAR(evaluator->pouring_tilt(0, 0.999), std::atan(0.001 * DEPTH / RADIUS), 1e-9);
}

TEST(Liquid, PouringStartsWhereTheLipHoldsExactlyTheFill) {
  const auto evaluator = make_core_evaluator(liquid_scene());
  for (std::size_t v = 0; v < samples().size(); ++v) {
    const Sample& s = samples()[v];
    double last = PI;
    for (const double fill : {0.01, 0.1, 0.25, 0.5, 0.75, 0.9}) {
      const double tilt = evaluator->pouring_tilt(v, fill);
      EXPECT_LE(tilt, last) << s.name << " " << fill;
      EXPECT_NEAR(double(reference::below(s.cavity, reference::lip_level(s.cavity, tilt), tilt).volume), fill * s.vessel.capacity,
                  VOLUME_SHARE * s.vessel.capacity)
          << s.name << " " << fill;
      last = tilt;
    }
    EXPECT_NEAR(evaluator->pouring_tilt(v, 1), 0, 1e-8) << s.name;  // rad: under a sine of 1e-9 a vessel counts as upright
    EXPECT_TRUE(std::isnan(evaluator->pouring_tilt(v, 0))) << s.name;
  }
}

// ---- glass ----

reference::Cavity hull_of(const VesselData& data) {
  std::vector<PreparedElement> wall = prepare_vessel(data, true).hull;
  wall.pop_back();  // the mouth
  return reference::cavity_of(wall);
}

TEST(Liquid, GlassOfACylinderIsAHollowCylinderWithAFloor) {
  const Wide outer = PI_L * 40e-3L * 40e-3L * 110e-3L, volume = outer - CYLINDER;
  const Wide center = (outer * 55e-3L - CYLINDER * (FLOOR + DEPTH / 2.0L)) / volume;
  EXPECT_NEAR(beaker1_ready().mass, double(2230 * volume), 1e-12);  // kg, of 0.1: rounding
  EXPECT_NEAR(beaker1_ready().center_of_mass.y, double(center), 1e-12);
  EXPECT_EQ(beaker1_ready().center_of_mass.x, 0);
  EXPECT_EQ(beaker1_ready().center_of_mass.z, 0);
}

TEST(Liquid, GlassIsTheHullLessTheCavity) {
  for (const Sample& s : samples()) {
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
  for (const VesselData& data : {beaker2(), bottle(), vase()}) {
    const Vessel solid = ready_vessel(data, true), shell = ready_vessel(shell_of(data), true);
    EXPECT_NE(solid.outline.size(), shell.outline.size());
    EXPECT_EQ(solid.capacity, shell.capacity) << data.name;
    EXPECT_EQ(solid.mass, shell.mass) << data.name;
    EXPECT_EQ(solid.center_of_mass, shell.center_of_mass) << data.name;
    EXPECT_EQ(solid.lip_capacity, shell.lip_capacity) << data.name;
    const double volume = 0.4 * solid.capacity;
    EXPECT_EQ(at_rest(solid, volume, 0.7).lean, at_rest(shell, volume, 0.7).lean) << data.name;
  }
}

TEST(Liquid, EverythingScalesWithTheVessel) {
  const Vessel one = ready_vessel(beaker3(), true), twice = ready_vessel(scaled(beaker3(), 2), true);
  EXPECT_NEAR(twice.capacity, 8 * one.capacity, LEVEL_SHARE * twice.capacity);
  EXPECT_NEAR(twice.mass, 8 * one.mass, 1e-12);
  const LiquidState small = at_rest(one, one.capacity / 3, 0.8), large = at_rest(twice, twice.capacity / 3, 0.8);
  EXPECT_NEAR(large.lean, 2 * small.lean, CENTER);
  EXPECT_NEAR(large.height, 2 * small.height, CENTER);
}

TEST(Liquid, OptionsSetTheNumberOfQuadraturePoints) {
  const Scene scene = three_beakers();
  EvaluatorOptions few, many;
  few.quadrature_points = 4;
  many.quadrature_points = 64;
  const auto standard = make_core_evaluator(scene), coarse = make_core_evaluator(scene, few),
             fine = make_core_evaluator(scene, many);
  const double exact = fine->liquid(1, 0.5, 0.9).lean;
  EXPECT_NEAR(standard->liquid(1, 0.5, 0.9).lean, exact, CENTER);
  EXPECT_GT(std::abs(coarse->liquid(1, 0.5, 0.9).lean - exact), 1e-12);
}

}  // namespace
}  // namespace wholehand

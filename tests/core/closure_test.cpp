// SPDX-License-Identifier: MIT
// Kernel 3: thumb and index finger close on a line through the vessel, and the hand is placed at them. Cylinders have closed forms.
#include "core/closure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/evaluator.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::Closing;
using core_f64::Vec3;

// 1e-8 m: a tip stops within 1e-9 m of its distance, which is 1 / cos(contact angle) along the line: under 10 where not grazing.
constexpr double STOPPED = 1e-8;
constexpr double INDEX_RADIUS = 7e-3, THUMB_RADIUS = 8e-3;  // of the default hand's tips

struct Ready {
  Ready(const VesselData& vessel_data, const HandData& hand_data = {})
      : hand(ready_hand(hand_data)), vessel(ready_vessel(vessel_data)) {}
  Closing close(const GripInput& grip) const { return core_f64::close_fingers(hand, vessel, ready_grip(grip)); }
  core_f64::Hand hand;
  core_f64::Vessel vessel;
};

GripInput grip_of(double height_mm, double obliquity_deg = 0, double offset_mm = 0, double roll_deg = 0, double azimuth_deg = 0) {
  GripInput grip;
  grip.height = height_mm * 1e-3;
  grip.obliquity = radians(obliquity_deg);
  grip.offset = offset_mm * 1e-3;
  grip.roll = radians(roll_deg);
  grip.azimuth = radians(azimuth_deg);
  return grip;
}

// t at which a ray against a cylinder of radius R + r, the line passing its axis at s and climbing by b, meets it.
double cylinder_hit(double R, double r, double s, double b) { return std::sqrt((R + r) * (R + r) - s * s) / std::cos(b); }

Long3 direction_of(const GripInput& grip) { return rotation_y(grip.azimuth) * (rotation_z(grip.obliquity) * Long3{1, 0, 0}); }

Long3 foot_of(const GripInput& grip) {
  const Long3 side = cross(direction_of(grip), {0, 1, 0});
  return Long3{0, grip.height, 0} + (grip.offset / length(side)) * side;
}

// ---- where the tips stop ----

TEST(Closure, StraightGapIsTheDiameterAndBothRadii) {
  const Ready beaker(beaker1());
  for (const double height : {20.0, 55.0, 95.0}) {
    const Closing closing = beaker.close(grip_of(height));
    ASSERT_EQ(closing.reason, REASON_NONE);
    EXPECT_NEAR(closing.t_index, 40e-3 + INDEX_RADIUS, STOPPED);  // each tip its own radius
    EXPECT_NEAR(closing.t_thumb, -40e-3 - THUMB_RADIUS, STOPPED);
    EXPECT_NEAR(closing.gap, 95e-3, STOPPED);
    EXPECT_LT(glm::distance(closing.midpoint, {-0.5e-3, height * 1e-3, 0}), STOPPED);
  }
}

TEST(Closure, OffsetGapIsAChord) {
  const Ready beaker(beaker1());
  for (const double offset : {-30.0, -12.0, 0.0, 5.0, 30.0}) {
    const Closing closing = beaker.close(grip_of(55, 0, offset));
    ASSERT_EQ(closing.reason, REASON_NONE) << offset;
    const double index = cylinder_hit(40e-3, INDEX_RADIUS, offset * 1e-3, 0),
                 thumb = cylinder_hit(40e-3, THUMB_RADIUS, offset * 1e-3, 0);
    EXPECT_NEAR(closing.t_index, index, STOPPED);
    EXPECT_NEAR(closing.t_thumb, -thumb, STOPPED);
    EXPECT_NEAR(closing.gap, index + thumb, STOPPED);
    // d = x, so the line is moved along x cross y = z
    EXPECT_LT(glm::distance(closing.midpoint, {(index - thumb) / 2, 55e-3, offset * 1e-3}), STOPPED);
  }
}

TEST(Closure, ObliqueGapIsAnEllipse) {
  const Ready narrow(cylinder("narrow", 60, 110, 1.5));
  for (const double obliquity : {-25.0, -10.0, 10.0, 20.0}) {
    for (const double offset : {-15.0, 0.0, 20.0}) {
      for (const double azimuth : {0.0, 73.0, -160.0}) {
        const GripInput grip = grip_of(55, obliquity, offset, 10, azimuth);
        const Closing closing = narrow.close(grip);
        ASSERT_EQ(closing.reason, REASON_NONE);
        const double index = cylinder_hit(30e-3, INDEX_RADIUS, grip.offset, grip.obliquity);
        const double thumb = cylinder_hit(30e-3, THUMB_RADIUS, grip.offset, grip.obliquity);
        EXPECT_NEAR(closing.t_index, index, STOPPED);
        EXPECT_NEAR(closing.t_thumb, -thumb, STOPPED);
        EXPECT_NEAR(closing.gap, index + thumb, STOPPED);
        EXPECT_LT(length(widened(closing.direction) - direction_of(grip)), 1e-15);  // rounding of unit vectors
        const Long3 midpoint = foot_of(grip) + (index - thumb) / 2 * direction_of(grip);
        EXPECT_LT(length(widened(closing.midpoint) - midpoint), STOPPED);
      }
    }
  }
}

TEST(Closure, DirectionIsRyOfAzimuthRzOfObliquity) {
  for (const double azimuth : {-3.0, -0.4, 0.0, 1.1, 3.14}) {
    for (const double obliquity : {-1.5, -0.3, 0.0, 0.9}) {
      const Vec3 d = core_f64::grip_direction(azimuth, obliquity);
      EXPECT_LT(length(widened(d) - rotation_y(azimuth) * (rotation_z(obliquity) * Long3{1, 0, 0})), 1e-15);  // rounding
    }
  }
}

TEST(Closure, TipsAreScaledWithTheHand) {
  const Ready beaker(cylinder("stick", 30, 110, 1.5));
  for (const double scale : {0.5, 0.9, 1.4}) {
    GripInput grip = grip_of(55);
    grip.hand_scale = scale;
    const Closing closing = beaker.close(grip);
    ASSERT_EQ(closing.reason, REASON_NONE) << scale;
    EXPECT_NEAR(closing.t_index, 15e-3 + scale * INDEX_RADIUS, STOPPED);
    EXPECT_NEAR(closing.t_thumb, -15e-3 - scale * THUMB_RADIUS, STOPPED);
    EXPECT_NEAR(scale * core_f64::gap_at(beaker.hand, closing.closure), closing.gap, STOPPED);
  }
}

TEST(Closure, BarePointsTouchTheSurfaceItself) {
  HandData bare;
  for (FingerData& finger : bare.fingers) finger.radii = {};
  const Closing closing = Ready(beaker1(), bare).close(grip_of(55, 0, 10));
  ASSERT_EQ(closing.reason, REASON_NONE);
  EXPECT_NEAR(closing.t_index, cylinder_hit(40e-3, 0, 10e-3, 0), STOPPED);
  EXPECT_NEAR(closing.t_thumb, -cylinder_hit(40e-3, 0, 10e-3, 0), STOPPED);
}

TEST(Closure, ClosureIsTheInverseOfTheGap) {
  for (const VesselData& vessel : {beaker1(), vase(), ledges()}) {
    const Ready ready(vessel);
    int feasible = 0;
    for (const GripInput& grip : sample_grips(vessel, 100, 21)) {
      const Closing closing = ready.close(grip);
      if (closing.reason != REASON_NONE) continue;
      ++feasible;
      EXPECT_NEAR(static_cast<double>(reference_gap({}, closing.closure)), closing.gap, 2e-9);  // twice the stop tolerance
    }
    EXPECT_GT(feasible, 50) << vessel.name;
  }
}

TEST(Closure, TraceFindsTheFirstHitOfADenseScan) {
  for (const VesselData& data : {beaker3(), vase(), ledges(), shell_of(vase())}) {
    const core_f64::Vessel vessel = ready_vessel(data);
    Random random(22);
    int hits = 0, misses = 0, grazing = 0;
    for (int n = 0; n < 150; ++n) {
      const Vec3 d = core_f64::grip_direction(random.uniform(-PI, PI), radians(random.uniform(-80, 80)));
      const Vec3 o{random.uniform(-50e-3, 50e-3), random.uniform(-10e-3, data.height + 10e-3), random.uniform(-50e-3, 50e-3)};
      const double radius = n % 3 == 0 ? 0 : random.uniform(1e-3, 9e-3), heading = n % 2 ? 1 : -1;
      const auto separation = [&](double t) { return core_f64::signed_distance(vessel, o + t * d) - radius; };
      // from 0.4 m away to as far behind, 0.2 mm a step; a separation cannot change by more than that
      double t = heading * 0.4, least = 1;
      const double step = 0.2e-3;
      while (heading * t > -0.4 && separation(t) > 0) {
        least = std::min(least, separation(t));
        t -= heading * step;
      }
      const core_f64::Trace trace = core_f64::trace_tip(vessel, o, d, heading, radius);
      if (separation(t) > 0) {
        if (least < step) {  // a hit may hide between two steps
          ++grazing;
          continue;
        }
        ++misses;
        ASSERT_EQ(trace.reason, REASON_MISSES) << data.name << ", line " << n;
        continue;
      }
      double outside = t + heading * step;
      for (int i = 0; i < 60; ++i) {
        const double middle = (outside + t) / 2;
        (separation(middle) > 0 ? outside : t) = middle;
      }
      int element = -1;
      const double slope = glm::dot(core_f64::distance_gradient(vessel, o + outside * d, element), d);
      if (std::abs(slope) < 0.1 || (least < 1e-6 && trace.reason == REASON_NOT_CONVERGED)) {
        ++grazing;
        continue;
      }
      ++hits;
      ASSERT_EQ(trace.reason, REASON_NONE) << data.name << ", line " << n;
      ASSERT_NEAR(trace.t, outside, STOPPED) << data.name << ", line " << n;  // slope over 0.1
    }
    EXPECT_GT(hits, 50) << data.name;
    EXPECT_GT(misses, 10) << data.name;
    EXPECT_LT(grazing, 15) << data.name;
  }
}

TEST(Closure, TipStopsOffTheRimAsASphereDoes) {
  // just above the mouth's edge a tip of radius r at height e over it stops where e^2 + (x - R)^2 = r^2
  const Ready beaker(beaker1());
  for (const double above : {1.0, 3.0, 6.0}) {
    const Closing closing = beaker.close(grip_of(110 + above));
    ASSERT_EQ(closing.reason, REASON_NONE) << above;
    EXPECT_NEAR(closing.t_index, 40e-3 + std::sqrt(INDEX_RADIUS * INDEX_RADIUS - above * above * 1e-6), STOPPED);
    EXPECT_NEAR(closing.t_thumb, -40e-3 - std::sqrt(THUMB_RADIUS * THUMB_RADIUS - above * above * 1e-6), STOPPED);
  }
}

// ---- why a grip is not feasible, in this order ----

TEST(Closure, DegenerateWithinANanoradianOfTheAxis) {
  const Ready beaker(beaker1());
  for (const double sign : {-1.0, 1.0}) {
    GripInput grip = grip_of(55);
    grip.obliquity = sign * PI / 2;
    EXPECT_EQ(beaker.close(grip).reason, REASON_DEGENERATE);
    grip.obliquity = sign * (PI / 2 - 0.5e-9);
    EXPECT_EQ(beaker.close(grip).reason, REASON_DEGENERATE);
    grip.obliquity = sign * (PI / 2 - 2e-9);
    EXPECT_NE(beaker.close(grip).reason, REASON_DEGENERATE);
    grip.obliquity = sign * PI / 2;  // before everything else: this one would miss as well
    grip.offset = 1;
    EXPECT_EQ(beaker.close(grip).reason, REASON_DEGENERATE);
  }
}

TEST(Closure, MissesBesideAboveAndBelow) {
  const Ready beaker(beaker1());
  EXPECT_EQ(beaker.close(grip_of(55, 0, 48.1)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(55, 0, -60)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(118.1)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(-8.1)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(300, 20)).reason, REASON_MISSES);
}

TEST(Closure, MissesWhereOneSideFindsNothing) {
  // between R + 7 mm, where the index tip passes, and R + 8 mm, where the thumb's still touches
  const Closing closing = Ready(beaker1()).close(grip_of(55, 0, 47.5));
  EXPECT_EQ(closing.reason, REASON_MISSES);
}

TEST(Closure, NotConvergedComesBeforeMisses) {
  // along the vase's waist, concave, nothing but the distance bounds a step: passing 1e-8 m outside the thumb's reach takes some
  // pi (26 mm / 2e-8 m)^(1/2) = 3,500 steps, and 1,000 are allowed; the index tip, 1 mm smaller, misses
  GripInput grip = grip_of(26);
  grip.offset = 18e-3 + THUMB_RADIUS + 1e-8;
  EXPECT_EQ(Ready(vase()).close(grip).reason, REASON_NOT_CONVERGED);
  grip.offset = 18e-3 + THUMB_RADIUS + 1e-3;
  EXPECT_EQ(Ready(vase()).close(grip).reason, REASON_MISSES);
}

TEST(Closure, NearGrazingIsFlaggedOrNotConverged) {
  HandData alike;  // both tips alike, so that both graze
  alike.fingers[0].radii[3] = INDEX_RADIUS;
  const Ready beaker(cylinder("wide", 100, 110, 1.5), alike);
  const double reach = 50e-3 + INDEX_RADIUS;
  int flagged = 0;
  for (int i = -400; i <= 400; ++i) {
    GripInput grip = grip_of(55);
    // from 10 mm inside the reach to 10 mm outside it, closest together where it grazes
    grip.offset = reach + (i < 0 ? -1 : 1) * std::pow(10.0, -2 - (400 - std::abs(i)) / 40.0);
    const Closing closing = beaker.close(grip);
    const double angle = std::asin(std::min(1.0, grip.offset / reach));
    if (grip.offset > reach + 1e-6) {
      EXPECT_EQ(closing.reason, REASON_MISSES) << grip.offset;
    } else if (angle > radians(89.01)) {
      // a chord of under 2 mm is too narrow, and says that it grazes
      EXPECT_TRUE(closing.reason == REASON_NOT_CONVERGED || closing.reason == REASON_MISSES || closing.reason == REASON_TOO_NARROW)
          << grip.offset;
      if (closing.reason == REASON_TOO_NARROW) ++flagged;
    } else if (closing.reason == REASON_NONE) {
      EXPECT_EQ(closing.grazing, angle > radians(89)) << grip.offset;
    }
  }
  EXPECT_GT(flagged, 5);
}

TEST(Closure, GrazingIsWithinADegreeOfPerpendicular) {
  // on a tip of radius 0 and a wide vessel a chord at 89 degrees can still be held: use a large vessel and a large hand
  HandData bare;
  bare.scale = 10;
  for (FingerData& finger : bare.fingers) finger.radii = {};
  const Ready vat(cylinder("vat", 20000, 4000, 10), bare);
  for (const double degrees_off : {0.9, 0.99, 1.01, 1.5}) {
    GripInput grip = grip_of(2000);
    grip.offset = 10 * std::cos(radians(degrees_off));  // the normal is 90 - degrees_off from d
    const Closing closing = vat.close(grip);
    ASSERT_EQ(closing.reason, REASON_NONE) << degrees_off;
    EXPECT_EQ(closing.grazing, degrees_off < 1) << degrees_off;
  }
}

TEST(Closure, OneGrazingTipIsEnough) {
  // tips of 70 and 80 mm on a vat of 10 m: where the smaller one's normal is 89.05 degrees from d, the larger one's is 87.3
  for (const bool index_is_smaller : {true, false}) {
    HandData hand;
    hand.scale = 10;
    hand.fingers[0].radii[3] = index_is_smaller ? 8e-3 : 7e-3;
    hand.fingers[1].radii[4] = index_is_smaller ? 7e-3 : 8e-3;
    GripInput grip = grip_of(2000);
    grip.offset = 10.07 * std::sin(radians(89.05));
    const Closing closing = Ready(cylinder("vat", 20000, 4000, 10), hand).close(grip);
    ASSERT_EQ(closing.reason, REASON_NONE);
    EXPECT_GT(std::max(closing.index_angle, closing.thumb_angle), radians(89));
    EXPECT_LT(std::min(closing.index_angle, closing.thumb_angle), radians(88));
    EXPECT_EQ(closing.index_angle > closing.thumb_angle, index_is_smaller);
    EXPECT_TRUE(closing.grazing);
  }
}

TEST(Closure, TooWideBeyondTheOpenGap) {
  const double open = static_cast<double>(reference_gap({}, 0)), radii = INDEX_RADIUS + THUMB_RADIUS;
  for (const double over : {-1e-6, 1e-6, 1e-2}) {
    const Closing closing = Ready(cylinder("jar", (open - radii + over) * 1e3, 110, 1.5)).close(grip_of(55));
    EXPECT_EQ(closing.reason, over > 0 ? REASON_TOO_WIDE : REASON_NONE) << over;
    EXPECT_NEAR(closing.gap, open + over, STOPPED);  // gap and midpoint are reported from here on
    EXPECT_LT(glm::distance(closing.midpoint, {-0.5e-3, 55e-3, 0}), STOPPED);
  }
}

TEST(Closure, TooNarrowUnderTheClosedGap) {
  HandData stiff;  // closes to some 40 mm only
  stiff.mcp.closed = radians(40);
  const double closed = static_cast<double>(reference_gap(stiff, 1)), radii = INDEX_RADIUS + THUMB_RADIUS;
  ASSERT_GT(closed, radii + 1e-3);
  for (const double over : {-5e-3, -1e-6, 1e-6}) {
    const Closing closing = Ready(cylinder("stick", (closed - radii + over) * 1e3, 110, 1), stiff).close(grip_of(55));
    EXPECT_EQ(closing.reason, over < 0 ? REASON_TOO_NARROW : REASON_NONE) << over;
    EXPECT_NEAR(closing.gap, closed + over, STOPPED);
  }
}

TEST(Closure, TooNarrowUnderTheSumOfTheRadii) {
  HandData thick;  // tips of 20 mm, so that the sum is far over g(1)
  thick.fingers[0].radii[3] = thick.fingers[1].radii[4] = 20e-3;
  const Ready beaker(beaker1(), thick);
  for (const double gap : {39.9e-3, 40.1e-3}) {
    GripInput grip = grip_of(55);
    grip.offset = std::sqrt(60e-3 * 60e-3 - gap * gap / 4);  // both tips on a circle of 60 mm
    const Closing closing = beaker.close(grip);
    EXPECT_NEAR(closing.gap, gap, STOPPED);
    EXPECT_EQ(closing.reason, gap < 40e-3 ? REASON_TOO_NARROW : REASON_NONE);
  }
}

// A hand whose thumb lies across it and comes to the index tip from the side: at closure 1 its tips lie along x.
HandData sideways_hand() {
  HandData hand;
  hand.fingers[0].base = {-168e-3, 1e-3, -175e-3};
  hand.fingers[0].splay = radians(-90);
  hand.thumb_abduction = {radians(60), radians(10)};
  hand.thumb_mcp = hand.thumb_ip = {0, 0};
  hand.mcp = {radians(4), radians(5)};
  hand.pip = {radians(12), radians(13)};
  return hand;
}

TEST(Closure, TooNarrowWhereTheLineLiesAcrossTheHand) {
  // |e1.x| over 0.95: the hand's own frame about the line is ill-defined
  const HandData data = sideways_hand();
  int across = 0, along = 0;
  for (int i = 1; i < 60; ++i) {
    const auto joints = reference_hand(data, i / 60.0L);
    const Long3 line = joints[INDEX_TIP] - joints[THUMB_TIP];
    const double e1_x = static_cast<double>(line[0] / length(line));
    const double diameter = static_cast<double>(length(line)) - INDEX_RADIUS - THUMB_RADIUS;
    ASSERT_GT(diameter, 10e-3);
    if (std::abs(e1_x - 0.95) < 1e-3) continue;
    const Closing closing = Ready(cylinder("jar", diameter * 1e3, 110, 1), data).close(grip_of(55));
    EXPECT_EQ(closing.reason, e1_x > 0.95 ? REASON_TOO_NARROW : REASON_NONE) << i << ", e1.x = " << e1_x;
    EXPECT_NEAR(closing.gap, static_cast<double>(length(line)), STOPPED);
    ++(e1_x > 0.95 ? across : along);
  }
  EXPECT_GT(across, 3);
  EXPECT_GT(along, 3);
}

TEST(Closure, OnMouthWhereATipRestsOnTheLid) {
  const Ready beaker(beaker1());           // 110 mm and both radii are under g(0)
  for (const double sign : {-1.0, 1.0}) {  // index above, thumb above
    const Closing closing = beaker.close(grip_of(55, sign * 89));
    EXPECT_EQ(closing.reason, REASON_ON_MOUTH);
    EXPECT_NEAR(closing.gap, (110e-3 + 15e-3) / std::sin(radians(89)), STOPPED);
  }
}

TEST(Closure, ShellHasNoLid) {
  const Ready shell(shell_of(beaker1()));
  const Closing closing = shell.close(grip_of(10, 89));  // from the inside of the base to its outside
  EXPECT_NE(closing.reason, REASON_ON_MOUTH);
  // index tip on the inner floor, 1.5 mm up; thumb tip under the base
  EXPECT_NEAR(closing.gap, (1.5e-3 + 15e-3) / std::sin(radians(89)), STOPPED);
}

TEST(Closure, EdgeOfTheMouthIsNotTheLid) {
  // level with the lid or above it the nearest point is the edge, which belongs to the wall: the first of equally near elements
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3(), vase(), ledges()}) {
    const Ready ready(vessel);
    for (const double above : {0.0, 0.001, 0.5, 2.0, 3.3, 6.5}) {
      for (int azimuth = 0; azimuth < 360; azimuth += 7) {
        const Closing closing = ready.close(grip_of(vessel.height * 1e3 + above, 0, 0.3 * above, 0, azimuth));
        EXPECT_NE(closing.reason, REASON_ON_MOUTH) << vessel.name << ", " << above << " mm above, azimuth " << azimuth;
      }
    }
  }
}

TEST(Closure, OnMouthComesLast) {
  // too wide and on the mouth: too wide
  EXPECT_EQ(Ready(cylinder("tall", 60, 130, 1)).close(grip_of(65, 89)).reason, REASON_TOO_WIDE);
  HandData stiff;  // too narrow and on the mouth: too narrow
  stiff.mcp.closed = radians(40);
  EXPECT_EQ(Ready(cylinder("dish", 100, 12, 1), stiff).close(grip_of(6, 89)).reason, REASON_TOO_NARROW);
}

// ---- where the hand is placed ----

void expect_placed(const VesselData& vessel, const HandData& hand, int least_feasible) {
  const auto evaluator = make_core_evaluator(scene_of({vessel}, Pose::rigged, hand));
  int feasible = 0;
  for (const GripInput& sample : sample_grips(vessel, 120, 23)) {
    GripInput grip = sample;
    grip.hand_scale = 0.9 + 0.2 * std::abs(std::sin(100 * sample.azimuth));
    GripResult result;
    evaluator->grip(0, grip, result);
    if (result.reason != Reason::none) continue;
    ++feasible;
    // the specification's frames, in long double, at the closure that was found
    HandData scaled_hand = hand;
    scaled_hand.scale *= grip.hand_scale;
    const auto in_hand = reference_hand(scaled_hand, result.closure);
    const auto unit = [](const Long3& v) { return 1 / length(v) * v; };
    const Long3 e1 = unit(in_hand[INDEX_TIP] - in_hand[THUMB_TIP]);
    const Long3 e2 = unit(Long3{1, 0, 0} - e1[0] * e1), e3 = cross(e1, e2);
    const Long3 f1 = direction_of(grip);
    const Long3 level = unit(Long3{0, -1, 0} - -f1[1] * f1), beside = cross(f1, level);
    const Long3 f2 = std::cos(static_cast<long double>(grip.roll)) * level + std::sin(static_cast<long double>(grip.roll)) * beside;
    const Long3 f3 = cross(f1, f2);
    const Long3 middle = 0.5L * (in_hand[INDEX_TIP] + in_hand[THUMB_TIP]);
    for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
      const Long3 p = in_hand[j] - middle;
      const Long3 placed = widened(result.midpoint) + dot(p, e1) * f1 + dot(p, e2) * f2 + dot(p, e3) * f3;
      // 1e-13 m: rounding of a frame that is 1 / (1 - 0.95^2)^(1/2) ill-conditioned at most, over hands of up to a metre
      ASSERT_LT(length(placed - widened(result.joints[j])), 1e-13 * std::max(1.0, hand.scale)) << vessel.name << ", joint " << j;
    }
  }
  EXPECT_GE(feasible, least_feasible) << vessel.name;
}

TEST(Closure, HandIsPlacedByItsFrames) {
  expect_placed(beaker1(), {}, 60);
  expect_placed(vase(), odd_hand(), 60);
  expect_placed(scaled(ledges(), 0.1), tiny_hand(), 60);
  expect_placed(scaled(beaker3(), 3), large_hand(), 60);
}

TEST(Closure, TipsOfThePlacedHandLandOnTheTipPoints) {
  for (const VesselData& vessel : {beaker1(), beaker3(), vase()}) {
    const Ready ready(vessel);
    const auto evaluator = make_core_evaluator(scene_of({vessel}, Pose::rigged));
    for (const GripInput& grip : sample_grips(vessel, 60, 24)) {
      const Closing closing = ready.close(grip);
      if (closing.reason != REASON_NONE) continue;
      GripResult result;
      evaluator->grip(0, grip, result);
      const Long3 d = direction_of(grip), o = foot_of(grip);
      // 1e-8 m: the hand's gap is the tips' to 1e-9 m, shared by both ends
      EXPECT_LT(length(widened(result.joints[INDEX_TIP]) - (o + closing.t_index * d)), 1e-8);
      EXPECT_LT(length(widened(result.joints[THUMB_TIP]) - (o + closing.t_thumb * d)), 1e-8);
      // and they rest on the glass
      EXPECT_NEAR(result.separation[INDEX_TIP], 0, 1e-8);
      EXPECT_NEAR(result.separation[THUMB_TIP], 0, 1e-8);
    }
  }
}

TEST(Closure, RotationIsProper) {
  HandData data = odd_hand();
  const core_f64::Hand hand = ready_hand(data);
  data.scale = 1;
  Random random(25);
  for (int n = 0; n < 200; ++n) {
    const double closure = random.uniform(0, 1);
    double e1_x = 9;
    const core_f64::Placement placement =
        core_f64::place_hand(hand, closure, core_f64::grip_direction(random.uniform(-PI, PI), random.uniform(-1.5, 1.5)),
                             random.uniform(-PI, PI), {0.1, 0.2, 0.3}, 1.7, e1_x);
    const core_f64::Mat3& R = placement.rotation;
    // 1e-13: rounding, 1e-16, over the sine of the angle of d with the axis, 0.07 at least here, and of e1 with x, 0.1 at least
    EXPECT_NEAR(glm::determinant(R), 1, 1e-13);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(glm::dot(R[i], R[j]), i == j ? 1 : 0, 1e-13);
    }
    const auto joints = reference_hand(data, closure);
    EXPECT_NEAR(e1_x, static_cast<double>((joints[INDEX_TIP][0] - joints[THUMB_TIP][0]) / reference_gap(data, closure)), 1e-13);
    EXPECT_EQ(placement.scale, 1.7);
  }
}

TEST(Closure, AtRollZeroTheLittleFingerIsBelow) {
  const auto evaluator = make_core_evaluator(scene_of({beaker1()}, Pose::rigged));
  for (const double azimuth : {0.0, 100.0, -60.0}) {
    GripResult result;
    evaluator->grip(0, grip_of(80, 0, 0, 0, azimuth), result);
    ASSERT_EQ(result.reason, Reason::none);
    for (int k = 0; k < 5; ++k) {
      for (int finger = 2; finger < 5; ++finger) {  // each finger under the one before it
        const auto joint = static_cast<std::size_t>(4 + 5 * (finger - 1) + k);
        EXPECT_LT(result.joints[joint][1], result.joints[joint - 5][1]) << "finger " << finger << ", joint " << k;
      }
    }
  }
}

TEST(Closure, AtRollMinus90TheHandIsAbove) {
  const auto evaluator = make_core_evaluator(scene_of({beaker1()}, Pose::rigged));
  for (const double azimuth : {0.0, 45.0, 180.0}) {
    GripResult result;
    evaluator->grip(0, grip_of(60, 0, 0, -90, azimuth), result);
    ASSERT_EQ(result.reason, Reason::none);
    for (const std::size_t j : {0, 1, 4, 5, 9, 10, 14, 15, 19, 20}) EXPECT_GT(result.joints[j][1], 80e-3) << j;  // the palm
    // the little finger's knuckle is level with the index finger's, to the side: e2, across the hand, is horizontal
    EXPECT_LT(std::abs(result.joints[20][1] - result.joints[5][1]), 40e-3);
  }
}

TEST(Closure, AzimuthTurnsEverything) {
  const VesselData vessel = vase();
  const auto evaluator = make_core_evaluator(scene_of({vessel}));
  int feasible = 0;
  for (GripInput grip : sample_grips(vessel, 60, 26)) {
    GripResult turned, straight;
    evaluator->grip(0, grip, turned);
    const LongRotation R = rotation_y(grip.azimuth);
    grip.azimuth = 0;
    evaluator->grip(0, grip, straight);
    ASSERT_EQ(turned.reason, straight.reason);
    if (turned.reason != Reason::none || turned.grazing) continue;
    ++feasible;
    EXPECT_NEAR(turned.closure, straight.closure, 1e-7);  // two stop tolerances over the gap's slope, 0.05 m at least
    for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
      // 1e-7 m: the above, times the fingers' 0.1 m and the inverse of the contact angle's cosine
      EXPECT_LT(length(R * widened(straight.joints[j]) - widened(turned.joints[j])), 1e-7);
    }
  }
  EXPECT_GT(feasible, 30);
}

TEST(Closure, EverythingScalesTogether) {
  const VesselData vessel = vase();
  const auto plain = make_core_evaluator(scene_of({vessel}, Pose::rigged));
  for (const double factor : {0.1, 3.0}) {
    const auto evaluator =
        make_core_evaluator(scene_of({scaled(vessel, factor)}, Pose::rigged, factor < 1 ? tiny_hand() : large_hand()));
    for (const GripInput& grip : sample_grips(vessel, 40, 27)) {
      GripInput scaled_grip = grip;
      scaled_grip.height *= factor;
      scaled_grip.offset *= factor;
      GripResult one, other;
      plain->grip(0, grip, one);
      evaluator->grip(0, scaled_grip, other);
      ASSERT_EQ(one.reason, other.reason);
      if (one.reason != Reason::none || one.grazing) continue;
      EXPECT_NEAR(other.closure, one.closure, 1e-6);  // the stop tolerance is ten times coarser on a hand ten times smaller
      EXPECT_NEAR(other.gap, factor * one.gap, STOPPED);
    }
  }
}

// ---- contact angles ----

TEST(Closure, ContactAnglesOnACylinder) {
  const Ready narrow(cylinder("narrow", 60, 110, 1.5));
  for (const double obliquity : {0.0, 12.0, -20.0}) {
    for (const double offset : {0.0, 8.0, -22.0}) {
      const GripInput grip = grip_of(55, obliquity, offset, 0, 31);
      const Closing closing = narrow.close(grip);
      ASSERT_EQ(closing.reason, REASON_NONE);
      // the normal is horizontal and meets d's horizontal part at asin(s / (R + r))
      const auto angle = [&](double r) {
        return std::acos(std::sqrt(1 - std::pow(grip.offset / (30e-3 + r), 2)) * std::cos(grip.obliquity));
      };
      // 1e-7 rad: 1e-9 m over 30 mm, and at 0 the root of the cosine's rounding
      EXPECT_NEAR(closing.thumb_angle, angle(THUMB_RADIUS), 1e-7);
      EXPECT_NEAR(closing.index_angle, angle(INDEX_RADIUS), 1e-7);
      EXPECT_FALSE(closing.grazing);
    }
  }
}

TEST(Closure, AntipodalWithinTheFrictionAngle) {
  for (const double friction : {0.3, 0.6, 1.1}) {
    Scene scene = scene_of({beaker1()});
    scene.force.friction = friction;
    const auto evaluator = make_core_evaluator(scene);
    for (const double over : {-1e-5, 1e-5}) {  // rad
      GripInput grip = grip_of(55);
      // the index tip's angle is the larger one
      grip.offset = (40e-3 + INDEX_RADIUS) * std::sin(std::atan(friction) + over);
      GripResult result;
      evaluator->grip(0, grip, result);
      ASSERT_EQ(result.reason, Reason::none);
      EXPECT_EQ(result.antipodal, over < 0) << friction;
      EXPECT_EQ((result.status & STATUS_ANTIPODAL) != 0, result.antipodal);
      EXPECT_LT(result.contact_angles[0], result.contact_angles[1]);
    }
  }
}

TEST(Closure, AntipodalNeedsBothTips) {
  // index on the slope of a cone, thumb on it too, line level: both at the slope's angle; with friction in between by obliquity
  const double slope = std::atan2(25.5, 101.0);  // of beaker3's wall to the axis
  Scene scene = scene_of({beaker3()});
  scene.force.friction = std::tan(slope + radians(5));
  const auto evaluator = make_core_evaluator(scene);
  for (const double obliquity : {0.0, 4.0, 6.0, -4.0, -6.0}) {
    GripResult result;
    evaluator->grip(0, grip_of(50, obliquity), result);
    ASSERT_EQ(result.reason, Reason::none) << obliquity;
    // the normals point up: climbing towards the index finger brings d nearer to its normal and further from the thumb's
    EXPECT_NEAR(result.contact_angles[0], slope + radians(obliquity), 1e-7);
    EXPECT_NEAR(result.contact_angles[1], slope - radians(obliquity), 1e-7);
    EXPECT_EQ(result.antipodal, std::abs(obliquity) < 5);
  }
}

// ---- on a lattice ----

TEST(Closure, GridGivesTheOutlinesAnswerAtEveryAzimuth) {
  // tips of a small hand: tracing must not step into the vessel on its way from outside the lattice
  HandData bare;
  for (FingerData& finger : bare.fingers) finger.radii = {};
  for (const VesselData& vessel : {beaker1(), beaker3()}) {
    const Scene scene = scene_of({vessel}, Pose::rigged, bare);
    const auto outline = make_core_evaluator(scene), grid = make_core_evaluator(scene, {.grid_samples = 60});
    int compared = 0;
    for (GripInput grip : sample_grips(vessel, 300, 28)) {
      grip.height = vessel.height * (0.3 + 0.4 * std::abs(std::sin(100 * grip.roll)));  // away from edges
      grip.obliquity /= 3;
      grip.offset /= 2;
      GripResult exact, sampled;
      outline->grip(0, grip, exact);
      grid->grip(0, grip, sampled);
      if (exact.reason != Reason::none) continue;
      ++compared;
      ASSERT_EQ(sampled.reason, Reason::none);
      // 1e-4 m: cells of 2.5 mm, curvature 1 / 17 mm: spacing^2 / 8 times it is 5e-5 m a side
      ASSERT_NEAR(sampled.gap, exact.gap, 2e-4) << vessel.name << " " << grip.azimuth;
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(sampled.midpoint[k], exact.midpoint[k], 1e-4);
    }
    EXPECT_GT(compared, 150);
  }
}

// What starts far above or beside the lattice of a tall cup comes to it aslant, and must not pass over its wall.
TEST(Closure, OfATallHollowMeshMeetsTheNearWalls) {
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 400), line_to(37, 400), line_to(37, 3), line_to(0, 3)};
  HandData bare;
  for (FingerData& finger : bare.fingers) finger.radii = {};
  const Scene scene = scene_of({vessel_of_mesh("cup", turned_mesh(shell, 128, 2e-3), 1e-3)}, Pose::rigged, bare);
  const auto core = make_core_evaluator(scene);
  for (int degree = 0; degree < 360; degree += 10) {
    GripInput grip;
    grip.height = 0.2;
    grip.azimuth = radians(degree);
    GripResult result;
    core->grip(0, grip, result);
    ASSERT_EQ(result.reason, Reason::none) << degree;
    EXPECT_NEAR(result.gap, 0.08, 4e-5) << degree;  // two walls' chords and cells, 15 um each
  }
}

}  // namespace
}  // namespace wholehand

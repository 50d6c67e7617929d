// SPDX-License-Identifier: MIT
// Kernel 3: why a grip is not feasible, in the order of the reasons.
#include "core/closure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/closing_hand.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Closing;

TEST(Closure, DegenerateWithinANanoradianOfTheAxis) {
  const ClosingHand beaker(beaker1());
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
  const ClosingHand beaker(beaker1());
  EXPECT_EQ(beaker.close(grip_of(55, 0, 48.1)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(55, 0, -60)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(118.1)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(-8.1)).reason, REASON_MISSES);
  EXPECT_EQ(beaker.close(grip_of(300, 20)).reason, REASON_MISSES);
}

TEST(Closure, MissesWhereOneSideFindsNothing) {
  // between R + 7 mm, where the index tip passes, and R + 8 mm, where the thumb's still touches
  const Closing closing = ClosingHand(beaker1()).close(grip_of(55, 0, 47.5));
  EXPECT_EQ(closing.reason, REASON_MISSES);
}

TEST(Closure, NotConvergedComesBeforeMisses) {
  // along the vase's waist, concave, nothing but the distance bounds a step: passing 1e-8 m outside the thumb's reach takes some
  // pi (26 mm / 2e-8 m)^(1/2) = 3,500 steps, and 1,000 are allowed; the index tip, 1 mm smaller, misses
  GripInput grip = grip_of(26);
  grip.offset = 18e-3 + THUMB_RADIUS + 1e-8;
  EXPECT_EQ(ClosingHand(vase()).close(grip).reason, REASON_NOT_CONVERGED);
  grip.offset = 18e-3 + THUMB_RADIUS + 1e-3;
  EXPECT_EQ(ClosingHand(vase()).close(grip).reason, REASON_MISSES);
}

TEST(Closure, NearGrazingIsFlaggedOrNotConverged) {
  HandData alike = paper_hand();  // both tips alike, so that both graze
  alike.fingers[0].radii[3] = INDEX_RADIUS;
  const ClosingHand beaker(cylinder("wide", 100, 110, 1.5), alike);
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
  HandData bare = paper_hand();
  bare.scale = 10;
  for (FingerData& finger : bare.fingers) finger.radii = {};
  const ClosingHand vat(cylinder("vat", 20000, 4000, 10), bare);
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
    HandData hand = paper_hand();
    hand.scale = 10;
    hand.fingers[0].radii[3] = index_is_smaller ? 8e-3 : 7e-3;
    hand.fingers[1].radii[4] = index_is_smaller ? 7e-3 : 8e-3;
    GripInput grip = grip_of(2000);
    grip.offset = 10.07 * std::sin(radians(89.05));
    const Closing closing = ClosingHand(cylinder("vat", 20000, 4000, 10), hand).close(grip);
    ASSERT_EQ(closing.reason, REASON_NONE);
    EXPECT_GT(std::max(closing.index_angle, closing.thumb_angle), radians(89));
    EXPECT_LT(std::min(closing.index_angle, closing.thumb_angle), radians(88));
    EXPECT_EQ(closing.index_angle > closing.thumb_angle, index_is_smaller);
    EXPECT_TRUE(closing.grazing);
  }
}

TEST(Closure, TooWideBeyondTheOpenGap) {
  const double open = static_cast<double>(reference_gap(paper_hand(), 0)), radii = INDEX_RADIUS + THUMB_RADIUS;
  for (const double over : {-1e-6, 1e-6, 1e-2}) {
    const Closing closing = ClosingHand(cylinder("jar", (open - radii + over) * 1e3, 110, 1.5)).close(grip_of(55));
    EXPECT_EQ(closing.reason, over > 0 ? REASON_TOO_WIDE : REASON_NONE) << over;
    EXPECT_NEAR(closing.gap, open + over, CLOSING_STOPPED);  // gap and midpoint are reported from here on
    EXPECT_LT(glm::distance(closing.midpoint, {-0.5e-3, 55e-3, 0}), CLOSING_STOPPED);
  }
}

TEST(Closure, TooNarrowUnderTheClosedGap) {
  HandData stiff = paper_hand();  // closes to some 40 mm only
  stiff.mcp.closed = radians(40);
  const double closed = static_cast<double>(reference_gap(stiff, 1)), radii = INDEX_RADIUS + THUMB_RADIUS;
  ASSERT_GT(closed, radii + 1e-3);
  for (const double over : {-5e-3, -1e-6, 1e-6}) {
    const Closing closing = ClosingHand(cylinder("stick", (closed - radii + over) * 1e3, 110, 1), stiff).close(grip_of(55));
    EXPECT_EQ(closing.reason, over < 0 ? REASON_TOO_NARROW : REASON_NONE) << over;
    EXPECT_NEAR(closing.gap, closed + over, CLOSING_STOPPED);
  }
}

TEST(Closure, TooNarrowUnderTheSumOfTheRadii) {
  HandData thick = paper_hand();  // tips of 20 mm, so that the sum is far over g(1)
  thick.fingers[0].radii[3] = thick.fingers[1].radii[4] = 20e-3;
  const ClosingHand beaker(beaker1(), thick);
  for (const double gap : {39.9e-3, 40.1e-3}) {
    GripInput grip = grip_of(55);
    grip.offset = std::sqrt(60e-3 * 60e-3 - gap * gap / 4);  // both tips on a circle of 60 mm
    const Closing closing = beaker.close(grip);
    EXPECT_NEAR(closing.gap, gap, CLOSING_STOPPED);
    EXPECT_EQ(closing.reason, gap < 40e-3 ? REASON_TOO_NARROW : REASON_NONE);
  }
}

// A hand whose thumb lies across it and comes to the index tip from the side: at closure 1 its tips lie along x.
HandData sideways_hand() {
  HandData hand = paper_hand();
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
    const Closing closing = ClosingHand(cylinder("jar", diameter * 1e3, 110, 1), data).close(grip_of(55));
    EXPECT_EQ(closing.reason, e1_x > 0.95 ? REASON_TOO_NARROW : REASON_NONE) << i << ", e1.x = " << e1_x;
    EXPECT_NEAR(closing.gap, static_cast<double>(length(line)), CLOSING_STOPPED);
    ++(e1_x > 0.95 ? across : along);
  }
  EXPECT_GT(across, 3);
  EXPECT_GT(along, 3);
}

TEST(Closure, OnMouthWhereATipRestsOnTheLid) {
  const ClosingHand beaker(beaker1());     // 110 mm and both radii are under g(0)
  for (const double sign : {-1.0, 1.0}) {  // index above, thumb above
    const Closing closing = beaker.close(grip_of(55, sign * 89));
    EXPECT_EQ(closing.reason, REASON_ON_MOUTH);
    EXPECT_NEAR(closing.gap, (110e-3 + 15e-3) / std::sin(radians(89)), CLOSING_STOPPED);
  }
}

TEST(Closure, ShellHasNoLid) {
  const ClosingHand shell(shell_of(beaker1()));
  const Closing closing = shell.close(grip_of(10, 89));  // from the inside of the base to its outside
  EXPECT_NE(closing.reason, REASON_ON_MOUTH);
  // index tip on the inner floor, 1.5 mm up; thumb tip under the base
  EXPECT_NEAR(closing.gap, (1.5e-3 + 15e-3) / std::sin(radians(89)), CLOSING_STOPPED);
}

TEST(Closure, EdgeOfTheMouthIsNotTheLid) {
  // level with the lid or above it the nearest point is the edge, which belongs to the wall: the first of equally near elements
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3(), vase(), ledges()}) {
    const ClosingHand ready(vessel);
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
  EXPECT_EQ(ClosingHand(cylinder("tall", 60, 130, 1)).close(grip_of(65, 89)).reason, REASON_TOO_WIDE);
  HandData stiff = paper_hand();  // too narrow and on the mouth: too narrow
  stiff.mcp.closed = radians(40);
  EXPECT_EQ(ClosingHand(cylinder("dish", 100, 12, 1), stiff).close(grip_of(6, 89)).reason, REASON_TOO_NARROW);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Kernel 3: thumb and index finger close on a line through the vessel. Cylinders have closed forms.
#include "core/closure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/evaluator.h"
#include "tests/support/closing_hand.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::Closing;
using core_f64::Vec3;

// ---- where the tips stop ----

TEST(Closure, StraightGapIsTheDiameterAndBothRadii) {
  const ClosingHand beaker(beaker1());
  for (const double height : {20.0, 55.0, 95.0}) {
    const Closing closing = beaker.close(grip_of(height));
    ASSERT_EQ(closing.reason, REASON_NONE);
    EXPECT_NEAR(closing.t_index, 40e-3 + INDEX_RADIUS, CLOSING_STOPPED);  // each tip its own radius
    EXPECT_NEAR(closing.t_thumb, -40e-3 - THUMB_RADIUS, CLOSING_STOPPED);
    EXPECT_NEAR(closing.gap, 95e-3, CLOSING_STOPPED);
    EXPECT_LT(glm::distance(closing.midpoint, {-0.5e-3, height * 1e-3, 0}), CLOSING_STOPPED);
  }
}

TEST(Closure, OffsetGapIsAChord) {
  const ClosingHand beaker(beaker1());
  for (const double offset : {-30.0, -12.0, 0.0, 5.0, 30.0}) {
    const Closing closing = beaker.close(grip_of(55, 0, offset));
    ASSERT_EQ(closing.reason, REASON_NONE) << offset;
    const double index = cylinder_hit(40e-3, INDEX_RADIUS, offset * 1e-3, 0),
                 thumb = cylinder_hit(40e-3, THUMB_RADIUS, offset * 1e-3, 0);
    EXPECT_NEAR(closing.t_index, index, CLOSING_STOPPED);
    EXPECT_NEAR(closing.t_thumb, -thumb, CLOSING_STOPPED);
    EXPECT_NEAR(closing.gap, index + thumb, CLOSING_STOPPED);
    // d = x, so the line is moved along x cross y = z
    EXPECT_LT(glm::distance(closing.midpoint, {(index - thumb) / 2, 55e-3, offset * 1e-3}), CLOSING_STOPPED);
  }
}

TEST(Closure, ObliqueGapIsAnEllipse) {
  const ClosingHand narrow(cylinder("narrow", 60, 110, 1.5));
  for (const double obliquity : {-25.0, -10.0, 10.0, 20.0}) {
    for (const double offset : {-15.0, 0.0, 20.0}) {
      for (const double azimuth : {0.0, 73.0, -160.0}) {
        const GripInput grip = grip_of(55, obliquity, offset, 10, azimuth);
        const Closing closing = narrow.close(grip);
        ASSERT_EQ(closing.reason, REASON_NONE);
        const double index = cylinder_hit(30e-3, INDEX_RADIUS, grip.offset, grip.obliquity);
        const double thumb = cylinder_hit(30e-3, THUMB_RADIUS, grip.offset, grip.obliquity);
        EXPECT_NEAR(closing.t_index, index, CLOSING_STOPPED);
        EXPECT_NEAR(closing.t_thumb, -thumb, CLOSING_STOPPED);
        EXPECT_NEAR(closing.gap, index + thumb, CLOSING_STOPPED);
        EXPECT_LT(length(widened(closing.direction) - direction_of(grip)), 1e-15);  // rounding of unit vectors
        const Long3 midpoint = foot_of(grip) + (index - thumb) / 2 * direction_of(grip);
        EXPECT_LT(length(widened(closing.midpoint) - midpoint), CLOSING_STOPPED);
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
  const ClosingHand beaker(cylinder("stick", 30, 110, 1.5));
  for (const double scale : {0.5, 0.9, 1.4}) {
    GripInput grip = grip_of(55);
    grip.hand_scale = scale;
    const Closing closing = beaker.close(grip);
    ASSERT_EQ(closing.reason, REASON_NONE) << scale;
    EXPECT_NEAR(closing.t_index, 15e-3 + scale * INDEX_RADIUS, CLOSING_STOPPED);
    EXPECT_NEAR(closing.t_thumb, -15e-3 - scale * THUMB_RADIUS, CLOSING_STOPPED);
    EXPECT_NEAR(scale * core_f64::gap_at(beaker.hand, closing.closure), closing.gap, CLOSING_STOPPED);
  }
}

TEST(Closure, BarePointsTouchTheSurfaceItself) {
  HandData bare = paper_hand();
  for (FingerData& finger : bare.fingers) finger.radii = {};
  const Closing closing = ClosingHand(beaker1(), bare).close(grip_of(55, 0, 10));
  ASSERT_EQ(closing.reason, REASON_NONE);
  EXPECT_NEAR(closing.t_index, cylinder_hit(40e-3, 0, 10e-3, 0), CLOSING_STOPPED);
  EXPECT_NEAR(closing.t_thumb, -cylinder_hit(40e-3, 0, 10e-3, 0), CLOSING_STOPPED);
}

TEST(Closure, ClosureIsTheInverseOfTheGap) {
  for (const VesselData& vessel : {beaker1(), vase(), ledges()}) {
    const ClosingHand ready(vessel);
    int feasible = 0;
    for (const GripInput& grip : sample_grips(vessel, 100, 21)) {
      const Closing closing = ready.close(grip);
      if (closing.reason != REASON_NONE) continue;
      ++feasible;
      EXPECT_NEAR(static_cast<double>(reference_gap(paper_hand(), closing.closure)), closing.gap,
                  2e-9);  // twice the stop tolerance
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
      ASSERT_NEAR(trace.t, outside, CLOSING_STOPPED) << data.name << ", line " << n;  // slope over 0.1
    }
    EXPECT_GT(hits, 50) << data.name;
    EXPECT_GT(misses, 10) << data.name;
    EXPECT_LT(grazing, 15) << data.name;
  }
}

TEST(Closure, TipStopsOffTheRimAsASphereDoes) {
  // just above the mouth's edge a tip of radius r at height e over it stops where e^2 + (x - R)^2 = r^2
  const ClosingHand beaker(beaker1());
  for (const double above : {1.0, 3.0, 6.0}) {
    const Closing closing = beaker.close(grip_of(110 + above));
    ASSERT_EQ(closing.reason, REASON_NONE) << above;
    EXPECT_NEAR(closing.t_index, 40e-3 + std::sqrt(INDEX_RADIUS * INDEX_RADIUS - above * above * 1e-6), CLOSING_STOPPED);
    EXPECT_NEAR(closing.t_thumb, -40e-3 - std::sqrt(THUMB_RADIUS * THUMB_RADIUS - above * above * 1e-6), CLOSING_STOPPED);
  }
}

// ---- contact angles ----

TEST(Closure, ContactAnglesOnACylinder) {
  const ClosingHand narrow(cylinder("narrow", 60, 110, 1.5));
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

TEST(Closure, LatticeGivesTheOutlinesAnswerAtEveryAzimuth) {
  // tips of a small hand: tracing must not step into the vessel on its way from outside the lattice
  HandData bare = paper_hand();
  for (FingerData& finger : bare.fingers) finger.radii = {};
  for (const VesselData& vessel : {beaker1(), beaker3()}) {
    const Scene scene = scene_of({vessel}, Pose::rigged, bare);
    const auto outline = make_core_evaluator(scene), lattice = make_core_evaluator(scene, {.lattice_samples = 60});
    int compared = 0;
    for (GripInput grip : sample_grips(vessel, 300, 28)) {
      grip.height = vessel.height * (0.3 + 0.4 * std::abs(std::sin(100 * grip.roll)));  // away from edges
      grip.obliquity /= 3;
      grip.offset /= 2;
      GripResult exact, sampled;
      outline->grip(0, grip, exact);
      lattice->grip(0, grip, sampled);
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

// A trace that starts far above or beside the lattice of a tall cup meets it at a slant. It must not pass through the wall.
TEST(Closure, OfATallHollowMeshMeetsTheNearWalls) {
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 400), line_to(37, 400), line_to(37, 3), line_to(0, 3)};
  HandData bare = paper_hand();
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

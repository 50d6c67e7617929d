// SPDX-License-Identifier: MIT
// Kernel 2: the signed distance in closed form, its gradient against differences, crossings, and the elements of an outline.
#include "core/sdf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sampled_outline.h"

namespace wholehand {
namespace {

using core_f64::Element;
using core_f64::Vessel;

// A line from a to b: where an arc has its center stands the outward normal.
Element straight(Vec2 a, Vec2 b) { return {a, b, glm::normalize(Vec2{b.y - a.y, a.x - b.x})}; }

std::vector<VesselData> solids() { return {beaker1(), beaker2(), beaker3(), vase(), ledges()}; }

TEST(Sdf, InsideIsNegative) {
  for (const VesselData& data : solids()) {
    const Vessel vessel = ready_vessel(data);
    EXPECT_LT(core_f64::signed_distance(vessel, {0, data.height / 2, 0}), -1e-3) << data.name;
    EXPECT_GT(core_f64::signed_distance(vessel, {0, -1e-3, 0}), 1e-4);
    EXPECT_GT(core_f64::signed_distance(vessel, {0, data.height + 1e-3, 0}), 1e-4);
    EXPECT_GT(core_f64::signed_distance(vessel, {0.2, data.height / 2, 0.1}), 1e-2);
  }
}

TEST(Sdf, OfACylinderInClosedForm) {
  // 1e-16 m: one subtraction of numbers under 0.2 m, or one root
  const Vessel vessel = ready_vessel(beaker1());
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, 55e-3, 0}), -40e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, 3e-3, 0}), -3e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, 108e-3, 0}), -2e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {50e-3, 55e-3, 0}), 10e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {30e-3, 55e-3, 40e-3}), 10e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, -7e-3, 0}), 7e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {43e-3, 114e-3, 0}), 5e-3, 1e-16);    // off the rim: 3, 4, 5
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, -12e-3, -45e-3}), 13e-3, 1e-16);  // off the base's edge: 5, 12, 13
}

TEST(Sdf, OfASphereHasNoSeamAtItsPoles) {
  const double r = 42.5e-3;
  const Vessel vessel = ready_vessel(beaker2());
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    // below the center the flask is its sphere
    const Vec3 direction = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 0), random.uniform(-1, 1)});
    const double far = random.uniform(10e-3, 80e-3);
    EXPECT_NEAR(core_f64::signed_distance(vessel, Vec3{0, r, 0} + far * direction), far - r, 1e-15);  // a root and a square more
  }
}

TEST(Sdf, IsNeverNaN) {
  for (VesselData data : {beaker1(), beaker2(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    for (const double x : {0.0, 1e-300, -1e-20, 1e-9, 24e-3, 40e-3, 1.0, 1e6, -1e100}) {
      for (const double y : {0.0, -1e-300, 6e-3, 42.5e-3, 60e-3, data.height, -1e6, 1e100}) {
        for (const double z : {0.0, 1e-200, 1e100}) {
          int element = -2;
          const Vec3 g = core_f64::distance_gradient(vessel, {x, y, z}, element);
          EXPECT_FALSE(std::isnan(core_f64::signed_distance(vessel, {x, y, z}))) << x << " " << y << " " << z;
          EXPECT_NEAR(glm::length(g), 1, 1e-12) << data.name << " at " << x << " " << y << " " << z;  // rounding of a normalisation
          EXPECT_GE(element, 0);
          EXPECT_LT(element, static_cast<int>(vessel.outline.size()));
        }
      }
    }
  }
}

// ---- gradient ----

TEST(Sdf, GradientIsItsDifferenceQuotient) {
  // central differences over h = 1e-7 m: h^2 / (6 d^2) < 1e-8 at d > 0.5 mm from the surface, rounding 1e-17 / h = 1e-10
  const double h = 1e-7;
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(7);
    int compared = 0, creases = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec2 q = point_in_box(data, random);
      const Vec3 p = around(q, random.uniform(-PI, PI));
      if (std::abs(core_f64::signed_distance(vessel, p)) < 0.5e-3 || q.x < 0.5e-3) continue;
      const auto at = [&](Vec3 step) { return core_f64::signed_distance(vessel, p + h * step); };
      Vec3 forward, backward;
      for (int k = 0; k < 3; ++k) {
        Vec3 axis{};
        axis[k] = 1;
        forward[k] = (at(axis) - at({})) / h;
        backward[k] = (at({}) - at(-axis)) / h;
      }
      if (glm::distance(forward, backward) > 1e-2) {  // a medial surface passes between: no gradient there
        ++creases;
        continue;
      }
      int element = -1;
      ASSERT_LT(glm::distance(core_f64::distance_gradient(vessel, p, element), (forward + backward) / 2.0), 1e-7)
          << data.name << " at " << q.x << ", " << q.y;
      ++compared;
    }
    EXPECT_GT(compared, 3000) << data.name;
    EXPECT_LT(creases, 4) << data.name;  // at most 1 in 1,000
  }
}

TEST(Sdf, GradientIsTheWayToTheNearestPoint) {
  // moving by the distance against the gradient ends on the surface, away from the medial axis as on it
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(beaker3())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(8);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = around(point_in_box(data, random), random.uniform(-PI, PI));
      int element = -1;
      const double sdf = core_f64::signed_distance(vessel, p);
      const Vec3 foot = p - sdf * core_f64::distance_gradient(vessel, p, element);
      ASSERT_NEAR(core_f64::signed_distance(vessel, foot), 0, 1e-15) << data.name;  // a normalisation and a product: a few 1e-17 m
    }
  }
}

TEST(Sdf, GradientOnTheSurfaceIsTheOutwardNormal) {
  for (const VesselData& data : solids()) {
    const Vessel vessel = ready_vessel(data);
    for (const Piece& piece : pieces_of(data)) {
      for (const double t : {0.05, 0.3, 0.5, 0.77, 0.98}) {
        // within 10 um of it the way to the nearest point has lost its digits: the element's own normal has not
        for (const double off : {0.0, 1e-17, -1e-17, 1e-14, -1e-14, 1e-11, -1e-11, 1e-8, -1e-8, 1e-6, -1e-6}) {
          const Vec2 normal = piece.normal(t);
          int element = -1;
          const Vec2 g = core_f64::profile_gradient(vessel, piece.at(t) + off * normal, element);
          // 1e-12: 1e-17 m of rounding over arcs of millimeters and elements of millimeters
          ASSERT_LT(glm::distance(g, normal), 1e-12) << data.name << ", off by " << off;
        }
      }
    }
  }
}

TEST(Sdf, GradientOfAShellPointsOutOfTheWallOnBothSides) {
  const Vessel vessel = ready_vessel(shell_of(beaker1()));  // wall from r = 38.5 to 40 mm
  int element = -1;
  for (const double y : {20e-3, 55e-3, 100e-3}) {
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {40e-3, y, 0}, element), {1, 0, 0}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {38.5e-3, y, 0}, element), {-1, 0, 0}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, y, 39.9e-3}, element), {0, 0, 1}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, y, -38.6e-3}, element), {0, 0, 1}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, y, -30e-3}, element), {0, 0, 1}), 1e-12);
  }
  EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, 1.5e-3, 0.1e-3}, element), {0, 1, 0}), 1e-12);  // inner floor
  EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, 0, 0}, element), {0, -1, 0}), 1e-12);
}

TEST(Sdf, RadialDirectionOnTheAxisIsX) {
  for (const VesselData& data : {beaker1(), beaker2(), vase(), ledges(), shell_of(beaker1())}) {
    const Vessel vessel = ready_vessel(data);
    int radial = 0;
    for (int i = -20; i <= 120; ++i) {
      const double y = data.height * i / 100;
      int element = -1, same = -1;
      const Vec2 profile = core_f64::profile_gradient(vessel, {0, y}, element);
      const Vec3 g = core_f64::distance_gradient(vessel, {0, y, 0}, same);
      EXPECT_EQ(g, (Vec3{profile.x, profile.y, 0})) << data.name << " at height " << y;
      EXPECT_EQ(element, same);
      if (std::abs(g.x) > 0.5) ++radial;
    }
    EXPECT_GT(radial, 10) << data.name;  // somewhere the wall is nearest, and every direction as good
  }
}

TEST(Sdf, OfEquallyNearElementsTheFirstDecides) {
  // a cylinder of radius 2 and height 8 in whole numbers, so that ties are exact
  Vessel vessel;
  vessel.outline = {straight({0, 0}, {2, 0}), straight({2, 0}, {2, 8}), straight({2, 8}, {0, 8})};
  int element = -1;
  EXPECT_EQ(core_f64::profile_gradient(vessel, {1, 1}, element), (Vec2{0, -1}));  // base and wall
  EXPECT_EQ(element, 0);
  EXPECT_EQ(core_f64::profile_gradient(vessel, {1, 7}, element), (Vec2{1, 0}));  // wall and mouth
  EXPECT_EQ(element, 1);
  EXPECT_EQ(core_f64::profile_gradient(vessel, {2, 0}, element), (Vec2{0, -1}));  // on their corner
  EXPECT_EQ(element, 0);
  core_f64::profile_gradient(vessel, {5, 12}, element);  // beyond the corner of wall and mouth
  EXPECT_EQ(element, 1);
  Vessel reordered = vessel;
  std::swap(reordered.outline[0], reordered.outline[1]);
  EXPECT_EQ(core_f64::profile_gradient(reordered, {1, 1}, element), (Vec2{1, 0}));
  EXPECT_EQ(element, 0);
}

// ---- crossings ----

TEST(Sdf, CrossingsAreHalfOpen) {
  const Element rising = straight({1, 0}, {1, 2}), falling = straight({1, 2}, {1, 0}), slanted = straight({1, 0}, {3, 2}),
                level = straight({1, 1}, {3, 1});
  for (const Element& element : {rising, falling, slanted}) {
    EXPECT_TRUE(core_f64::element_crosses(element, {0, 0}));  // counts for y in [min, max)
    EXPECT_TRUE(core_f64::element_crosses(element, {0, 1}));
    EXPECT_FALSE(core_f64::element_crosses(element, {0, 2}));
    EXPECT_FALSE(core_f64::element_crosses(element, {0, -1e-9}));
    EXPECT_FALSE(core_f64::element_crosses(element, {4, 1}));
  }
  EXPECT_TRUE(core_f64::element_crosses(slanted, {1.5, 1}));
  EXPECT_FALSE(core_f64::element_crosses(slanted, {2.5, 1}));
  for (const double r : {0.0, 1.0, 2.0, 5.0}) EXPECT_FALSE(core_f64::element_crosses(level, {r, 1}));
}

TEST(Sdf, CrossingsOfArcsAreHalfOpen) {
  // quarter circles of radius 5 about (6, 0): 3, 4, 5 gives exact points
  const Element right{{11, 0}, {6, 5}, {6, 0}, 5, 1}, left{{6, 5}, {1, 0}, {6, 0}, 5, -1};
  EXPECT_TRUE(core_f64::element_crosses(right, {0, 0}));
  EXPECT_FALSE(core_f64::element_crosses(right, {0, 5}));
  EXPECT_TRUE(core_f64::element_crosses(right, {9.9, 3}));  // crossing at r = 10
  EXPECT_FALSE(core_f64::element_crosses(right, {10.1, 3}));
  EXPECT_TRUE(core_f64::element_crosses(left, {1.9, 3}));  // crossing at r = 2
  EXPECT_FALSE(core_f64::element_crosses(left, {2.1, 3}));
  EXPECT_FALSE(core_f64::element_crosses(left, {0, -1}));
}

TEST(Sdf, SignDoesNotFlipLevelWithTheEndOfAnElement) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    int compared = 0;
    for (const Element& element : vessel.outline) {
      for (const double level : {element.a.y, element.b.y}) {
        for (int i = 0; i <= 120; ++i) {
          const double r = i * 0.5e-3 + 0.1e-3;
          const double sdf = core_f64::profile_distance(vessel, {r, level});
          if (std::abs(sdf) < 1e-6) continue;  // on a level element
          // within the distance to the surface nothing can change its sign
          for (const double off : {-0.9 * std::abs(sdf), -1e-9, 1e-9, 0.9 * std::abs(sdf)}) {
            const double beside = core_f64::profile_distance(vessel, {r, level + off});
            ASSERT_GT(sdf * beside, 0) << data.name << " at " << r << ", " << level;
            ++compared;
          }
        }
      }
    }
    EXPECT_GT(compared, 900);
  }
}

// ---- elements ----

TEST(Sdf, DistanceToALine) {
  // 1e-15: rounding of numbers under 100
  const Element line = straight({1, 1}, {5, 4});
  EXPECT_NEAR(core_f64::element_distance_squared(line, {3, 2.5}), 0, 1e-15);
  EXPECT_NEAR(core_f64::element_distance_squared(line, {3 - 3, 2.5 + 4}), 25, 1e-13);  // beside it
  EXPECT_NEAR(core_f64::element_distance_squared(line, {3 + 1.5, 2.5 - 2}), 6.25, 1e-14);
  EXPECT_NEAR(core_f64::element_distance_squared(line, {0, 0}), 2, 1e-15);   // before its start
  EXPECT_NEAR(core_f64::element_distance_squared(line, {8, 8}), 25, 1e-13);  // beyond its end
}

TEST(Sdf, DistanceToAnArc) {
  const Element right{{11, 0}, {6, 5}, {6, 0}, 5, 1};
  EXPECT_NEAR(core_f64::element_distance_squared(right, {9, 4}), 0, 1e-13);    // on it: 3, 4, 5; the root of 25 and back
  EXPECT_NEAR(core_f64::element_distance_squared(right, {12, 8}), 25, 1e-13);  // twice as far from the center
  EXPECT_NEAR(core_f64::element_distance_squared(right, {6, 0}), 25, 1e-13);   // its center
  EXPECT_NEAR(core_f64::element_distance_squared(right, {7.5, 2}), 6.25, 1e-13);
  EXPECT_NEAR(core_f64::element_distance_squared(right, {11, -3}), 9, 1e-13);  // nearest its start
  EXPECT_NEAR(core_f64::element_distance_squared(right, {2, 5}), 16, 1e-13);   // nearest its end, not the circle's other side
  EXPECT_NEAR(core_f64::element_distance_squared(right, {2, -3}), 80, 1e-12);  // opposite: its nearer end, (6, 5)
}

TEST(Sdf, ArcsAreSplitAtThePolesOfTheirCircles) {
  const auto elements = monotone_elements(ledges().outline);
  EXPECT_EQ(elements.size(), 14u);  // twelve, and the trough and the bump in two each
  for (const VesselData& data : solids()) {
    const auto parts = monotone_elements(data.outline);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const PreparedElement& part = parts[i];
      if (i > 0) {
        EXPECT_EQ(part.a, parts[i - 1].b) << data.name;
      }
      EXPECT_NE(part.a, part.b) << data.name;  // nothing of no length where an arc starts or ends at a pole
      if (part.side == 0) continue;
      // both ends on its half of the circle, so y is monotone between them
      EXPECT_GE(part.side * (part.a[0] - part.center[0]), -1e-15) << data.name;
      EXPECT_GE(part.side * (part.b[0] - part.center[0]), -1e-15) << data.name;
      for (const auto& end : {part.a, part.b}) {
        EXPECT_NEAR(std::hypot(end[0] - part.center[0], end[1] - part.center[1]), part.radius,
                    1e-15);  // rounding of coordinates under 0.2 m
      }
    }
    EXPECT_EQ(parts.front().a, (std::array<double, 2>{0, 0}));
    EXPECT_EQ(parts.back().b, (std::array<double, 2>{0, data.height}));
  }
}

TEST(Sdf, BoundingSphereHoldsTheVessel) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    for (const Piece& piece : pieces_of(data)) {
      for (int i = 0; i <= 100; ++i) {
        const Vec2 q = piece.at(i / 100.0);
        EXPECT_LE(std::hypot(q.x, q.y - vessel.bound_height), vessel.bound_radius + 1e-15) << data.name;  // rounding
      }
    }
    EXPECT_LT(vessel.bound_radius, 2 * std::hypot(largest_radius(data), data.height));  // and not much more
  }
}

}  // namespace
}  // namespace wholehand

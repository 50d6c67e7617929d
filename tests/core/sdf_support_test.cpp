// SPDX-License-Identifier: MIT
// Kernel 2: what surrounds a point, how far it may go without passing a surface.
#include "core/sdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/sampled_outline.h"

namespace wholehand {
namespace {

using core_f64::Element;
using core_f64::Vessel;

// A line from a to b: where an arc has its center stands the outward normal.
Element line_element(Vec2 a, Vec2 b) { return {a, b, glm::normalize(Vec2{b.y - a.y, a.x - b.x})}; }

// ---- what surrounds a point: how far it may go without passing a surface ----

// A point of an outline's element swept round the axis.
Vec3 swept(const Element& element, double t, double azimuth) {
  Vec2 q{element.a.x + t * (element.b.x - element.a.x), element.a.y + t * (element.b.y - element.a.y)};
  if (element.side != 0) {
    const double chord = q.y - element.center.y;
    q.x = element.center.x + element.side * std::sqrt(std::max(0.0, element.radius * element.radius - chord * chord));
  }
  return around(q, azimuth);
}

TEST(Sdf, SupportIsTheDistanceAndItsGradientButOfALatticeTheDistanceAlone) {
  for (const VesselData& data : {beaker1(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data), lattice = lattice_vessel(data, 16);
    Random random(14);
    for (int n = 0; n < 1000; ++n) {
      const Vec3 p = around(point_in_box(data, random), random.uniform(-PI, PI));
      for (const Vessel* each : {&vessel, &lattice}) {
        const core_f64::Support support = core_f64::support_at(*each, p);
        int element = -2;
        EXPECT_EQ(support.distance, core_f64::signed_distance(*each, p));
        const Vec3 gradient = core_f64::distance_gradient(*each, p, element);
        EXPECT_EQ(support.normal, each == &lattice ? Vec3(0) : gradient);
        EXPECT_EQ(support.element, element);
      }
      EXPECT_FALSE(core_f64::support_at(lattice, p).planar);
    }
  }
}

TEST(Sdf, SupportingPlaneHasTheNearestElementBeyondIt) {
  for (const VesselData& data :
       {beaker1(), beaker2(), beaker3(), vase(), ledges(), can(), spindle(), shell_of(beaker1()), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(15);
    int planar = 0, outside = 0;
    std::vector<Vec3> points;
    for (int n = 0; n < 1500; ++n) points.push_back(around(point_in_box(data, random), random.uniform(-PI, PI)));
    for (const Vec2& q : queries(data, pieces_of(data), 0, 16)) points.push_back(around(q, random.uniform(-PI, PI)));
    for (const Vec3& p : points) {
      if (std::abs(p.x) > 0.5 || std::abs(p.y) > 0.5) continue;
      const core_f64::Support support = core_f64::support_at(vessel, p);
      outside += support.distance > 0;
      planar += support.planar;
      if (!support.planar || support.distance < 1e-12) continue;  // on the surface there is no step to bound
      ASSERT_GE(support.distance, 0);
      const auto nearest = static_cast<std::size_t>(support.element);
      for (std::size_t e = 0; e < vessel.outline.size(); ++e) {
        const Element& element = vessel.outline[e];
        for (int i = 0; i <= 8; ++i) {
          for (int k = 0; k < 12; ++k) {
            const Vec3 x = swept(element, i / 8.0, std::atan2(p.z, p.x) + k * PI / 6);
            // 1e-15 m: rounding
            const bool beyond = glm::dot(x - p, support.normal) <= -support.distance + 1e-15;
            const bool away = glm::distance(x, p) >= support.other - 1e-15;
            if (e == nearest) {
              ASSERT_TRUE(beyond) << data.name << ", element " << e << " at " << p.x << ", " << p.y << ", " << p.z;
            } else {
              ASSERT_TRUE(away || beyond) << data.name << ", element " << e << " at " << p.x << ", " << p.y << ", " << p.z;
            }
          }
        }
      }
    }
    EXPECT_GT(planar, outside / 4) << data.name;
  }
}

TEST(Sdf, SupportKnowsOfAnElementThatIsAsNear) {
  // in the corner of a level ledge and a wall, in whole numbers: one away from both, and their shared end is further
  Vessel vessel;
  vessel.outline = {line_element({0, 0}, {3, 0}), line_element({3, 0}, {3, 2}), line_element({3, 2}, {1, 2}),
                    line_element({1, 2}, {1, 8}), line_element({1, 8}, {0, 8})};
  const core_f64::Support support = core_f64::support_at(vessel, {2, 3, 0});
  EXPECT_EQ(support.element, 2);
  EXPECT_EQ(support.distance, 1);
  EXPECT_EQ(support.other, 1);
  EXPECT_LE(core_f64::safe_step(support, 1, {-1, 0, 0}, 1, 0), 1);  // along the ledge it would never meet the ledge
  // off the ledge's outer edge the edge stands for both that meet there, and the wall is the next
  const core_f64::Support edge = core_f64::support_at(vessel, {6, 6, 0});
  EXPECT_EQ(edge.element, 1);
  EXPECT_TRUE(edge.planar);
  EXPECT_EQ(edge.distance, 5);
  EXPECT_EQ(edge.other, 5);
}

TEST(Sdf, SafeStepPassesNoSurface) {
  // points on straight lines and on circles: nowhere along a step does the separation change its sign
  for (const VesselData& data :
       {beaker1(), beaker2(), beaker3(), vase(), ledges(), can(), spindle(), shell_of(beaker1()), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(17);
    int steps = 0, longer = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = around(point_in_box(data, random), random.uniform(-PI, PI));
      const core_f64::Support support = core_f64::support_at(vessel, p);
      const double radius = n % 4 == 0 ? 0 : std::min(8e-3, support.distance * random.uniform(0, 1));
      const double separation = support.distance - radius;
      if (separation <= 1e-9) continue;
      Vec3 velocity = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      if (n % 3 == 0) velocity = glm::normalize(velocity - 2.0 * support.normal);  // towards the wall
      // a circle of radius 60 mm by angle, or a line by length
      const bool turns = n % 2;
      const double reach = 60e-3, speed = turns ? reach : 1, acceleration = turns ? reach : 0;
      const Vec3 inwards = glm::normalize(glm::cross(velocity, Vec3{0.3, -0.5, 0.8}));
      const Vec3 center = p + reach * inwards;
      const auto at = [&](double s) {
        return turns ? center - reach * std::cos(s) * inwards + reach * std::sin(s) * velocity : p + s * velocity;
      };
      const double step = core_f64::safe_step(support, separation, speed * velocity, speed, acceleration);
      ASSERT_GE(step, separation / speed * (1 - 1e-12));
      ++steps;
      longer += step > 1.01 * separation / speed;
      const double end = std::min(step, turns ? PI : 1.0);
      for (int i = 1; i <= 50; ++i) {
        // 1e-12 m: rounding of a root over the step, where it ends on the surface
        ASSERT_GE(core_f64::signed_distance(vessel, at(end * i / 50)) - radius, -1e-12)
            << data.name << " from " << p.x << ", " << p.y << ", " << p.z;
      }
    }
    EXPECT_GT(steps, 1000) << data.name;
    EXPECT_GT(longer, steps / 10) << data.name;  // it does gain something over separation / speed
  }
}

TEST(Sdf, SafeStepOfAPointAtRestIsUnbounded) {
  core_f64::Support support;
  support.distance = 1e-3;
  EXPECT_GT(core_f64::safe_step(support, 1e-3, {}, 0, 0), 1e6);
}

}  // namespace
}  // namespace wholehand

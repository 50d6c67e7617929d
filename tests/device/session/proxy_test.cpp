// SPDX-License-Identifier: MIT
// Proxies of the tracked tips: against closed forms and brute force, with and without friction.
// sanitizers: none
#include "device/session/proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/scenes.h"
#include "tests/support/tabletop.h"
#include "tests/support/vectors.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

std::vector<VesselData> beakers() {
  return {beaker1(), beaker2(), beaker3(), shell_of(beaker1()), shell_of(beaker2()), shell_of(beaker3()), vase()};
}

// ---- what is nearest ----

TEST(NearestVessel, TakesTheNearestSolidOne) {
  const Tabletop table({beaker1(), beaker2(), beaker3()}, {Vec3(0), Vec3(0.3, 0, 0), Vec3(0, 0, 0.5)});
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 p(random.uniform(-0.2, 0.6), random.uniform(-0.1, 0.3), random.uniform(-0.2, 0.8));
    const double radius = k % 2 ? FINGERTIP : 0;
    int best = -1;
    double least = 1e9;
    for (int v = 0; v < 3; ++v) {
      const double s = vessel_separation(table.obstacles.standing[v], p, radius);
      if (s < least) least = s, best = v;
    }
    const NearestVessel nearest = nearest_vessel(table.obstacles, p, radius);
    EXPECT_EQ(nearest.vessel, best);
    EXPECT_EQ(nearest.separation, least);
  }
}

TEST(NearestVessel, PassesOverWhatIsNotSolid) {
  Tabletop table({beaker1(), beaker2()}, {Vec3(0), Vec3(0.3, 0, 0)});
  table.obstacles.standing[0].is_solid = false;
  EXPECT_EQ(nearest_vessel(table.obstacles, Vec3(0.05, 0.05, 0), 0).vessel, 1);
  table.obstacles.standing[1].is_solid = false;
  EXPECT_EQ(nearest_vessel(table.obstacles, Vec3(0.05, 0.05, 0), 0).vessel, -1);
}

// ---- without friction ----

TEST(Proxy, IsTheTipWhereNothingIsTouched) {
  const Tabletop table({beaker1()}, {TABLETOP_PLACE});
  Proxy before;
  before.place = TABLETOP_PLACE + Vec3(0.2, 0.05, 0);
  const Vec3 tip = TABLETOP_PLACE + Vec3(0.2, 0.3, 0.1);
  const Proxy proxy = carry_proxy(table.obstacles, before, tip, FINGERTIP, 0.6);
  EXPECT_LT(glm::length(proxy.place - tip), 1e-9);
  EXPECT_EQ(proxy.vessel, -1);
  EXPECT_EQ(proxy.element, -1);
}

// Closed forms: a cylinder's side pushes out radially, its lid straight up, the flask's ball along its radius. The search ends
// where a step gains less than 1e-9 m; at a depth D that is a sideways error of sqrt(2 D 1e-9), for 5 mm 3 um.
TEST(Proxy, ComesToTheNearestPlaceOfASmoothSurface) {
  for (const double radius : {0.0, FINGERTIP}) {
    const Tabletop table({beaker1(), beaker2()}, {TABLETOP_PLACE, TABLETOP_PLACE + Vec3(0.3, 0, 0)});
    const Vec3 center = table.obstacles.standing[1].place + Vec3(0, 42.5e-3, 0);
    Random random(7);
    for (int k = 0; k < 40; ++k) {
      const double depth = random.uniform(0.2e-3, 5e-3), a = random.uniform(-PI, PI), y = random.uniform(20e-3, 80e-3);
      const Vec3 side = TABLETOP_PLACE + around_axis(40e-3 + radius - depth, y, a);
      Proxy proxy = carry_along(table.obstacles, TABLETOP_PLACE + around_axis(70e-3, y + 5e-3, a + 0.1), side, 60, radius, 0);
      EXPECT_LT(glm::length(proxy.place - (TABLETOP_PLACE + around_axis(40e-3 + radius, y, a))), 5e-6) << radius;
      EXPECT_EQ(proxy.vessel, 0);
      EXPECT_LT(glm::length(proxy.normal - around_axis(1, 0, a)), 2e-4);

      const Vec3 above = around_axis(random.uniform(0, 30e-3), 110e-3 + radius, a);
      proxy = carry_along(table.obstacles, TABLETOP_PLACE + above + Vec3(2e-3, 30e-3, 0),
                          TABLETOP_PLACE + above - Vec3(0, depth, 0), 60, radius, 0);
      EXPECT_LT(glm::length(proxy.place - (TABLETOP_PLACE + above)), 5e-6) << radius;

      Vec3 out = random_unit(random);
      out.y = -0.5 + 0.4 * out.y;
      out = glm::normalize(out);
      proxy = carry_along(table.obstacles, center + 80e-3 * out, center + (42.5e-3 + radius - depth) * out, 60, radius, 0);
      EXPECT_LT(glm::length(proxy.place - (center + (42.5e-3 + radius) * out)), 5e-6) << radius;
      EXPECT_EQ(proxy.vessel, 1);
    }
  }
}

// Wherever a tip comes to rest, edges and creases and thin walls included: of many places around the proxy, from a micrometer to
// millimeters away, none that is outside is nearer to the tip. 3e-8 m: a proxy may be PROXY_OUTSIDE
// inside, or as much above it, and the search ends where a step gains less than 1e-9.
TEST(Proxy, NoPlaceNearbyIsNearerToTheTip) {
  Random random(11);
  int touching = 0;
  for (const VesselData& data : beakers()) {
    const Tabletop table({data}, {TABLETOP_PLACE});
    for (const double radius : {0.0, 2e-3, FINGERTIP}) {
      for (int k = 0; k < 60; ++k) {
        // from outside or from within, to a few millimeters beyond the surface
        const Vec3 target =
            TABLETOP_PLACE + around_axis(random.uniform(0, 45e-3), random.uniform(0, 1.05 * data.height), random.uniform(-PI, PI));
        Vec3 from = target + random.uniform(5e-3, 40e-3) * random_unit(random);
        if (table.separation(from, radius) < 0) continue;
        Proxy proxy;
        proxy.place = from;
        // to where it is pressed in by up to 6 mm
        Vec3 tip = from;
        const Vec3 step = 0.4e-3 * glm::normalize(target - from);
        for (int n = 0; n < 150 && glm::length(tip - proxy.place) < 6e-3; ++n) {
          tip += step;
          proxy = carry_proxy(table.obstacles, proxy, tip, radius, 0);
        }
        for (int n = 0; n < 30; ++n) proxy = carry_proxy(table.obstacles, proxy, tip, radius, 0);
        const double distance = glm::length(tip - proxy.place);
        ASSERT_GE(table.separation(proxy.place, radius), -PROXY_OUTSIDE);
        if (distance < 1e-4) continue;
        ++touching;
        double nearest = distance;
        for (int n = 0; n < 1500; ++n) {
          const double reach = std::pow(10, random.uniform(-6, -3));  // less than a wall
          const Vec3 p = proxy.place + reach * random_unit(random);
          if (glm::length(tip - p) < nearest && table.separation(p, std::max(radius, PROXY_SKIN)) >= 0)
            nearest = glm::length(tip - p);
        }
        EXPECT_GT(nearest, distance - 3e-8) << data.name << " radius " << radius << " depth " << distance << " at "
                                            << glm::length(
                                                   Vec3(proxy.place.x - TABLETOP_PLACE.x, 0, proxy.place.z - TABLETOP_PLACE.z))
                                            << " " << proxy.place.y - TABLETOP_PLACE.y;
      }
    }
  }
  EXPECT_GT(touching, 300);
}

// The nearest feasible place of all, by a lattice over the half plane of the tip: where a tip pressed into a convex vessel by a
// little must come to. 30 um lattice: the nearest lattice place is at most its diagonal further away.
TEST(Proxy, IsTheNearestPlaceOfAllWhereTheVesselIsConvex) {
  const VesselData data = beaker1();
  const core_f64::Vessel vessel = ready_vessel(data);
  const Tabletop table({data}, {TABLETOP_PLACE});
  constexpr double SPACING = 30e-6;
  Random random(3);
  for (const double radius : {0.0, FINGERTIP}) {
    for (int k = 0; k < 12; ++k) {
      const double a = random.uniform(-PI, PI);
      const double r = 40e-3 + random.uniform(-4e-3, radius), y = 110e-3 + random.uniform(-4e-3, radius);
      const Vec3 tip = TABLETOP_PLACE + around_axis(r, y, a);
      if (table.separation(tip, radius) > -1e-4) continue;
      const bool from_above = 110e-3 - y < 40e-3 - r;
      const Vec3 from = tip + (from_above ? Vec3(0, 30e-3, 0) : around_axis(30e-3, 0, a));
      Proxy proxy = carry_along(table.obstacles, from, tip, 80, radius, 0);
      double least = 1;
      for (double dr = -14e-3; dr <= 14e-3; dr += SPACING)
        for (double dy = -14e-3; dy <= 14e-3; dy += SPACING) {
          const double away = std::hypot(dr, dy);
          if (away < least && core_f64::profile_distance(vessel, {r + dr, y + dy}) >= radius) least = away;
        }
      EXPECT_NEAR(glm::length(tip - proxy.place), least, 1.5 * SPACING) << r << " " << y;
      EXPECT_LE(glm::length(tip - proxy.place), least + PROXY_OUTSIDE);
    }
  }
}

// A tip that moves along a smooth surface takes its proxy along, bare or not, at an ordinary speed: no friction that nobody asked
// for. 10 um behind would be 8 mN.
TEST(Proxy, KeepsUpWithASlidingTip) {
  const Tabletop table({beaker1()}, {TABLETOP_PLACE});
  for (const double radius : {0.0, FINGERTIP}) {
    for (const double rate : {1000.0, 8000.0}) {
      Proxy proxy;
      proxy.place = TABLETOP_PLACE + around_axis(60e-3, 30e-3, 0);
      const double depth = 5e-3;
      double worst = 0;
      for (int k = 0; k < 400; ++k) {
        const double y = 30e-3 + 0.2 * k / rate, a = 4.0 * k / rate;  // 0.2 m/s up, 0.16 m/s round
        const Vec3 tip = TABLETOP_PLACE + around_axis(40e-3 + radius - std::min(depth, 0.1e-3 * k), y, a);
        proxy = carry_proxy(table.obstacles, proxy, tip, radius, 0);
        worst = std::max(worst, glm::length(proxy.place - (TABLETOP_PLACE + around_axis(40e-3 + radius, y, a))));
        if (k == 0) worst = 0;
      }
      EXPECT_LT(worst, 10e-6) << radius << " " << rate;
    }
  }
}

// Whatever a tip does, a reported touch is on the surface, within the 20 um of a bare point's least step.
TEST(Proxy, TouchesOnlyWhatItIsAt) {
  Random random(21);
  for (const double radius : {0.0, FINGERTIP}) {
    const Tabletop table({shell_of(beaker1()), beaker3()}, {TABLETOP_PLACE, TABLETOP_PLACE + Vec3(0.1, 0, 0)});
    Proxy proxy;
    proxy.place = TABLETOP_PLACE + Vec3(0, 0.3, 0);
    int touching = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 tip = TABLETOP_PLACE + Vec3(random.uniform(-0.1, 0.2), random.uniform(0, 0.2), random.uniform(-0.1, 0.1));
      proxy = carry_proxy(table.obstacles, proxy, tip, radius, 0.6);
      if (proxy.vessel < 0) continue;
      ++touching;
      EXPECT_LE(vessel_separation(table.obstacles.standing[proxy.vessel], proxy.place, radius), 25e-6);
      EXPECT_GT(glm::dot(proxy.normal, proxy.place - tip), 0);
    }
    EXPECT_GT(touching, 500);
  }
}

// ---- with friction ----

// On the lid, a plane: the tip is at a depth and moves sideways. It sticks while the way is less than mu times the depth.
TEST(Proxy, SticksWithinTheConeAndLagsBeyond) {
  const Tabletop table({beaker1()}, {TABLETOP_PLACE});
  for (const double radius : {0.0, FINGERTIP}) {
    for (const double friction : {0.3, 0.6, 1.2}) {
      const double top = 110e-3 + radius, depth = 2e-3;
      const Vec3 start = TABLETOP_PLACE + Vec3(-15e-3, top, 3e-3);
      Proxy proxy = carry_along(table.obstacles, start + Vec3(0, 5e-3, 0), start - Vec3(0, depth, 0), 50, radius, friction);
      EXPECT_LT(glm::length(proxy.place - start), radius > 0 ? 1e-7 : 2e-6);
      for (int k = 1; k <= 200; ++k) {
        const Vec3 tip = start + Vec3(0.05e-3 * k, -depth, 0);
        proxy = carry_proxy(table.obstacles, proxy, tip, radius, friction);
        const double behind = std::min(0.05e-3 * k, friction * depth);
        // a bare point has a skin of 1 um, by which it is higher and further behind
        EXPECT_LT(glm::length(proxy.place - (tip + Vec3(-behind, depth, 0))), radius > 0 ? 1e-7 : 3e-6) << k;
      }
    }
  }
}

TEST(Proxy, FrictionLetsGoWhenTheTipLeaves) {
  const Tabletop table({beaker1()}, {TABLETOP_PLACE});
  const Vec3 top = TABLETOP_PLACE + Vec3(0, 110e-3 + FINGERTIP, 0);
  Proxy proxy = carry_along(table.obstacles, top + Vec3(0, 5e-3, 0), top - Vec3(0, 2e-3, 0), 50, FINGERTIP, 0.6);
  const Vec3 away = top + Vec3(5e-3, 1e-3, 0);
  proxy = carry_proxy(table.obstacles, proxy, away, FINGERTIP, 0.6);
  EXPECT_LT(glm::length(proxy.place - away), 1e-9);
  EXPECT_EQ(proxy.vessel, -1);
}

}  // namespace
}  // namespace wholehand::device

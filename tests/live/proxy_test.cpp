// SPDX-License-Identifier: MIT
// Proxies of the tracked tips: against closed forms and brute force, under friction, and on long walks among vessels, where no wall may be
// crossed.
// sanitizers: none
#include "live/proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/force.h"
#include "tests/support/scenes.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

constexpr double OUTSIDE = 1e-8;    // m: a proxy is no deeper inside than this; what carry_proxy itself calls outside
constexpr double STIFFNESS = 800;   // N/m, the defaults of [live]
constexpr double DAMPING = 1;       // N s/m
constexpr double WALL = 1.5e-3;     // m, of every beaker
constexpr double FINGERTIP = 8e-3;  // m
constexpr double SKIN = 1e-6;       // m: that carry_proxy gives a bare point

// Vessels that stand somewhere, off the origin, so that a forgotten offset shows.
struct Tabletop {
  std::vector<core_f64::Vessel> vessels;
  Obstacles obstacles;

  Tabletop(const std::vector<VesselData>& data, const std::vector<Vec3>& places) {
    vessels.reserve(data.size());
    for (std::size_t k = 0; k < data.size(); ++k) {
      vessels.push_back(ready_vessel(data[k]));
      obstacles.standing[k] = {&vessels[k], places[k], true};
    }
    obstacles.count = static_cast<int>(data.size());
    obstacles.thinnest = WALL;
  }
  double separation(Vec3 p, double radius) const { return nearest_vessel(obstacles, p, radius).separation; }
};

const Vec3 SOMEWHERE(0.13, 0.02, -0.07);

Vec3 around(double r, double y, double azimuth) { return Vec3(r * std::cos(azimuth), y, -r * std::sin(azimuth)); }

// Carries a proxy along a straight way in steps, from where it is free.
Proxy carry_along(const Obstacles& obstacles, Vec3 from, Vec3 to, int steps, double radius, double friction) {
  Proxy proxy;
  proxy.place = from;
  for (int k = 1; k <= steps; ++k) {
    proxy = carry_proxy(obstacles, proxy, glm::mix(from, to, static_cast<double>(k) / steps), radius, friction);
  }
  return proxy;
}

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
  const Tabletop table({beaker1()}, {SOMEWHERE});
  Proxy before;
  before.place = SOMEWHERE + Vec3(0.2, 0.05, 0);
  const Vec3 tip = SOMEWHERE + Vec3(0.2, 0.3, 0.1);
  const Proxy proxy = carry_proxy(table.obstacles, before, tip, FINGERTIP, 0.6);
  EXPECT_LT(glm::length(proxy.place - tip), 1e-9);
  EXPECT_EQ(proxy.vessel, -1);
  EXPECT_EQ(proxy.element, -1);
}

// Closed forms: a cylinder's side pushes out radially, its lid straight up, the flask's ball along its radius. The search ends where a
// step gains less than 1e-9 m; at a depth D that is a sideways error of sqrt(2 D 1e-9), for 5 mm 3 um.
TEST(Proxy, ComesToTheNearestPlaceOfASmoothSurface) {
  for (const double radius : {0.0, FINGERTIP}) {
    const Tabletop table({beaker1(), beaker2()}, {SOMEWHERE, SOMEWHERE + Vec3(0.3, 0, 0)});
    const Vec3 center = table.obstacles.standing[1].place + Vec3(0, 42.5e-3, 0);
    Random random(7);
    for (int k = 0; k < 40; ++k) {
      const double depth = random.uniform(0.2e-3, 5e-3), a = random.uniform(-PI, PI), y = random.uniform(20e-3, 80e-3);
      const Vec3 side = SOMEWHERE + around(40e-3 + radius - depth, y, a);
      Proxy proxy = carry_along(table.obstacles, SOMEWHERE + around(70e-3, y + 5e-3, a + 0.1), side, 60, radius, 0);
      EXPECT_LT(glm::length(proxy.place - (SOMEWHERE + around(40e-3 + radius, y, a))), 5e-6) << radius;
      EXPECT_EQ(proxy.vessel, 0);
      EXPECT_LT(glm::length(proxy.normal - around(1, 0, a)), 2e-4);

      const Vec3 above = around(random.uniform(0, 30e-3), 110e-3 + radius, a);
      proxy = carry_along(table.obstacles, SOMEWHERE + above + Vec3(2e-3, 30e-3, 0), SOMEWHERE + above - Vec3(0, depth, 0), 60,
                          radius, 0);
      EXPECT_LT(glm::length(proxy.place - (SOMEWHERE + above)), 5e-6) << radius;

      Vec3 out = random_unit(random);
      out.y = -0.5 + 0.4 * out.y;
      out = glm::normalize(out);
      proxy = carry_along(table.obstacles, center + 80e-3 * out, center + (42.5e-3 + radius - depth) * out, 60, radius, 0);
      EXPECT_LT(glm::length(proxy.place - (center + (42.5e-3 + radius) * out)), 5e-6) << radius;
      EXPECT_EQ(proxy.vessel, 1);
    }
  }
}

// Wherever a tip comes to rest, edges and creases and thin walls included: of many places around the proxy, from a micrometre to
// millimetres away, none that is outside is nearer to the tip. 3e-8 m: a proxy may be OUTSIDE
// inside, or as much above it, and the search ends where a step gains less than 1e-9.
TEST(Proxy, NoPlaceNearbyIsNearerToTheTip) {
  Random random(11);
  int touching = 0;
  for (const VesselData& data : beakers()) {
    const Tabletop table({data}, {SOMEWHERE});
    for (const double radius : {0.0, 2e-3, FINGERTIP}) {
      for (int k = 0; k < 60; ++k) {
        // from outside or from within, to a few millimetres beyond the surface
        const Vec3 target =
            SOMEWHERE + around(random.uniform(0, 45e-3), random.uniform(0, 1.05 * data.height), random.uniform(-PI, PI));
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
        ASSERT_GE(table.separation(proxy.place, radius), -OUTSIDE);
        if (distance < 1e-4) continue;
        ++touching;
        double nearest = distance;
        for (int n = 0; n < 1500; ++n) {
          const double reach = std::pow(10, random.uniform(-6, -3));  // less than a wall
          const Vec3 p = proxy.place + reach * random_unit(random);
          if (glm::length(tip - p) < nearest && table.separation(p, std::max(radius, SKIN)) >= 0) nearest = glm::length(tip - p);
        }
        EXPECT_GT(nearest, distance - 3e-8) << data.name << " radius " << radius << " depth " << distance << " at "
                                            << glm::length(Vec3(proxy.place.x - SOMEWHERE.x, 0, proxy.place.z - SOMEWHERE.z)) << " "
                                            << proxy.place.y - SOMEWHERE.y;
      }
    }
  }
  EXPECT_GT(touching, 300);
}

// The nearest feasible place of all, by a lattice over the half plane of the tip: where a tip pressed into a convex vessel by a little
// must come to. 30 um lattice: the nearest lattice place is at most its diagonal further away.
TEST(Proxy, IsTheNearestPlaceOfAllWhereTheVesselIsConvex) {
  const VesselData data = beaker1();
  const core_f64::Vessel vessel = ready_vessel(data);
  const Tabletop table({data}, {SOMEWHERE});
  constexpr double SPACING = 30e-6;
  Random random(3);
  for (const double radius : {0.0, FINGERTIP}) {
    for (int k = 0; k < 12; ++k) {
      const double a = random.uniform(-PI, PI);
      const double r = 40e-3 + random.uniform(-4e-3, radius), y = 110e-3 + random.uniform(-4e-3, radius);
      const Vec3 tip = SOMEWHERE + around(r, y, a);
      if (table.separation(tip, radius) > -1e-4) continue;
      const bool from_above = 110e-3 - y < 40e-3 - r;
      const Vec3 from = tip + (from_above ? Vec3(0, 30e-3, 0) : around(30e-3, 0, a));
      Proxy proxy = carry_along(table.obstacles, from, tip, 80, radius, 0);
      double least = 1;
      for (double dr = -14e-3; dr <= 14e-3; dr += SPACING)
        for (double dy = -14e-3; dy <= 14e-3; dy += SPACING) {
          const double away = std::hypot(dr, dy);
          if (away < least && core_f64::profile_distance(vessel, {r + dr, y + dy}) >= radius) least = away;
        }
      EXPECT_NEAR(glm::length(tip - proxy.place), least, 1.5 * SPACING) << r << " " << y;
      EXPECT_LE(glm::length(tip - proxy.place), least + OUTSIDE);
    }
  }
}

// A tip that moves along a smooth surface takes its proxy along, bare or not, at an ordinary speed: no friction that nobody asked for. 10 um
// behind would be 8 mN.
TEST(Proxy, KeepsUpWithASlidingTip) {
  const Tabletop table({beaker1()}, {SOMEWHERE});
  for (const double radius : {0.0, FINGERTIP}) {
    for (const double rate : {1000.0, 8000.0}) {
      Proxy proxy;
      proxy.place = SOMEWHERE + around(60e-3, 30e-3, 0);
      const double depth = 5e-3;
      double worst = 0;
      for (int k = 0; k < 400; ++k) {
        const double y = 30e-3 + 0.2 * k / rate, a = 4.0 * k / rate;  // 0.2 m/s up, 0.16 m/s round
        const Vec3 tip = SOMEWHERE + around(40e-3 + radius - std::min(depth, 0.1e-3 * k), y, a);
        proxy = carry_proxy(table.obstacles, proxy, tip, radius, 0);
        worst = std::max(worst, glm::length(proxy.place - (SOMEWHERE + around(40e-3 + radius, y, a))));
        if (k == 0) worst = 0;
      }
      EXPECT_LT(worst, 10e-6) << radius << " " << rate;
    }
  }
}

// Whatever a tip does, what is said to touch is on the surface, within the 20 um of a bare point's least step.
TEST(Proxy, TouchesOnlyWhatItIsAt) {
  Random random(21);
  for (const double radius : {0.0, FINGERTIP}) {
    const Tabletop table({shell_of(beaker1()), beaker3()}, {SOMEWHERE, SOMEWHERE + Vec3(0.1, 0, 0)});
    Proxy proxy;
    proxy.place = SOMEWHERE + Vec3(0, 0.3, 0);
    int touching = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 tip = SOMEWHERE + Vec3(random.uniform(-0.1, 0.2), random.uniform(0, 0.2), random.uniform(-0.1, 0.1));
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
  const Tabletop table({beaker1()}, {SOMEWHERE});
  for (const double radius : {0.0, FINGERTIP}) {
    for (const double friction : {0.3, 0.6, 1.2}) {
      const double top = 110e-3 + radius, depth = 2e-3;
      const Vec3 start = SOMEWHERE + Vec3(-15e-3, top, 3e-3);
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
  const Tabletop table({beaker1()}, {SOMEWHERE});
  const Vec3 top = SOMEWHERE + Vec3(0, 110e-3 + FINGERTIP, 0);
  Proxy proxy = carry_along(table.obstacles, top + Vec3(0, 5e-3, 0), top - Vec3(0, 2e-3, 0), 50, FINGERTIP, 0.6);
  const Vec3 away = top + Vec3(5e-3, 1e-3, 0);
  proxy = carry_proxy(table.obstacles, proxy, away, FINGERTIP, 0.6);
  EXPECT_LT(glm::length(proxy.place - away), 1e-9);
  EXPECT_EQ(proxy.vessel, -1);
}

// ---- walls ----

bool is_within(const core_f64::Vessel& vessel, Vec3 p) {
  if (p.y <= vessel.floor_height || p.y >= vessel.mouth_height) return false;
  for (const core_f64::Element& piece : vessel.cavity) {
    if (p.y >= piece.a.y && p.y <= piece.b.y) return std::hypot(p.x, p.z) <= core_f64::element_radius(piece, p.y) + 1e-7;
  }
  return false;
}

TEST(Proxy, StaysOnItsSideOfAThinWall) {
  for (const VesselData& data : {shell_of(beaker1()), shell_of(beaker2()), shell_of(beaker3())}) {
    const Tabletop table({data}, {SOMEWHERE});
    Random random(5);
    for (const double rate : {1000.0, 2000.0, 3000.0, 8000.0}) {
      for (const double radius : {0.0, FINGERTIP}) {
        for (const double friction : {0.0, 0.6}) {
          for (int k = 0; k < 10; ++k) {
            // through the wall at 1 m/s: in the direction of a radius, or aslant, in from outside and out from inside
            const double y = random.uniform(20e-3, 60e-3), a = random.uniform(-PI, PI),
                         aside = k % 2 ? random.uniform(-0.8, 0.8) : 0;
            const Vec3 out = around(1, 0, a), along = glm::normalize(out + aside * around(1, 0.3, a + PI / 2));
            const bool is_from_inside = k % 4 >= 2;
            const Vec3 begin = SOMEWHERE + (is_from_inside ? Vec3(0, y, 0) : Vec3(0, y, 0) + 70e-3 * along);
            const Vec3 way = (is_from_inside ? 1.0 : -1.0) * along / rate;
            if (table.separation(begin, radius) < 0) continue;  // a neck too narrow for the finger
            Proxy proxy;
            proxy.place = begin;
            Vec3 tip = begin;
            const auto steps = static_cast<int>(0.13 * rate);
            for (int n = 0; n < steps; ++n) {
              tip += way;
              proxy = carry_proxy(table.obstacles, proxy, tip, radius, friction);
              ASSERT_GE(table.separation(proxy.place, radius), -OUTSIDE);
              // once the tip is out on the other side there may be a way round; up to the far wall there is none
              if (is_within(table.vessels[0], proxy.place - SOMEWHERE) != is_from_inside) {
                FAIL() << data.name << " crossed at " << rate << " Hz, radius " << radius << ", " << n;
              }
              if (glm::length(tip - begin) > 95e-3) break;
            }
          }
        }
      }
    }
  }
}

// Long walks of a tip that goes anywhere, through walls as well: its proxy is never inside of anything, and goes into a vessel or out of it
// by its mouth alone. A proxy moves no more than PROXY_MOVES steps a tick, and one that changes sides was or is near the mouth.
void walk(const std::vector<VesselData>& data, double radius, double speed, double friction, std::uint64_t seed, int steps) {
  std::vector<Vec3> places;
  for (std::size_t k = 0; k < data.size(); ++k)
    places.push_back(SOMEWHERE + Vec3(0.101 * static_cast<double>(k), 0, k == 1 ? 0.02 : 0));
  const Tabletop table(data, places);
  Random random(seed);
  Proxy proxy;
  proxy.place = SOMEWHERE + Vec3(0, 0.3, 0.1);
  Vec3 tip = proxy.place, goal = tip;
  std::vector<bool> within(data.size(), false);
  int changes = 0, touches = 0;
  for (int n = 0; n < steps; ++n) {
    const Vec3 left = goal - tip;
    const double step = speed * 1e-3;
    if (glm::length(left) <= step) {
      const std::size_t v =
          std::min(data.size() - 1, static_cast<std::size_t>(random.uniform(0, static_cast<double>(data.size()))));
      goal = places[v] + around(random.uniform(0, 60e-3), random.uniform(-20e-3, 1.4 * data[v].height), random.uniform(-PI, PI));
    } else {
      tip += step / glm::length(left) * left;
    }
    const Vec3 before = proxy.place;
    proxy = carry_proxy(table.obstacles, proxy, tip, radius, friction);
    ASSERT_GE(table.separation(proxy.place, radius), -OUTSIDE) << n;
    touches += proxy.vessel >= 0;
    for (std::size_t v = 0; v < data.size(); ++v) {
      if (data[v].surface != Surface::shell) continue;
      const bool is_now = is_within(table.vessels[v], proxy.place - places[v]);
      if (is_now == within[v]) continue;
      ++changes;
      within[v] = is_now;
      const double higher = std::max(before.y, proxy.place.y) - places[v].y, moved = glm::length(before - proxy.place);
      ASSERT_GT(higher, data[v].height - moved - 1e-3) << "crossed " << data[v].name << " at " << n << ", moved " << moved;
    }
  }
  EXPECT_GT(touches, steps / 20);
  if (data[0].surface == Surface::shell && radius == 0 && speed >= 1) {
    EXPECT_GT(changes, 0);
  }
}

TEST(Proxy, IsNeverInsideOnLongWalks) {
  const std::vector<VesselData> solid{beaker1(), beaker2(), beaker3()};
  const std::vector<VesselData> shell{shell_of(beaker1()), shell_of(beaker3()), shell_of(beaker2())};
  std::uint64_t seed = 1;
  for (const double radius : {0.0, FINGERTIP}) {
    for (const double speed : {0.1, 1.0, 5.0}) {
      for (const double friction : {0.0, 0.6}) {
        SCOPED_TRACE("radius " + std::to_string(radius) + " speed " + std::to_string(speed) + " mu " + std::to_string(friction));
        walk(solid, radius, speed, friction, seed++, 10000);
        walk(shell, radius, speed, friction, seed++, speed == 1.0 ? 100000 : 20000);
      }
    }
  }
}

// ---- how it feels ----

// The largest step of the coupling's force between two ticks along a way of straight pieces at 50 mm/s and 1 kHz.
double largest_force_step(const Tabletop& table, double radius, double friction, const std::vector<Vec3>& way, double& strongest) {
  Proxy proxy;
  proxy.place = way.front();
  Vec3 tip = way.front(), force(0);
  double largest = 0;
  strongest = 0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const int steps = static_cast<int>(std::ceil(glm::length(way[k] - way[k - 1]) / 0.05e-3));
    for (int n = 1; n <= steps; ++n) {
      const Vec3 next = glm::mix(way[k - 1], way[k], static_cast<double>(n) / steps);
      proxy = carry_proxy(table.obstacles, proxy, next, radius, friction);
      Vec3 felt(0);
      if (proxy.vessel >= 0)
        felt = core_f64::coupling_force(next, proxy.place, proxy.normal, (next - tip) / 1e-3, STIFFNESS, DAMPING);
      largest = std::max(largest, glm::length(felt - force));
      strongest = std::max(strongest, glm::length(felt));
      force = felt;
      tip = next;
    }
  }
  return largest;
}

// Over a rim, through a crease, into and out of a vessel, pressed in by 2 mm: a step of 50 um is 40 mN, entering brings B v_n = 50 mN more,
// and round an edge the direction turns by the step over what is left of the radius.
TEST(Proxy, FeelsSmoothOverEdgesAndThroughCreases) {
  struct Way {
    std::string name;
    VesselData vessel;
    double radius;
    std::vector<Vec3> points;  // vessel frame; (r, y) in the half plane z = 0
  };
  const auto at = [](double r_mm, double y_mm, double z_mm = 0) { return Vec3(r_mm * 1e-3, y_mm * 1e-3, z_mm * 1e-3); };
  std::vector<Way> ways;
  for (const double radius : {0.0, 8.0}) {
    const double r = radius, d = 2, m = radius * 1e-3;
    // a bare point that is pressed in leaves by the other side of an edge at once, with all its force: only what has a radius rounds it
    if (radius > 0) {
      ways.push_back({"over the lid and its rim",
                      beaker1(),
                      m,
                      {at(20, 115 + r), at(20, 110 + r - d), at(41 + r, 110 + r - d), at(41 + r, 90)}});
      ways.push_back({"up the side and over the rim", beaker1(), m, {at(45 + r, 90), at(40 + r - d, 90), at(40 + r - d, 125 + r)}});
      ways.push_back(
          {"aslant round the rim",
           beaker1(),
           m,
           {at(45 + r, 90), at(40 + r - d, 90), at(40 + r - d, 112, 5), at(40, 110 + r - d, 8), at(20, 110 + r - d, 10)}});
      ways.push_back(
          {"over the rim of a shell", shell_of(beaker1()), m, {at(60, 112 + r), at(60, 110 + r - d), at(20, 110 + r - d)}});
    }
    if (radius > 0)
      ways.push_back({"out of a shell", shell_of(beaker1()), m, {at(10, 80), at(38.5 - r + d, 80), at(38.5 - r + d, 125 + r)}});
    ways.push_back({"the inner floor's edge",
                    shell_of(beaker1()),
                    m,
                    {at(5, 20 + r), at(5, 1.5 + r - d), at(38.5 - r + d, 1.5 + r - d), at(38.5 - r + d, 40)}});
    ways.push_back({"round the inner floor's edge",
                    shell_of(beaker1()),
                    m,
                    {at(5, 20 + r), at(38.5 - r + 0.5 * d, 1.5 + r - d), at(0.8 * (38.5 - r), 1.5 + r - d, 0.62 * (38.5 - r))}});
    ways.push_back(
        {"the cone's shoulder", beaker3(), m, {at(50 + r, 60), at(28.4 + r - d, 60), at(17 + r - d, 105), at(17 + r - d, 140)}});
    ways.push_back({"round the cone's shoulder",
                    beaker3(),
                    m,
                    {at(40 + r, 106.5 + r / 8), at(15.5 + r, 106 + r / 8), at(0.7 * (15.5 + r), 106 + r / 8, 0.7 * (15.5 + r))}});
    ways.push_back(
        {"down the flask's neck", beaker2(), m, {at(30 + r, 120), at(17 + r - d, 120), at(17 + r - d, 84), at(35 + r, 60)}});
    ways.push_back(
        {"through the flask's crease", beaker2(), m, {at(30 + r, 120), at(15.5 + r, 95 + r), at(17 + r, 78), at(38 + r, 70)}});
  }
  for (const Way& way : ways) {
    for (const double friction : {0.0, 0.6}) {
      const Tabletop table({way.vessel}, {SOMEWHERE});
      std::vector<Vec3> points;
      for (const Vec3& p : way.points) points.push_back(SOMEWHERE + p);
      double strongest = 0;
      const double step = largest_force_step(table, way.radius, friction, points, strongest);
      EXPECT_LT(step, 0.1) << way.name << " radius " << way.radius << " mu " << friction << " strongest " << strongest;
      EXPECT_GT(strongest, 1) << way.name << " radius " << way.radius;
    }
  }
}

}  // namespace
}  // namespace wholehand

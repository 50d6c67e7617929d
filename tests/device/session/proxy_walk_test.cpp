// SPDX-License-Identifier: MIT
// Proxies of the tracked tips at walls and on long walks among vessels, which are never crossed, and how smooth they feel.
// sanitizers: none
#include "device/session/proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/held.h"
#include "tests/support/scenes.h"
#include "tests/support/tabletop.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

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
    const Tabletop table({data}, {TABLETOP_PLACE});
    Random random(5);
    for (const double rate : {1000.0, 2000.0, 3000.0, 8000.0}) {
      for (const double radius : {0.0, FINGERTIP}) {
        for (const double friction : {0.0, 0.6}) {
          for (int k = 0; k < 10; ++k) {
            // through the wall at 1 m/s: in the direction of a radius, or aslant, in from outside and out from inside
            const double y = random.uniform(20e-3, 60e-3), a = random.uniform(-PI, PI),
                         aside = k % 2 ? random.uniform(-0.8, 0.8) : 0;
            const Vec3 out = around_axis(1, 0, a), along = glm::normalize(out + aside * around_axis(1, 0.3, a + PI / 2));
            const bool is_from_inside = k % 4 >= 2;
            const Vec3 begin = TABLETOP_PLACE + (is_from_inside ? Vec3(0, y, 0) : Vec3(0, y, 0) + 70e-3 * along);
            const Vec3 way = (is_from_inside ? 1.0 : -1.0) * along / rate;
            if (table.separation(begin, radius) < 0) continue;  // a neck too narrow for the finger
            Proxy proxy;
            proxy.place = begin;
            Vec3 tip = begin;
            const auto steps = static_cast<int>(0.13 * rate);
            for (int n = 0; n < steps; ++n) {
              tip += way;
              proxy = carry_proxy(table.obstacles, proxy, tip, radius, friction);
              ASSERT_GE(table.separation(proxy.place, radius), -PROXY_OUTSIDE);
              // once the tip is out on the other side there may be a way round; up to the far wall there is none
              if (is_within(table.vessels[0], proxy.place - TABLETOP_PLACE) != is_from_inside) {
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

// Long walks of a tip that goes anywhere, through walls as well: its proxy is never inside of anything, and goes into a vessel or
// out of it by its mouth alone. A proxy moves no more than PROXY_MOVES steps a tick, and one that changes sides was or is near the
// mouth.
void walk(const std::vector<VesselData>& data, double radius, double speed, double friction, std::uint64_t seed, int steps) {
  std::vector<Vec3> places;
  for (std::size_t k = 0; k < data.size(); ++k)
    places.push_back(TABLETOP_PLACE + Vec3(0.101 * static_cast<double>(k), 0, k == 1 ? 0.02 : 0));
  const Tabletop table(data, places);
  Random random(seed);
  Proxy proxy;
  proxy.place = TABLETOP_PLACE + Vec3(0, 0.3, 0.1);
  Vec3 tip = proxy.place, goal = tip;
  std::vector<bool> within(data.size(), false);
  int changes = 0, touches = 0;
  for (int n = 0; n < steps; ++n) {
    const Vec3 left = goal - tip;
    const double step = speed * 1e-3;
    if (glm::length(left) <= step) {
      const std::size_t v =
          std::min(data.size() - 1, static_cast<std::size_t>(random.uniform(0, static_cast<double>(data.size()))));
      goal =
          places[v] + around_axis(random.uniform(0, 60e-3), random.uniform(-20e-3, 1.4 * data[v].height), random.uniform(-PI, PI));
    } else {
      tip += step / glm::length(left) * left;
    }
    const Vec3 before = proxy.place;
    proxy = carry_proxy(table.obstacles, proxy, tip, radius, friction);
    ASSERT_GE(table.separation(proxy.place, radius), -PROXY_OUTSIDE) << n;
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
        felt = core_f64::coupling_force(next, proxy.place, proxy.normal, (next - tip) / 1e-3, TABLETOP_STIFFNESS, TABLETOP_DAMPING);
      largest = std::max(largest, glm::length(felt - force));
      strongest = std::max(strongest, glm::length(felt));
      force = felt;
      tip = next;
    }
  }
  return largest;
}

// Over a rim, through a crease, into and out of a vessel, pressed in by 2 mm: a step of 50 um is 40 mN, entering brings B v_n = 50
// mN more, and round an edge the direction turns by the step over what is left of the radius.
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
    // a bare point that is pressed in leaves by the other side of an edge at once, with all its force: only what has a radius
    // rounds it
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
      const Tabletop table({way.vessel}, {TABLETOP_PLACE});
      std::vector<Vec3> points;
      for (const Vec3& p : way.points) points.push_back(TABLETOP_PLACE + p);
      double strongest = 0;
      const double step = largest_force_step(table, way.radius, friction, points, strongest);
      EXPECT_LT(step, 0.1) << way.name << " radius " << way.radius << " mu " << friction << " strongest " << strongest;
      EXPECT_GT(strongest, 1) << way.name << " radius " << way.radius;
    }
  }
}

}  // namespace
}  // namespace wholehand::device

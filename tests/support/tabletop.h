// SPDX-License-Identifier: MIT
// Vessels on a table that tips touch, and proxies that are carried along with them.
#pragma once

#include <cmath>
#include <vector>

#include "device/session/proxy.h"
#include "tests/support/scenes.h"

namespace wholehand {

constexpr double PROXY_OUTSIDE = 1e-8;      // m: a proxy is no deeper inside than this; what carry_proxy itself calls outside
constexpr double TABLETOP_STIFFNESS = 800;  // N/m, the defaults of [live]
constexpr double TABLETOP_DAMPING = 1;      // N s/m
constexpr double TABLETOP_WALL = 1.5e-3;    // m, of every beaker
constexpr double FINGERTIP = 8e-3;          // m
constexpr double PROXY_SKIN = 1e-6;         // m: that carry_proxy gives a bare point

// Vessels that stand somewhere, off the origin, so that a forgotten offset shows.
struct Tabletop {
  std::vector<core_f64::Vessel> vessels;
  device::Obstacles obstacles;

  Tabletop(const std::vector<VesselData>& data, const std::vector<core_f64::Vec3>& places) {
    vessels.reserve(data.size());
    for (std::size_t k = 0; k < data.size(); ++k) {
      vessels.push_back(ready_vessel(data[k]));
      obstacles.standing[k] = {&vessels[k], places[k], true};
    }
    obstacles.count = static_cast<int>(data.size());
    obstacles.thinnest = TABLETOP_WALL;
  }
  double separation(core_f64::Vec3 p, double radius) const { return device::nearest_vessel(obstacles, p, radius).separation; }
};

inline const core_f64::Vec3 TABLETOP_PLACE(0.13, 0.02, -0.07);

inline core_f64::Vec3 around_axis(double r, double y, double azimuth) {
  return core_f64::Vec3(r * std::cos(azimuth), y, -r * std::sin(azimuth));
}

// Carries a proxy along a straight way in steps, from where it is free.
inline device::Proxy carry_along(const device::Obstacles& obstacles, core_f64::Vec3 from, core_f64::Vec3 to, int steps,
                                 double radius, double friction) {
  device::Proxy proxy;
  proxy.place = from;
  for (int k = 1; k <= steps; ++k) {
    proxy = device::carry_proxy(obstacles, proxy, glm::mix(from, to, static_cast<double>(k) / steps), radius, friction);
  }
  return proxy;
}

}  // namespace wholehand

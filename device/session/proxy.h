// SPDX-License-Identifier: MIT
// Tracked tips before the grasp: each has a proxy that stays outside of every vessel and moves step by step (Ruspini et al. 1997), so that it crosses
// no wall between two steps, however thin.
#pragma once

#include <array>

#include "core/contact.h"
#include "device/session/tick.h"

namespace wholehand::device {

// The obstacles: vessels upright at their places.
struct Obstacles {
  struct Standing {
    const core_f64::Vessel* vessel = nullptr;
    core_f64::Vec3 place{};
    bool is_solid = false;  // false: it is not felt, for instance a vessel in the hand
  };
  std::array<Standing, LIVE_VESSELS> standing{};
  int count = 0;
  double thinnest = 0.05e-3;  // m: no wall is thinner; bare points may slide this far at once
};

// The nearest solid vessel to a point of that radius: its number (-1: none), and the separation, m.
struct NearestVessel {
  int vessel = -1;
  double separation = core_f64::NO_DISTANCE;
};
NearestVessel nearest_vessel(const Obstacles& obstacles, core_f64::Vec3 point, double radius) noexcept;
// Separation of a point of that radius from one vessel, m.
double vessel_separation(const Obstacles::Standing& standing, core_f64::Vec3 point, double radius) noexcept;

// One tip's proxy.
struct Proxy {
  core_f64::Vec3 place{};
  core_f64::Vec3 normal{};  // outward, of the nearest vessel at the proxy; only if it touches
  int vessel = -1;          // which it touches; -1: none
  int element = -1;         // of that vessel's outline
};

// Moves the proxy for a tip that is now at `tip`, m, and was at `before`. It goes towards the tip, along the surfaces that it meets, in steps that
// cannot pass one, and is moved out along the normal after each, until it is as near as possible. With friction, it stays in place on a surface while
// the tip pulls it sideways by less than `friction` times the depth, and otherwise lags behind by that much. It never ends inside; if PROXY_MOVES
// steps do not suffice, it continues in the next tick. A bare point counts as one of a micrometer. Degenerate: in an edge where two surfaces meet, it
// is moved out of one after the other; if that does not converge it stays.
Proxy carry_proxy(const Obstacles& obstacles, const Proxy& before, core_f64::Vec3 tip, double radius, double friction) noexcept;
constexpr int PROXY_MOVES = 48;

}  // namespace wholehand::device

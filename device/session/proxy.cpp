// SPDX-License-Identifier: MIT
#include "device/session/proxy.h"

#include <algorithm>
#include <cmath>

namespace wholehand::device {

using core_f64::Vec3;

namespace {

constexpr double FEASIBLE = 1e-8;     // m: a proxy no deeper than this is outside: ten times where iterations on one vessel stop
constexpr double NEAR = 1e-9;         // m: shorter moves, and moves that gain less, do not count
constexpr double TOUCHING = 1e-8;     // m: a proxy nearer to a surface than this slides along it
constexpr double LEAST_MOVE = 1e-7;   // m: shorter ones are not tried if a longer one gained nothing; 0.1 mN
constexpr double LEAST_STEP = 20e-6;  // m: of bare points, less than half of the thinnest wall that a scene may have
constexpr double SKIN = 1e-6;         // m: of a bare point; on the surface itself an edge has a normal by rounding alone. 0.8 mN
constexpr int WAYS_OUT = 12;          // for one vessel and then the other, in an edge between two

// Moves it out of every vessel along the normals. False if that fails.
bool move_out(const Obstacles& obstacles, Vec3& point, double radius) noexcept {
  for (int way = 0; way < WAYS_OUT; ++way) {
    const NearestVessel nearest = nearest_vessel(obstacles, point, radius);
    if (nearest.vessel < 0 || nearest.separation >= -FEASIBLE) return true;
    const auto& standing = obstacles.standing[nearest.vessel];
    bool settled = false;
    const Vec3 out = core_f64::proxy_of(*standing.vessel, point - standing.place, radius, settled);
    if (!settled) return false;
    point = out + standing.place;
  }
  return nearest_vessel(obstacles, point, radius).separation >= -FEASIBLE;
}

// The nearest surface to a place.
struct Surroundings {
  int vessel = -1, element = -1;
  double separation = core_f64::NO_DISTANCE;
  Vec3 normal{};  // outward
  bool is_same(const Surroundings& other) const noexcept { return vessel == other.vessel && element == other.element; }
};

Surroundings surroundings(const Obstacles& obstacles, Vec3 point, double radius) noexcept {
  Surroundings here;
  const NearestVessel nearest = nearest_vessel(obstacles, point, radius);
  here.vessel = nearest.vessel;
  here.separation = nearest.separation;
  if (nearest.vessel >= 0) {
    const auto& standing = obstacles.standing[nearest.vessel];
    here.normal = core_f64::distance_gradient(*standing.vessel, point - standing.place, here.element);
  }
  return here;
}

// A direction from a place, and how far it leads nearer to the goal, m.
struct Heading {
  Vec3 way{};  // unit
  double length = 0;
  bool along = false;  // a surface, or the crease of two
};

// The part of the way that at most two surfaces leave free: all of it, along one of them, or along the crease in which they meet.
Vec3 slide_along(Vec3 way, const std::array<Vec3, 2>& normals, int count) noexcept {
  bool held = false;
  for (int k = 0; k < count; ++k) held = held || glm::dot(way, normals[k]) < 0;
  if (!held) return way;
  for (int k = 0; k < count; ++k) {
    const double sinks = glm::dot(way, normals[k]);
    const Vec3 slide = way - sinks * normals[k];
    if (sinks < 0 && (count == 1 || glm::dot(slide, normals[1 - k]) >= 0)) return slide;
  }
  const Vec3 crease = glm::cross(normals[0], normals[1]);
  const double length_squared = glm::dot(crease, crease);
  return length_squared > 0 ? glm::dot(way, crease) / length_squared * crease : Vec3(0);
}

// Friction stops a slide of less than `friction` times the depth, and subtracts that much from a longer one.
Heading heading_along(Vec3 way, const std::array<Vec3, 2>& normals, int count, double friction) noexcept {
  const Vec3 slide = slide_along(way, normals, count);
  const double length = glm::length(slide);
  const bool along = slide != way;
  const double depth = std::sqrt(std::max(0.0, glm::dot(way, way) - length * length));
  return {length > 0 ? slide / length : slide, along ? std::max(0.0, length - friction * depth) : length, along};
}

// A proxy in motion: its place, the surface that it met besides the nearest one, and the longest move that may still gain something.
struct Walk {
  const Obstacles& obstacles;
  Vec3 at, goal;
  double radius, friction;
  bool has_met = false;
  Surroundings met{};
  double most = core_f64::NO_DISTANCE;

  // False: it is as near as it gets.
  bool move() noexcept;

  Heading heading(const Surroundings& here, double clear) const noexcept;
  bool try_less(double step) noexcept;
  bool meets(const Surroundings& here, const Heading& heading, double step, const Surroundings& there) noexcept;
};

Heading Walk::heading(const Surroundings& here, double clear) const noexcept {
  const Vec3 way = goal - at;
  std::array<Vec3, 2> normals{};
  int count = 0;
  if (here.vessel >= 0 && clear <= TOUCHING) normals[count++] = here.normal;
  if (has_met) normals[count++] = met.normal;
  Heading heading = heading_along(way, normals, count, friction);
  // through the air to the tangent plane and no further, because overshooting may pass a crease
  const double sinks = glm::dot(way, here.normal);
  if (!heading.along && sinks < 0) heading.length = std::min(heading.length, std::max(clear, clear * heading.length / -sinks));
  return heading;
}

bool Walk::try_less(double step) noexcept {
  most = 0.5 * step;
  return most > LEAST_MOVE;
}

// Whether a move whose end `there` is inside ran into another surface; the proxy must then go up to it, and also slide along it from there.
bool Walk::meets(const Surroundings& here, const Heading& heading, double step, const Surroundings& there) noexcept {
  if (there.vessel < 0 || there.is_same(here) || (has_met && there.is_same(met))) return false;
  const double closing = -glm::dot(heading.way, there.normal);
  if (closing <= 0) return false;
  const double until = step + std::min(0.0, there.separation) / closing;
  if (until > LEAST_MOVE) {
    if (until < 0.9 * step) most = until;
    return until < 0.9 * step;
  }
  if (has_met) return false;
  has_met = true;
  met = there;
  most = core_f64::NO_DISTANCE;
  return true;
}

bool Walk::move() noexcept {
  const double left = glm::length(goal - at);
  if (left < NEAR) return false;
  const Surroundings here = surroundings(obstacles, at, radius);
  const double clear = std::max(0.0, here.separation);
  const Heading ahead = heading(here, clear);
  // the center stays outside the surface if it moves less than its distance to it; half the radius leaves room for the way back out. A sliding proxy
  // passes a surface only at a flat angle, so a move shorter than a wall's thickness crosses none.
  const double sure = clear + 0.5 * radius + LEAST_STEP;
  const double step = std::min({ahead.length, most, ahead.along ? std::max(sure, obstacles.thinnest - 3 * LEAST_STEP) : sure});
  if (step < NEAR) return false;
  Vec3 next = at + step * ahead.way;
  const Surroundings there = surroundings(obstacles, next, radius);
  if (step > sure && there.separation < -(0.5 * radius + LEAST_STEP)) {
    // too far, unless another surface is right there
    const Surroundings near_by = surroundings(obstacles, at + sure * ahead.way, radius);
    return (near_by.separation < -FEASIBLE && meets(here, ahead, sure, near_by)) || try_less(step);
  }
  if (there.separation < -FEASIBLE) {
    if (meets(here, ahead, step, there)) return true;
    if (!move_out(obstacles, next, radius)) return try_less(step);
    if (there.is_same(here)) {
      // what is met less deeply than what it slides along
      Surroundings landing = surroundings(obstacles, next, radius);
      landing.separation = glm::dot(at + step * ahead.way - next, landing.normal);
      if (meets(here, ahead, step, landing)) return true;
    }
  }
  if (left - glm::length(goal - next) < NEAR) return try_less(step);
  at = next;
  has_met = false;
  most = core_f64::NO_DISTANCE;
  return true;
}

}  // namespace

double vessel_separation(const Obstacles::Standing& standing, Vec3 point, double radius) noexcept {
  return core_f64::separation_at(*standing.vessel, point - standing.place, radius);
}

NearestVessel nearest_vessel(const Obstacles& obstacles, Vec3 point, double radius) noexcept {
  NearestVessel nearest;
  for (int v = 0; v < obstacles.count; ++v) {
    const auto& standing = obstacles.standing[v];
    if (!standing.is_solid) continue;
    // for a distant vessel its bounding sphere is enough
    const Vec3 center = standing.place + Vec3(0, standing.vessel->bound_height, 0);
    const double bound = glm::length(point - center) - standing.vessel->bound_radius - radius;
    if (bound > nearest.separation) continue;
    const double separation = vessel_separation(standing, point, radius);
    if (separation < nearest.separation) nearest = {v, separation};
  }
  return nearest;
}

Proxy carry_proxy(const Obstacles& obstacles, const Proxy& before, Vec3 tip, double given_radius, double friction) noexcept {
  const double radius = std::max(given_radius, SKIN);
  Walk walk{obstacles, before.place, tip, radius, friction, false, {}, core_f64::NO_DISTANCE};
  for (int move = 0; move < PROXY_MOVES && walk.move(); ++move) {
  }
  Proxy proxy;
  proxy.place = walk.at;
  const Surroundings here = surroundings(obstacles, proxy.place, radius);
  // a proxy still on its way through the air touches nothing
  if (glm::length(tip - proxy.place) > NEAR && here.separation <= LEAST_STEP) {
    proxy.vessel = here.vessel;
    // in a crease the nearest surface may be the one that the tip has left
    const Vec3 out = proxy.place - tip;
    proxy.normal = glm::dot(here.normal, out) > 0 ? here.normal : out / glm::length(out);
    proxy.element = here.element;
  }
  return proxy;
}

}  // namespace wholehand::device

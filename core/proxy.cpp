#include "core/proxy.h"

#include <algorithm>
#include <cmath>

namespace wholehand {

using core_f64::Vec3;

namespace {

constexpr double FEASIBLE = 1e-8;     // m: a proxy this far inside is outside: ten times what iterations on one vessel stop at
constexpr double NEAR = 1e-9;         // m: shorter moves end the search
constexpr double LEAST_STEP = 20e-6;  // m: of bare points, less than half of the thinnest wall that a scene may have
constexpr int WAYS_OUT = 12;          // of one vessel and then the other, in an edge between two

// Out of every vessel along the normals. False where it does not get out.
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

// As near to `goal` as it gets from `from` without passing a surface.
Vec3 approach(const Obstacles& obstacles, Vec3 from, Vec3 goal, double radius) noexcept {
  Vec3 at = from;
  for (int move = 0; move < PROXY_MOVES; ++move) {
    const Vec3 way = goal - at;
    const double left = glm::length(way);
    if (left < NEAR) break;
    // the centre stays outside of the surface itself if it goes less than its distance; half the radius leaves room for the way back out
    const double clear = std::max(0.0, nearest_vessel(obstacles, at, radius).separation);
    const double step = std::min(left, clear + 0.5 * radius + LEAST_STEP);
    Vec3 next = at + (step / left) * way;
    if (!move_out(obstacles, next, radius)) break;
    const double gained = left - glm::length(goal - next);
    if (gained < NEAR) break;  // as near as it gets
    at = next;
  }
  return at;
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
    // its bounding sphere tells enough of one that is far off
    const Vec3 center = standing.place + Vec3(0, standing.vessel->bound_height, 0);
    const double bound = glm::length(point - center) - standing.vessel->bound_radius - radius;
    if (bound > nearest.separation) continue;
    const double separation = vessel_separation(standing, point, radius);
    if (separation < nearest.separation) nearest = {v, separation};
  }
  return nearest;
}

Proxy carry_proxy(const Obstacles& obstacles, const Proxy& before, Vec3 tip, double radius, double friction) noexcept {
  Proxy proxy;
  proxy.place = approach(obstacles, before.place, tip, radius);
  const double depth = glm::length(tip - proxy.place);
  if (before.vessel >= 0 && depth > NEAR) {
    // friction: behind the place without it by at most so much
    const Vec3 slide = proxy.place - before.place;
    const double way = glm::length(slide), lag = friction * depth;
    if (way > NEAR) {
      const Vec3 wanted = way <= lag ? before.place : proxy.place - (lag / way) * slide;
      Vec3 dragged = wanted;
      if (move_out(obstacles, dragged, radius)) proxy.place = dragged;
    }
  }
  const NearestVessel nearest = nearest_vessel(obstacles, proxy.place, radius);
  if (nearest.vessel >= 0 && glm::length(tip - proxy.place) > NEAR) {
    const auto& standing = obstacles.standing[nearest.vessel];
    proxy.vessel = nearest.vessel;
    proxy.normal = core_f64::distance_gradient(*standing.vessel, proxy.place - standing.place, proxy.element);
  }
  return proxy;
}

}  // namespace wholehand

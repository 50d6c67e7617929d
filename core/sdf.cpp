// SPDX-License-Identifier: MIT
#include "core/sdf.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/lattice.h"

namespace CORE_NS {

// A line: distance to the clamped foot of the perpendicular, the ends taken as they stand so that neighbors share them to the bit.
// An arc: |q - center| - radius inside its sector, which for a y-monotone arc is "on its half, and the foot between the ends'
// heights"; else the nearer end. Degenerate: q at the center lies at `radius` from the whole arc.
Real element_distance_squared(const Element& element, Vec2 q) {
  const Vec2 from_a = q - element.a;
  const Vec2 from_b = q - element.b;
  if (element.side == 0) {
    const Vec2 along = element.b - element.a;
    const Real t = glm::dot(from_a, along);
    const Real length_squared = glm::dot(along, along);
    if (t <= 0) return glm::dot(from_a, from_a);
    if (t >= length_squared) return glm::dot(from_b, from_b);
    const Real across = glm::dot(element.center, from_a);
    return across * across;
  }
  const Vec2 from_center = q - element.center;
  const Real distance = std::sqrt(glm::dot(from_center, from_center));
  const Real low = std::min(element.a.y, element.b.y) - element.center.y;
  const Real high = std::max(element.a.y, element.b.y) - element.center.y;
  // the foot's height is from_center.y * radius / distance; compared without the division
  const Real foot = from_center.y * element.radius;
  const bool on_half = Real(element.side) * from_center.x >= 0;
  if (on_half && foot >= low * distance && foot <= high * distance) {
    const Real off = distance - element.radius;
    return off * off;
  }
  return std::min(glm::dot(from_a, from_a), glm::dot(from_b, from_b));
}

// The sign of a cross product says on which side of a line q lies; for an arc, being left of its right half is being left of the
// center or inside the circle, and being left of its left half is being left of the center and outside it.
bool element_crosses(const Element& element, Vec2 q) {
  const bool up = element.b.y > element.a.y;
  const Real low = up ? element.a.y : element.b.y;
  const Real high = up ? element.b.y : element.a.y;
  if (q.y < low || q.y >= high) return false;
  if (element.side == 0) {
    const Vec2 along = element.b - element.a;
    const Vec2 from_a = q - element.a;
    const Real across = along.x * from_a.y - along.y * from_a.x;
    return up ? across > 0 : across < 0;
  }
  const Vec2 from_center = q - element.center;
  const bool within = glm::dot(from_center, from_center) < element.radius * element.radius;
  return element.side > 0 ? from_center.x < 0 || within : from_center.x < 0 && !within;
}

bool element_spans(const Element& element, Vec2 q) {
  if (element.side == 0) {
    const Vec2 along = element.b - element.a;
    const Real t = glm::dot(q - element.a, along);
    return t > 0 && t < glm::dot(along, along);
  }
  const Vec2 from_center = q - element.center;
  const Real distance = std::sqrt(glm::dot(from_center, from_center));
  const Real low = std::min(element.a.y, element.b.y) - element.center.y;
  const Real high = std::max(element.a.y, element.b.y) - element.center.y;
  const Real foot = from_center.y * element.radius;
  return Real(element.side) * from_center.x >= 0 && foot >= low * distance && foot <= high * distance;
}

// Inside an element's span the gradient is its own outward normal whatever the side, which stays exact on the surface where
// (q - nearest) / distance would be rounding noise. Beyond an end it points away from (inside: towards) that end.
// Degenerate: q on the end itself takes the element's normal there; q at an arc's center takes the half's own direction.
Vec2 outward_of(const Element& element, Vec2 q, bool& at_end) {
  const Vec2 from_a = q - element.a;
  const Vec2 from_b = q - element.b;
  const Real to_a = glm::dot(from_a, from_a);
  const Real to_b = glm::dot(from_b, from_b);
  const Vec2 from_end = to_a <= to_b ? from_a : from_b;
  at_end = !element_spans(element, q) && std::min(to_a, to_b) != 0;
  if (element.side == 0) return at_end ? from_end : element.center;
  const bool up = element.b.y > element.a.y;
  const Real bulge = (element.side > 0) == up ? Real(1) : Real(-1);  // convex arcs point away from their center
  const Vec2 from_center = q - element.center;
  const bool central = from_center.x == 0 && from_center.y == 0;
  const Vec2 own = central ? Vec2(bulge * Real(element.side), 0) : bulge * from_center;
  return at_end ? from_end : own;
}

bool element_convex(const Element& element, Vec2 q) {
  const bool up = element.b.y > element.a.y;
  return element.side == 0 || ((element.side > 0) == up && element_spans(element, q));
}

bool element_supports(const Element& element, Vec2 q) {
  const Vec2 from_a = q - element.a;
  const Vec2 from_b = q - element.b;
  const int end = glm::dot(from_a, from_a) <= glm::dot(from_b, from_b) ? SUPPORTS_AT_A : SUPPORTS_AT_B;
  return (element.supports & (element_spans(element, q) ? SUPPORTS_BETWEEN : end)) != 0;
}

Nearest nearest_element(const Vessel& vessel, Vec2 q, bool& inside) {
  Nearest nearest;
  int side = 0;
  inside = false;
  const int count = static_cast<int>(vessel.outline.size());
  for (int i = 0; i < count; ++i) {
    const Real distance_squared = element_distance_squared(vessel.outline[i], q);
    const bool nearer = distance_squared < nearest.distance_squared;
    // an element that follows the nearest and is equally near at the shared end: the nearest stands for both
    const Vec2 from_a = q - vessel.outline[i].a;
    const bool shared =
        distance_squared == nearest.distance_squared && i == nearest.element + 1 && glm::dot(from_a, from_a) == distance_squared;
    const Real behind = nearer ? nearest.distance_squared : shared ? NO_DISTANCE : distance_squared;
    nearest.other_squared = std::min(nearest.other_squared, behind);
    nearest.curved_tie = nearer ? false : nearest.curved_tie || (shared && (side != 0 || vessel.outline[i].side != 0));
    if (nearer) {
      nearest.distance_squared = distance_squared;
      nearest.element = i;
      side = vessel.outline[i].side;
    }
    if (element_crosses(vessel.outline[i], q)) inside = !inside;
  }
  return nearest;
}

Real profile_distance(const Vessel& vessel, Vec2 q) {
  bool inside = false;
  const Nearest nearest = nearest_element(vessel, q, inside);
  const Real distance = std::sqrt(nearest.distance_squared);
  return inside ? -distance : distance;
}

Vec2 profile_gradient(const Vessel& vessel, Vec2 q, int& element) {
  bool inside = false;
  const Nearest nearest = nearest_element(vessel, q, inside);
  element = nearest.element;
  const Vec2 outward = element_outward(vessel.outline[nearest.element], q, inside ? Real(-1) : Real(1));
  return outward * (Real(1) / std::sqrt(glm::dot(outward, outward)));
}

Cell locate_cell(const Lattice& lattice, Vec3 p) {
  const Vec3 counts(Real(lattice.nx - 1), Real(lattice.ny - 1), Real(lattice.nz - 1));
  const Vec3 clamped = glm::min(glm::max(p, lattice.origin), lattice.origin + counts * lattice.spacing);
  const Vec3 steps = glm::min(glm::max((clamped - lattice.origin) / lattice.spacing, Vec3(0)), counts);
  Cell cell;
  cell.i = std::min(static_cast<int>(steps.x), lattice.nx - 2);
  cell.j = std::min(static_cast<int>(steps.y), lattice.ny - 2);
  cell.k = std::min(static_cast<int>(steps.z), lattice.nz - 2);
  cell.fraction = steps - Vec3(Real(cell.i), Real(cell.j), Real(cell.k));
  cell.outside = p - clamped;
  return cell;
}

Real lattice_sample(const Lattice& lattice, int i, int j, int k) {
  const std::size_t at = (static_cast<std::size_t>(k) * lattice.ny + j) * lattice.nx + i;
  if (!lattice.halves) return Real(std::bit_cast<float>((*lattice.words)[at]));
  return Real(wholehand::half_value(wholehand::half_at(*lattice.words, at))) * Real(HALF_UNIT);
}

Real mix_reals(Real a, Real b, Real t) { return a + (b - a) * t; }

// A surface inside the box lies beyond the plane through the box's nearest point c, perpendicular to the way there: its distance from p is at least
// the hypotenuse over that way and its distance from c.
Real distance_beyond(Real value, Vec3 outside) {
  const Real squared = glm::dot(outside, outside), held = std::max(value, Real(0));
  return squared > 0 ? std::sqrt(held * held + squared) : value;
}

Real lattice_distance(const Lattice& lattice, Vec3 p) {
  const Cell cell = locate_cell(lattice, p);
  const Vec3 f = cell.fraction;
  const Real c00 =
      mix_reals(lattice_sample(lattice, cell.i, cell.j, cell.k), lattice_sample(lattice, cell.i + 1, cell.j, cell.k), f.x);
  const Real c10 =
      mix_reals(lattice_sample(lattice, cell.i, cell.j + 1, cell.k), lattice_sample(lattice, cell.i + 1, cell.j + 1, cell.k), f.x);
  const Real c01 =
      mix_reals(lattice_sample(lattice, cell.i, cell.j, cell.k + 1), lattice_sample(lattice, cell.i + 1, cell.j, cell.k + 1), f.x);
  const Real c11 = mix_reals(lattice_sample(lattice, cell.i, cell.j + 1, cell.k + 1),
                             lattice_sample(lattice, cell.i + 1, cell.j + 1, cell.k + 1), f.x);
  return distance_beyond(mix_reals(mix_reals(c00, c10, f.y), mix_reals(c01, c11, f.y), f.z), cell.outside);
}

// The derivative of the trilinear value where the point is not clamped; off the box that of distance_beyond; normalized.
Vec3 lattice_gradient(const Lattice& lattice, Vec3 p) {
  const Cell cell = locate_cell(lattice, p);
  const Vec3 f = cell.fraction;
  const Real s000 = lattice_sample(lattice, cell.i, cell.j, cell.k), s100 = lattice_sample(lattice, cell.i + 1, cell.j, cell.k);
  const Real s010 = lattice_sample(lattice, cell.i, cell.j + 1, cell.k),
             s110 = lattice_sample(lattice, cell.i + 1, cell.j + 1, cell.k);
  const Real s001 = lattice_sample(lattice, cell.i, cell.j, cell.k + 1),
             s101 = lattice_sample(lattice, cell.i + 1, cell.j, cell.k + 1);
  const Real s011 = lattice_sample(lattice, cell.i, cell.j + 1, cell.k + 1),
             s111 = lattice_sample(lattice, cell.i + 1, cell.j + 1, cell.k + 1);
  Vec3 slope(mix_reals(mix_reals(s100 - s000, s110 - s010, f.y), mix_reals(s101 - s001, s111 - s011, f.y), f.z),
             mix_reals(mix_reals(s010 - s000, s110 - s100, f.x), mix_reals(s011 - s001, s111 - s101, f.x), f.z),
             mix_reals(mix_reals(s001 - s000, s101 - s100, f.x), mix_reals(s011 - s010, s111 - s110, f.x), f.y));
  slope /= lattice.spacing;
  if (cell.outside.x != 0) slope.x = 0;
  if (cell.outside.y != 0) slope.y = 0;
  if (cell.outside.z != 0) slope.z = 0;
  if (glm::dot(cell.outside, cell.outside) > 0) {
    const Real value = mix_reals(mix_reals(mix_reals(s000, s100, f.x), mix_reals(s010, s110, f.x), f.y),
                                 mix_reals(mix_reals(s001, s101, f.x), mix_reals(s011, s111, f.x), f.y), f.z);
    slope = std::max(value, Real(0)) * slope + cell.outside;
  }
  const Real size = glm::length(slope);
  return size > 0 ? slope / size : Vec3(1, 0, 0);
}

Real signed_distance(const Vessel& vessel, Vec3 p) {
  if (vessel.is_lattice) return lattice_distance(vessel.lattice, p);
  return profile_distance(vessel, Vec2(std::sqrt(p.x * p.x + p.z * p.z), p.y));
}

Vec3 distance_gradient(const Vessel& vessel, Vec3 p, int& element) {
  if (vessel.is_lattice) {
    element = -1;
    return lattice_gradient(vessel.lattice, p);
  }
  const Real r = std::sqrt(p.x * p.x + p.z * p.z);
  const Vec2 gradient = profile_gradient(vessel, Vec2(r, p.y), element);
  const Vec2 radial = r > 0 ? Vec2(p.x, p.z) * (Real(1) / r) : Vec2(1, 0);
  return Vec3(gradient.x * radial.x, gradient.y, gradient.x * radial.y);
}

// A segment is convex, and so is the disc of an arc that bulges outwards. Each lies beyond the tangent plane at its nearest point, in the half plane
// and, unless the normal points to the axis, also as a surface of revolution. Elements tied with the nearest share its end and its plane. If the
// plane supports the whole outline, no other element limits the step. Otherwise only the distance itself is known.
Support support_at(const Vessel& vessel, Vec3 p) {
  Support support;
  if (vessel.is_lattice) {
    support.distance = lattice_distance(vessel.lattice, p);
    support.other = support.distance;
    return support;
  }
  const Real r = std::sqrt(p.x * p.x + p.z * p.z);
  const Vec2 q(r, p.y);
  bool inside = false;
  const Nearest nearest = nearest_element(vessel, q, inside);
  const Real distance = std::sqrt(nearest.distance_squared);
  support.distance = inside ? -distance : distance;
  const Element& element = vessel.outline[nearest.element];
  support.other = element_supports(element, q) ? Real(FAR_AWAY) : std::sqrt(nearest.other_squared);
  const Vec2 outward = element_outward(element, q, inside ? Real(-1) : Real(1));
  const Vec2 normal = outward * (Real(1) / std::sqrt(glm::dot(outward, outward)));
  support.element = nearest.element;
  support.planar = element_convex(element, q) && !inside && !nearest.curved_tie && normal.x >= 0;
  const Vec2 radial = r > 0 ? Vec2(p.x, p.z) * (Real(1) / r) : Vec2(1, 0);
  support.normal = Vec3(normal.x * radial.x, normal.y, normal.x * radial.y);
  return support;
}

// The plane at distance s with the normal n approaches by at most -n.v t + a t^2 / 2, so it is not met before the positive root of s + n.v t - a t^2
// / 2. Near the surface that is Newton's step, where separation / speed alone would creep up on a wall that is met at a flat angle. Degenerate: a
// point at rest never limits a step.
Real plane_step(Support support, Real separation, Real closing, Real speed, Real acceleration) {
  if (!(speed > 0)) return NO_DISTANCE;
  const Real per_speed = Real(1) / speed;
  const Real lipschitz = separation * per_speed;
  const Real root = std::sqrt(closing * closing + Real(2) * acceleration * separation);
  const bool nears = closing > 0;
  const Real over = nears ? Real(2) * separation : root - closing;
  const Real under = nears ? root + closing : acceleration;
  const Real plane = under > 0 ? over / under : NO_DISTANCE;
  const Real others = (support.other - support.distance + separation) * per_speed;
  return support.planar ? std::max(lipschitz, std::min(plane, others)) : lipschitz;
}

Real safe_step(Support support, Real separation, Vec3 velocity, Real speed, Real acceleration) {
  return plane_step(support, separation, -glm::dot(support.normal, velocity), speed, acceleration);
}

}  // namespace CORE_NS

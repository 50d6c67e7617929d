// SPDX-License-Identifier: MIT
// Kernel 2: signed distance to the vessel, negative inside, m.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/arm.h"
#include "core/real.h"

namespace CORE_NS {

// One y-monotone element of a half outline in the (r, y) half plane, from a to b. `side` 0: a line; +1: an arc on the half r >= center.x of its
// circle; -1: on the other half. The interior lies to the left of a -> b. A line stores its unit outward normal in place of the center, so that its
// distance needs no division. `supports` (SUPPORTS_*): where the element's tangent is a supporting line of the outline, so that nothing of the
// outline lies beyond it.
struct Element {
  Vec2 a{}, b{}, center{};
  Real radius = 0;
  int side = 0;
  int supports = 0;
};

// Samples on a regular lattice, x fastest: sample (k * ny + j) * nx + i at origin + spacing * (i, j, k). Every precision and device uses the same
// storage (core/prepare.h's PreparedLattice): floats, or halves in units of HALF_UNIT.
struct Lattice {
  Vec3 origin{};
  Real spacing = 1;
  int nx = 0, ny = 0, nz = 0;
  bool halves = false;
  std::shared_ptr<const std::vector<std::uint32_t>> words;
};

// A vessel prepared for the kernels (core/prepare.h says where each part comes from). Vessel frame, m.
struct Vessel {
  bool is_lattice = false;
  std::vector<Element> outline;  // closed with the axis; the surface of the distance
  int lid = -1;                  // index of the mouth's element in `outline`; -1: none (shell, lattice)
  Lattice lattice;
  Limits limits;
  Real bound_height = 0;  // center (0, bound_height, 0) and radius of a sphere that encloses the vessel
  Real bound_radius = 0;
  std::vector<Element> cavity;  // inner wall from the floor to the mouth, y ascending; empty without a wall
  Real floor_height = 0;        // of the cavity on the axis
  Real mouth_height = 0;
  Real mouth_radius = 0;           // of the cavity at the mouth
  Real capacity = 0;               // m3, upright to the brim
  Real mass = 0;                   // empty, kg
  Vec3 center_of_mass{};           // empty
  std::vector<Real> lip_capacity;  // m3 at whole degrees 0..180; empty if the scene has no liquid
  bool on_table = false;           // the scene has a table
  Real table_top = 0;              // its height and the clearance
  Arm arm;                         // of the person who takes it
};

// State of the nearest-element search: the nearest element's number and squared distance; the squared distance of the next one that is further away;
// whether an arc is among several equally near.
struct Nearest {
  int element = 0;  // stays if no distance is a number
  Real distance_squared = NO_DISTANCE;
  Real other_squared = NO_DISTANCE;
  bool curved_tie = false;
};

// What is known around a point, m: its signed distance and the unit gradient `normal`. If `planar`, the nearest element lies wholly beyond the plane
// at that distance with that normal, and every other element is at least `other` away or also beyond the plane; if all are, `other` is FAR_AWAY. On a
// lattice the normal stays zero: nothing there is planar, and the gradient would cost as much as the distance (use distance_gradient).
struct Support {
  Real distance = 0;
  Real other = 0;
  Vec3 normal{};
  int element = -1;  // the nearest; -1 for a lattice
  bool planar = false;
};

// The cell of a lattice that holds a point clamped to the box, and the point's place in it.
struct Cell {
  int i, j, k;
  Vec3 fraction;
  Vec3 outside;  // from the clamped point to the point, m
};

// Squared distance from q to an element, m2.
Real element_distance_squared(const Element& element, Vec2 q);
// Whether the ray from q along +r crosses the element; it counts for q.y in [min, max) of its ends, a horizontal one never.
bool element_crosses(const Element& element, Vec2 q);
// Whether q's nearest point on the element lies between its ends.
bool element_spans(const Element& element, Vec2 q);
// Direction, of any nonzero length, of the signed distance's gradient at q outside if `element` is nearest. On the element: its outward normal.
// at_end: q is nearest to an end, so the direction reverses if q is inside.
Vec2 outward_of(const Element& element, Vec2 q, bool& at_end);
// The same outside (sign +1) or inside (-1).
inline Vec2 element_outward(const Element& element, Vec2 q, Real sign) {
  bool at_end = false;
  const Vec2 outward = outward_of(element, q, at_end);
  return at_end ? sign * outward : outward;
}
// Whether the element, seen from q outside, lies beyond its tangent plane at the nearest point.
bool element_convex(const Element& element, Vec2 q);
// Whether the whole outline does, by `supports` at the nearest point.
bool element_supports(const Element& element, Vec2 q);
// Nearest element of the outline (the first if equally near) and the crossing parity.
Nearest nearest_element(const Vessel& vessel, Vec2 q, bool& inside);
// Signed distance in the half plane, and its unit gradient there.
Real profile_distance(const Vessel& vessel, Vec2 q);
Vec2 profile_gradient(const Vessel& vessel, Vec2 q, int& element);
// The cell of p, a value of the lattice, and the value at t in [0, 1] between two.
Cell locate_cell(const Lattice& lattice, Vec3 p);
Real lattice_sample(const Lattice& lattice, int i, int j, int k);
Real mix_reals(Real a, Real b, Real t);
// A lower bound of the distance from a point off the box, m, from the value at the box's nearest point and the way from there: a step along a ray
// therefore never passes what the box holds. `value` itself if the way is zero.
Real distance_beyond(Real value, Vec3 outside);
// Trilinear value of the lattice; off the box, distance_beyond of the clamped point.
Real lattice_distance(const Lattice& lattice, Vec3 p);
// Unit gradient of lattice_distance; +x if it vanishes.
Vec3 lattice_gradient(const Lattice& lattice, Vec3 p);
// Signed distance to the vessel at p, m: exact for an outline. Never NaN for finite p.
Real signed_distance(const Vessel& vessel, Vec3 p);
// Unit gradient towards increasing distance; `element` is the nearest element's index (-1 for a lattice). On the axis it is the radial direction +x.
Vec3 distance_gradient(const Vessel& vessel, Vec3 p, int& element);

// Signed distance and lower bounds around p, for steps that must not pass a surface. From outside.
Support support_at(const Vessel& vessel, Vec3 p);

// Largest step in which a point is certain not to pass a surface: to the tangent plane of the nearest element under the largest acceleration, as long
// as no other element can be met at the largest speed; never less than separation / speed. The step's unit is the caller's (m, rad, closure);
// velocity, speed and acceleration are m per unit and per its square, the latter two upper bounds.
Real safe_step(Support support, Real separation, Vec3 velocity, Real speed, Real acceleration);
// The same if the speed towards the nearest element, `closing`, is known.
Real plane_step(Support support, Real separation, Real closing, Real speed, Real acceleration);

}  // namespace CORE_NS

// SPDX-License-Identifier: MIT
// Twin of core/sdf.cpp.
#ifndef SDF_GLSL
#define SDF_GLSL

#include "outline.glsl"

struct Nearest {
  int element;
  Real distance_squared, other_squared;
  bool curved_tie;
  Vec2 outward;
  bool at_end, convex, supports;
};

struct Support {
  Real distance, other;
  Vec3 normal;
  int element;
  bool planar;
};

Real element_distance_squared(Element element, Vec2 q) {
  precise Vec2 from_a = q - element.a;
  precise Vec2 from_b = q - element.b;
  precise Real to_a = from_a.x * from_a.x + from_a.y * from_a.y;
  precise Real to_b = from_b.x * from_b.x + from_b.y * from_b.y;
  if (element.side == 0) {
    Vec2 along = element.b - element.a;
    Real t = dot(from_a, along), across = dot(element.center, from_a);
    return t <= Real(0) ? to_a : t >= dot(along, along) ? to_b : across * across;
  }
  precise Vec2 from_center = q - element.center;
  precise Real distance = sqrt(from_center.x * from_center.x + from_center.y * from_center.y);
  Real low = smaller(element.a.y, element.b.y) - element.center.y;
  Real high = larger(element.a.y, element.b.y) - element.center.y;
  precise Real foot = from_center.y * element.radius;
  bool on_half = Real(element.side) * from_center.x >= Real(0);
  precise Real off = distance - element.radius;
  precise Real off_squared = off * off;
  return on_half && foot >= low * distance && foot <= high * distance ? off_squared : smaller(to_a, to_b);
}

bool element_crosses(Element element, Vec2 q) {
  bool up = element.b.y > element.a.y;
  Real low = up ? element.a.y : element.b.y;
  Real high = up ? element.b.y : element.a.y;
  // a level element is not crossed: written out, so that a driver omits it
  bool spans = low < high && !(q.y < low || q.y >= high);
  if (element.side == 0) {
    Vec2 along = element.b - element.a;
    Vec2 from_a = q - element.a;
    Real across = along.x * from_a.y - along.y * from_a.x;
    return spans && (up ? across > Real(0) : across < Real(0));
  }
  precise Vec2 from_center = q - element.center;
  precise Real square = from_center.x * from_center.x + from_center.y * from_center.y;
  bool within = square < element.radius * element.radius;
  return spans && (element.side > 0 ? from_center.x < Real(0) || within : from_center.x < Real(0) && !within);
}

bool element_spans(Element element, Vec2 q) {
  if (element.side == 0) {
    Vec2 along = element.b - element.a;
    Real t = dot(q - element.a, along);
    return t > Real(0) && t < dot(along, along);
  }
  Vec2 from_center = q - element.center;
  Real distance = sqrt(dot(from_center, from_center));
  Real low = smaller(element.a.y, element.b.y) - element.center.y;
  Real high = larger(element.a.y, element.b.y) - element.center.y;
  Real foot = from_center.y * element.radius;
  return Real(element.side) * from_center.x >= Real(0) && foot >= low * distance && foot <= high * distance;
}

Vec2 outward_of(Element element, Vec2 q, out bool at_end) {
  Vec2 from_a = q - element.a;
  Vec2 from_b = q - element.b;
  Real to_a = dot(from_a, from_a);
  Real to_b = dot(from_b, from_b);
  Vec2 from_end = to_a <= to_b ? from_a : from_b;
  at_end = !element_spans(element, q) && smaller(to_a, to_b) != Real(0);
  if (element.side == 0) return at_end ? from_end : element.center;
  bool up = element.b.y > element.a.y;
  Real bulge = (element.side > 0) == up ? Real(1) : Real(-1);
  Vec2 from_center = q - element.center;
  bool central = from_center.x == Real(0) && from_center.y == Real(0);
  Vec2 own = central ? Vec2(bulge * Real(element.side), Real(0)) : bulge * from_center;
  return at_end ? from_end : own;
}

bool element_convex(Element element, Vec2 q) {
  bool up = element.b.y > element.a.y;
  return element.side == 0 || ((element.side > 0) == up && element_spans(element, q));
}

bool element_supports(Element element, Vec2 q) {
  Vec2 from_a = q - element.a;
  Vec2 from_b = q - element.b;
  int end = dot(from_a, from_a) <= dot(from_b, from_b) ? SUPPORTS_AT_A : SUPPORTS_AT_B;
  return (element.supports & (element_spans(element, q) ? SUPPORTS_BETWEEN : end)) != 0;
}

// Data of the nearest element is picked by comparison during the loop, never by indexing with its number: drivers compile a constant table with
// run-time indices slowest of all.
Nearest nearest_element(Vec2 q, out bool inside) {
  COUNT_LANES(true);
  Nearest nearest = Nearest(0, NO_DISTANCE, NO_DISTANCE, false, Vec2(1, 0), false, false, false);
  int side = 0;
  bool follows = false;
  inside = false;
  OUTLINE_LOOP for (int i = 0; i < OUTLINE_COUNT; ++i) {
    Element element = outline_element(i);
    Real distance_squared = element_distance_squared(element, q);
    bool nearer = distance_squared < nearest.distance_squared;
    precise Vec2 from_a = q - element.a;
    precise Real to_a = from_a.x * from_a.x + from_a.y * from_a.y;
    bool shared_end = follows && distance_squared == nearest.distance_squared && to_a == distance_squared;
    Real behind = nearer ? nearest.distance_squared : shared_end ? NO_DISTANCE : distance_squared;
    nearest.other_squared = smaller(nearest.other_squared, behind);
    nearest.curved_tie = nearer ? false : nearest.curved_tie || (shared_end && (side != 0 || element.side != 0));
    nearest.distance_squared = nearer ? distance_squared : nearest.distance_squared;
    nearest.element = nearer ? i : nearest.element;
    side = nearer ? element.side : side;
    bool at_end;
    Vec2 outward = outward_of(element, q, at_end);
    nearest.outward = nearer ? outward : nearest.outward;
    nearest.at_end = nearer ? at_end : nearest.at_end;
    nearest.convex = nearer ? element_convex(element, q) : nearest.convex;
    nearest.supports = nearer ? element_supports(element, q) : nearest.supports;
    inside = inside != element_crosses(element, q);
    follows = nearer;
  }
  nearest.outward = nearest.at_end && inside ? -nearest.outward : nearest.outward;
  return nearest;
}

Real profile_distance(Vec2 q) {
  bool inside;
  Nearest nearest = nearest_element(q, inside);
  Real distance = sqrt(nearest.distance_squared);
  return inside ? -distance : distance;
}

Vec2 profile_gradient(Vec2 q, out int element) {
  bool inside;
  Nearest nearest = nearest_element(q, inside);
  element = nearest.element;
  return nearest.outward * (Real(1) / sqrt(dot(nearest.outward, nearest.outward)));
}

struct Cell {
  int i, j, k;
  Vec3 fraction, outside;
};

Cell locate_cell(Vec3 p) {
  COUNT_LANES(true);
  Vec3 origin = Vec3(scene.lattice_x, scene.lattice_y, scene.lattice_z);
  Vec3 counts = Vec3(Real(scene.lattice_nx - 1u), Real(scene.lattice_ny - 1u), Real(scene.lattice_nz - 1u));
  Vec3 clamped = min(max(p, origin), origin + counts * scene.lattice_spacing);
  Vec3 steps = min(max((clamped - origin) / scene.lattice_spacing, Vec3(0)), counts);
  Cell cell;
  cell.i = min(int(steps.x), int(scene.lattice_nx) - 2);
  cell.j = min(int(steps.y), int(scene.lattice_ny) - 2);
  cell.k = min(int(steps.z), int(scene.lattice_nz) - 2);
  cell.fraction = steps - Vec3(Real(cell.i), Real(cell.j), Real(cell.k));
  cell.outside = p - clamped;
  return cell;
}

Real lattice_sample(int i, int j, int k) {
  uint at = uint((k * int(scene.lattice_ny) + j) * int(scene.lattice_nx) + i);
  if (LATTICE_BITS == 32) return Real(uintBitsToFloat(texelFetch(lattice_words, int(at)).x));
  vec2 pair = unpackHalf2x16(texelFetch(lattice_words, int(at >> 1)).x);
  return Real((at & 1u) == 0u ? pair.x : pair.y) * HALF_UNIT;
}

Real mix_reals(Real a, Real b, Real t) {
  precise Real mixed = a + (b - a) * t;
  return mixed;
}

Real distance_beyond(Real value, Vec3 outside) {
  Real squared = dot(outside, outside), held = max(value, Real(0));
  return squared > Real(0) ? sqrt(held * held + squared) : value;
}

Real lattice_distance(Vec3 p) {
  Cell cell = locate_cell(p);
  Vec3 f = cell.fraction;
  Real c00 = mix_reals(lattice_sample(cell.i, cell.j, cell.k), lattice_sample(cell.i + 1, cell.j, cell.k), f.x);
  Real c10 = mix_reals(lattice_sample(cell.i, cell.j + 1, cell.k), lattice_sample(cell.i + 1, cell.j + 1, cell.k), f.x);
  Real c01 = mix_reals(lattice_sample(cell.i, cell.j, cell.k + 1), lattice_sample(cell.i + 1, cell.j, cell.k + 1), f.x);
  Real c11 = mix_reals(lattice_sample(cell.i, cell.j + 1, cell.k + 1), lattice_sample(cell.i + 1, cell.j + 1, cell.k + 1), f.x);
  return distance_beyond(mix_reals(mix_reals(c00, c10, f.y), mix_reals(c01, c11, f.y), f.z), cell.outside);
}

Vec3 lattice_gradient(Vec3 p) {
  Cell cell = locate_cell(p);
  Vec3 f = cell.fraction;
  Real s000 = lattice_sample(cell.i, cell.j, cell.k), s100 = lattice_sample(cell.i + 1, cell.j, cell.k);
  Real s010 = lattice_sample(cell.i, cell.j + 1, cell.k), s110 = lattice_sample(cell.i + 1, cell.j + 1, cell.k);
  Real s001 = lattice_sample(cell.i, cell.j, cell.k + 1), s101 = lattice_sample(cell.i + 1, cell.j, cell.k + 1);
  Real s011 = lattice_sample(cell.i, cell.j + 1, cell.k + 1), s111 = lattice_sample(cell.i + 1, cell.j + 1, cell.k + 1);
  Vec3 slope = Vec3(mix_reals(mix_reals(s100 - s000, s110 - s010, f.y), mix_reals(s101 - s001, s111 - s011, f.y), f.z),
                    mix_reals(mix_reals(s010 - s000, s110 - s100, f.x), mix_reals(s011 - s001, s111 - s101, f.x), f.z),
                    mix_reals(mix_reals(s001 - s000, s101 - s100, f.x), mix_reals(s011 - s010, s111 - s110, f.x), f.y));
  slope /= scene.lattice_spacing;
  if (cell.outside.x != Real(0)) slope.x = Real(0);
  if (cell.outside.y != Real(0)) slope.y = Real(0);
  if (cell.outside.z != Real(0)) slope.z = Real(0);
  if (dot(cell.outside, cell.outside) > Real(0)) {
    Real value = mix_reals(mix_reals(mix_reals(s000, s100, f.x), mix_reals(s010, s110, f.x), f.y),
                           mix_reals(mix_reals(s001, s101, f.x), mix_reals(s011, s111, f.x), f.y), f.z);
    slope = max(value, Real(0)) * slope + cell.outside;
  }
  Real size = length(slope);
  return size > Real(0) ? slope / size : Vec3(1, 0, 0);
}

Real signed_distance(Vec3 p) {
  if (SDF_KIND == SDF_LATTICE) return lattice_distance(p);
  precise Real r = sqrt(p.x * p.x + p.z * p.z);
  return profile_distance(Vec2(r, p.y));
}

Vec3 distance_gradient(Vec3 p, out int element) {
  if (SDF_KIND == SDF_LATTICE) {
    element = -1;
    return lattice_gradient(p);
  }
  precise Real r = sqrt(p.x * p.x + p.z * p.z);
  Vec2 gradient = profile_gradient(Vec2(r, p.y), element);
  Vec2 radial = r > Real(0) ? Vec2(p.x, p.z) * (Real(1) / r) : Vec2(1, 0);
  return Vec3(gradient.x * radial.x, gradient.y, gradient.x * radial.y);
}

Support support_at(Vec3 p) {
  if (SDF_KIND == SDF_LATTICE) {
    Real distance = lattice_distance(p);
    return Support(distance, distance, Vec3(0), -1, false);
  }
  precise Real r = sqrt(p.x * p.x + p.z * p.z);
  Vec2 q = Vec2(r, p.y);
  bool inside;
  Nearest nearest = nearest_element(q, inside);
  Real distance = sqrt(nearest.distance_squared);
  Real other = nearest.supports ? Real(FAR_AWAY) : sqrt(nearest.other_squared);
  Vec2 normal = nearest.outward * (Real(1) / sqrt(dot(nearest.outward, nearest.outward)));
  bool planar = nearest.convex && !inside && !nearest.curved_tie && normal.x >= Real(0);
  Vec2 radial = r > Real(0) ? Vec2(p.x, p.z) * (Real(1) / r) : Vec2(1, 0);
  Vec3 outward = Vec3(normal.x * radial.x, normal.y, normal.x * radial.y);
  return Support(inside ? -distance : distance, other, outward, nearest.element, planar);
}

Real plane_step(Support support, Real separation, Real closing, Real speed, Real acceleration) {
  Real per_speed = Real(1) / speed;
  Real lipschitz = separation * per_speed;
  Real root = sqrt(closing * closing + Real(2) * acceleration * separation);
  bool nears = closing > Real(0);
  Real over = nears ? Real(2) * separation : root - closing;
  Real under = nears ? root + closing : acceleration;
  Real plane = under > Real(0) ? over / under : NO_DISTANCE;
  Real others = (support.other - support.distance + separation) * per_speed;
  Real step = support.planar ? larger(lipschitz, smaller(plane, others)) : lipschitz;
  return speed > Real(0) ? step : NO_DISTANCE;
}

Real safe_step(Support support, Real separation, Vec3 velocity, Real speed, Real acceleration) {
  return plane_step(support, separation, -dot(support.normal, velocity), speed, acceleration);
}

#endif

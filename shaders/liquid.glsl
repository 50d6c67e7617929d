// SPDX-License-Identifier: MIT
// Twin of core/liquid.cpp.
#ifndef LIQUID_GLSL
#define LIQUID_GLSL

#include "element.glsl"
#include "trig.glsl"

struct Slices {
  Real volume, lean, height, surface;
};

struct LiquidState {
  Real volume, lean, height;
};

Real segment_area(Real r, Real h) {
  Real disc = Real(2) * HALF_PI * r * r;
  if (h >= r) return Real(0);
  if (h <= -r) return disc;
  Real away = abs(h);
  Real theta = Real(2) * (HALF_PI - arc_cosine(sqrt((r - away) / (Real(2) * r))));
  Real cap = max(Real(0), r * r * theta - away * sqrt((r - away) * (r + away)));
  return h >= Real(0) ? cap : disc - cap;
}

Real segment_moment(Real r, Real h) {
  if (h >= r || h <= -r) return Real(0);
  Real square = (r - h) * (r + h);
  return Real(2) / Real(3) * square * sqrt(square);
}

Real element_radius(Element element, Real y) {
  if (element.side == 0) return element.a.x + (element.b.x - element.a.x) * ((y - element.a.y) / (element.b.y - element.a.y));
  Real rise = y - element.center.y;
  return element.center.x + Real(element.side) * sqrt(max(Real(0), (element.radius - rise) * (element.radius + rise)));
}

Vec2 plane_crossings(Element element, Real level, Real sine_tilt, Real cosine_tilt, Real sigma) {
  Real start = element.a.y;
  if (element.side == 0) {
    Vec2 along = element.b - element.a;
    Real rise = cosine_tilt * along.y - sigma * sine_tilt * along.x;
    Real missing = level - (cosine_tilt * element.a.y - sigma * sine_tilt * element.a.x);
    if (rise == Real(0)) return Vec2(start);
    Real y = start + along.y * (missing / rise);
    return Vec2(clamp(y, start, element.b.y), start);
  }
  Real off = cosine_tilt * element.center.y - sigma * sine_tilt * element.center.x - level;
  Real half_squared = (element.radius - off) * (element.radius + off);
  if (half_squared <= Real(0)) return Vec2(start);
  Real half_chord = sqrt(half_squared);
  Vec2 foot = element.center - off * Vec2(-sigma * sine_tilt, cosine_tilt);
  Vec2 reach = half_chord * Vec2(cosine_tilt, sigma * sine_tilt);
  Vec2 first = foot + reach;
  Vec2 second = foot - reach;
  Vec2 heights = Vec2(start);
  if (Real(element.side) * (first.x - element.center.x) >= Real(0)) heights.x = clamp(first.y, start, element.b.y);
  if (Real(element.side) * (second.x - element.center.x) >= Real(0)) heights.y = clamp(second.y, start, element.b.y);
  return heights;
}

Slices integrate_slices(Element element, Real low, Real high, Real level, Real sine_tilt, Real cosine_tilt) {
  Slices sum = Slices(Real(0), Real(0), Real(0), Real(0));
  Real middle = Real(0.5) * (low + high);
  Real half_height = Real(0.5) * (high - low);
  if (half_height <= Real(0)) return sum;
  Real middle_radius = element_radius(element, middle);
  Real middle_chord = cosine_tilt * middle - level;
  if (middle_chord >= sine_tilt * middle_radius) return sum;
  bool full = middle_chord <= -sine_tilt * middle_radius;
  for (int i = 0; i < QUADRATURE_COUNT; ++i) {
    Real y = middle - half_height * quadrature_cosine(i);
    Real weight = half_height * quadrature_weight(i);
    Real r = element_radius(element, y);
    if (full) {
      Real area = Real(2) * HALF_PI * r * r;
      sum.volume += weight * area;
      sum.height += weight * area * y;
    } else {
      Real h = (cosine_tilt * y - level) / sine_tilt;
      Real area = segment_area(r, h);
      sum.volume += weight * area;
      sum.lean += weight * segment_moment(r, h);
      sum.height += weight * area * y;
      sum.surface += weight * (Real(2) * sqrt(max(Real(0), (r - h) * (r + h))) / sine_tilt);
    }
  }
  return sum;
}

Slices piece_below(Element element, Real level, Real sine_tilt, Real cosine_tilt) {
  Slices sum = Slices(Real(0), Real(0), Real(0), Real(0));
  if (sine_tilt < UPRIGHT_SINE) {
    bool upright = cosine_tilt > Real(0);
    Real cut = clamp(level / cosine_tilt, element.a.y, element.b.y);
    Real low = upright ? element.a.y : cut;
    Real high = upright ? cut : element.b.y;
    sum = integrate_slices(element, low, high, NO_DISTANCE, Real(0), cosine_tilt);
    if (cut > element.a.y && cut < element.b.y) {
      Real r = element_radius(element, cut);
      sum.surface = Real(2) * HALF_PI * r * r;
    }
    return sum;
  }
  Vec2 near_side = plane_crossings(element, level, sine_tilt, cosine_tilt, Real(1));
  Vec2 far_side = plane_crossings(element, level, sine_tilt, cosine_tilt, Real(-1));
  Real a = min(near_side.x, near_side.y), b = max(near_side.x, near_side.y);
  Real c = min(far_side.x, far_side.y), d = max(far_side.x, far_side.y);
  Real first = min(a, c), last = max(b, d);
  Real inner = max(a, c), outer = min(b, d);
  Real breaks[6] = Real[](element.a.y, first, min(inner, outer), max(inner, outer), last, element.b.y);
  for (int i = 0; i < 5; ++i) {
    Slices part = integrate_slices(element, breaks[i], breaks[i + 1], level, sine_tilt, cosine_tilt);
    sum.volume += part.volume;
    sum.lean += part.lean;
    sum.height += part.height;
    sum.surface += part.surface;
  }
  return sum;
}

Slices liquid_below(Real level, Real sine_tilt, Real cosine_tilt) {
  Slices sum = Slices(Real(0), Real(0), Real(0), Real(0));
  COUNT_LANES(true);
  for (int i = 0; i < int(scene.cavity_count); ++i) {
    Slices piece = piece_below(cavity_element(i), level, sine_tilt, cosine_tilt);
    sum.volume += piece.volume;
    sum.lean += piece.lean;
    sum.height += piece.height;
    sum.surface += piece.surface;
  }
  return sum;
}

Real lip_level(Real sine_tilt, Real cosine_tilt) {
  Real sine_used = sine_tilt < UPRIGHT_SINE ? Real(0) : sine_tilt;
  return scene.mouth_height * cosine_tilt - scene.mouth_radius * sine_used;
}

Real lip_capacity(Real sine_tilt, Real cosine_tilt) {
  Real held = liquid_below(lip_level(sine_tilt, cosine_tilt), sine_tilt, cosine_tilt).volume;
  return held > LEVEL_TOLERANCE * scene.capacity ? held : Real(0);
}

Real bottom_level(Real sine_tilt, Real cosine_tilt) {
  Real lowest = NO_DISTANCE;
  for (int i = 0; i < int(scene.cavity_count); ++i) {
    Element element = cavity_element(i);
    Real at_a = cosine_tilt * element.a.y - sine_tilt * element.a.x;
    Real at_b = cosine_tilt * element.b.y - sine_tilt * element.b.x;
    Real on_arc = cosine_tilt * element.center.y - sine_tilt * element.center.x - element.radius;
    lowest = min(lowest, min(at_a, at_b));
    if (element.side != 0) lowest = min(lowest, on_arc);
  }
  return lowest;
}

LiquidState liquid_at(Real volume, Real sine_tilt, Real cosine_tilt) {
  LiquidState state = LiquidState(Real(0), Real(0), scene.floor_height);
  if (!(volume > Real(0))) return state;
  Real tolerance = LEVEL_TOLERANCE * scene.capacity;
  Real low = bottom_level(sine_tilt, cosine_tilt);
  Real high = lip_level(sine_tilt, cosine_tilt);
  Real level = high;
  Real last_move = high - low;
  Slices below = Slices(Real(0), Real(0), Real(0), Real(0));
  for (int step = 0; step < LEVEL_STEPS; ++step) {
    below = liquid_below(level, sine_tilt, cosine_tilt);
    Real error = below.volume - volume;
    if (abs(error) <= tolerance) break;
    if (error > Real(0)) high = level;
    if (error < Real(0)) low = level;
    Real next = level - error / below.surface;
    bool shrinks = Real(2) * abs(next - level) <= last_move;
    if (!(next > low && next < high && shrinks)) next = Real(0.5) * (low + high);
    if (next == level) break;
    last_move = abs(next - level);
    level = next;
  }
  state.volume = volume;
  if (below.volume > Real(0)) {
    state.lean = below.lean / below.volume;
    state.height = below.height / below.volume;
  }
  return state;
}

#endif

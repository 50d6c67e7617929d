// SPDX-License-Identifier: MIT
#include "core/liquid.h"

#include <algorithm>
#include <cmath>

#include "core/trig.h"

namespace CORE_NS {
namespace {

constexpr int LEVEL_STEPS = 64;  // safeguarded Newton steps of the level

}  // namespace

// r^2 theta - |h| sqrt(r^2 - h^2) with theta = acos(|h| / r) computed from the segment's own height r - |h|, because acos near 1 would lose half the
// digits. The rest of the disc for h < 0, the whole for h <= -r, nothing for h >= r.
Real segment_area(Real r, Real h) {
  const Real disc = Real(2) * HALF_PI * r * r;
  if (h >= r) return 0;
  if (h <= -r) return disc;
  const Real away = std::abs(h);
  const Real theta = Real(2) * (HALF_PI - arc_cosine(std::sqrt((r - away) / (Real(2) * r))));
  const Real cap = std::max(Real(0), r * r * theta - away * std::sqrt((r - away) * (r + away)));
  return h >= 0 ? cap : disc - cap;
}

// int x dA = 2/3 (r^2 - h^2)^(3/2).
Real segment_moment(Real r, Real h) {
  if (h >= r || h <= -r) return 0;
  const Real square = (r - h) * (r + h);
  return Real(2) / Real(3) * square * std::sqrt(square);
}

Real element_radius(const Element& element, Real y) {
  if (element.side == 0) return element.a.x + (element.b.x - element.a.x) * ((y - element.a.y) / (element.b.y - element.a.y));
  const Real rise = y - element.center.y;
  return element.center.x + Real(element.side) * std::sqrt(std::max(Real(0), (element.radius - rise) * (element.radius + rise)));
}

// In the (r, y) plane this is a straight line with the normal (-sin sigma, cos): one crossing with a line, up to two with a circle.
Vec2 plane_crossings(const Element& element, Real level, Real sine_tilt, Real cosine_tilt, Real sigma) {
  const Real start = element.a.y;
  if (element.side == 0) {
    const Vec2 along = element.b - element.a;
    const Real rise = cosine_tilt * along.y - sigma * sine_tilt * along.x;
    const Real missing = level - (cosine_tilt * element.a.y - sigma * sine_tilt * element.a.x);
    if (rise == 0) return Vec2(start);
    const Real y = start + along.y * (missing / rise);
    return Vec2(std::clamp(y, start, element.b.y), start);
  }
  const Real off = cosine_tilt * element.center.y - sigma * sine_tilt * element.center.x - level;
  const Real half_squared = (element.radius - off) * (element.radius + off);
  if (half_squared <= 0) return Vec2(start);
  const Real half = std::sqrt(half_squared);
  const Vec2 foot = element.center - off * Vec2(-sigma * sine_tilt, cosine_tilt);
  const Vec2 reach = half * Vec2(cosine_tilt, sigma * sine_tilt);
  const Vec2 first = foot + reach;
  const Vec2 second = foot - reach;
  Vec2 heights(start);
  if (Real(element.side) * (first.x - element.center.x) >= 0) heights.x = std::clamp(first.y, start, element.b.y);
  if (Real(element.side) * (second.x - element.center.x) >= 0) heights.y = std::clamp(second.y, start, element.b.y);
  return heights;
}

Slices integrate_slices(const Quadrature& quadrature, const Element& element, Real low, Real high, Real level, Real sine_tilt,
                        Real cosine_tilt) {
  Slices sum;
  const Real middle = Real(0.5) * (low + high);
  const Real half = Real(0.5) * (high - low);
  if (half <= 0) return sum;
  const Real middle_radius = element_radius(element, middle);
  const Real middle_chord = cosine_tilt * middle - level;
  if (middle_chord >= sine_tilt * middle_radius) return sum;  // dry
  const bool full = middle_chord <= -sine_tilt * middle_radius;
  for (int i = 0; i < quadrature.count; ++i) {
    const Real y = middle - half * quadrature.cosine[i];
    const Real weight = half * quadrature.weight[i];
    const Real r = element_radius(element, y);
    if (full) {
      const Real area = Real(2) * HALF_PI * r * r;
      sum.volume += weight * area;
      sum.height += weight * area * y;
    } else {
      const Real h = (cosine_tilt * y - level) / sine_tilt;
      const Real area = segment_area(r, h);
      sum.volume += weight * area;
      sum.lean += weight * segment_moment(r, h);
      sum.height += weight * area * y;
      sum.surface += weight * (Real(2) * std::sqrt(std::max(Real(0), (r - h) * (r + h))) / sine_tilt);
    }
  }
  return sum;
}

// Splits where the plane meets the wall: there the integrand ends in a 3/2 power, which the cosine map smooths.
Slices piece_below(const Quadrature& quadrature, const Element& element, Real level, Real sine_tilt, Real cosine_tilt) {
  Slices sum;
  if (sine_tilt < UPRIGHT_SINE) {
    // a horizontal cut: the slices under it are full
    const bool upright = cosine_tilt > 0;
    const Real cut = std::clamp(level / cosine_tilt, element.a.y, element.b.y);
    const Real low = upright ? element.a.y : cut;
    const Real high = upright ? cut : element.b.y;
    sum = integrate_slices(quadrature, element, low, high, NO_DISTANCE, Real(0), cosine_tilt);
    if (cut > element.a.y && cut < element.b.y) {
      const Real r = element_radius(element, cut);
      sum.surface = Real(2) * HALF_PI * r * r;
    }
    return sum;
  }
  const Vec2 near = plane_crossings(element, level, sine_tilt, cosine_tilt, Real(1));
  const Vec2 far = plane_crossings(element, level, sine_tilt, cosine_tilt, Real(-1));
  // the four breaks in ascending order
  const Real a = std::min(near.x, near.y), b = std::max(near.x, near.y);
  const Real c = std::min(far.x, far.y), d = std::max(far.x, far.y);
  const Real first = std::min(a, c), last = std::max(b, d);
  const Real inner = std::max(a, c), outer = std::min(b, d);
  const Real second = std::min(inner, outer), third = std::max(inner, outer);
  Slices parts[5];
  parts[0] = integrate_slices(quadrature, element, element.a.y, first, level, sine_tilt, cosine_tilt);
  parts[1] = integrate_slices(quadrature, element, first, second, level, sine_tilt, cosine_tilt);
  parts[2] = integrate_slices(quadrature, element, second, third, level, sine_tilt, cosine_tilt);
  parts[3] = integrate_slices(quadrature, element, third, last, level, sine_tilt, cosine_tilt);
  parts[4] = integrate_slices(quadrature, element, last, element.b.y, level, sine_tilt, cosine_tilt);
  for (int i = 0; i < 5; ++i) {
    sum.volume += parts[i].volume;
    sum.lean += parts[i].lean;
    sum.height += parts[i].height;
    sum.surface += parts[i].surface;
  }
  return sum;
}

Slices liquid_below(const Vessel& vessel, const Quadrature& quadrature, Real level, Real sine_tilt, Real cosine_tilt) {
  Slices sum;
  const int count = static_cast<int>(vessel.cavity.size());
  for (int i = 0; i < count; ++i) {
    const Slices piece = piece_below(quadrature, vessel.cavity[i], level, sine_tilt, cosine_tilt);
    sum.volume += piece.volume;
    sum.lean += piece.lean;
    sum.height += piece.height;
    sum.surface += piece.surface;
  }
  return sum;
}

Real lip_level(const Vessel& vessel, Real sine_tilt, Real cosine_tilt) {
  const Real sine = sine_tilt < UPRIGHT_SINE ? Real(0) : sine_tilt;
  return vessel.mouth_height * cosine_tilt - vessel.mouth_radius * sine;
}

// Less than the level's tolerance is rounding at a mouth that is the lowest point, and counts as none.
Real lip_capacity(const Vessel& vessel, const Quadrature& quadrature, Real sine_tilt, Real cosine_tilt) {
  const Real held = liquid_below(vessel, quadrature, lip_level(vessel, sine_tilt, cosine_tilt), sine_tilt, cosine_tilt).volume;
  return held > LEVEL_TOLERANCE * vessel.capacity ? held : Real(0);
}

// cos y - sin r is least at an end of a piece or where a circle faces straight down; the whole circle bounds the arc.
Real bottom_level(const Vessel& vessel, Real sine_tilt, Real cosine_tilt) {
  Real lowest = NO_DISTANCE;
  const int count = static_cast<int>(vessel.cavity.size());
  for (int i = 0; i < count; ++i) {
    const Element& element = vessel.cavity[i];
    const Real at_a = cosine_tilt * element.a.y - sine_tilt * element.a.x;
    const Real at_b = cosine_tilt * element.b.y - sine_tilt * element.b.x;
    const Real on_arc = cosine_tilt * element.center.y - sine_tilt * element.center.x - element.radius;
    lowest = std::min(lowest, std::min(at_a, at_b));
    if (element.side != 0) lowest = std::min(lowest, on_arc);
  }
  return lowest;
}

// Safeguarded Newton: the free surface is the volume's derivative by the level. If a wide body ends in a narrow neck, Newton's steps may alternate
// between the two forever, each within its bracket, so a step longer than half of the last one also becomes a bisection.
LiquidState liquid_at(const Vessel& vessel, const Quadrature& quadrature, Real volume, Real sine_tilt, Real cosine_tilt) {
  LiquidState state;
  state.height = vessel.floor_height;
  if (!(volume > 0)) return state;
  const Real tolerance = LEVEL_TOLERANCE * vessel.capacity;
  Real low = bottom_level(vessel, sine_tilt, cosine_tilt);
  Real high = lip_level(vessel, sine_tilt, cosine_tilt);
  Real level = high;
  Real last_move = high - low;
  Slices below;
  for (int step = 0; step < LEVEL_STEPS; ++step) {
    below = liquid_below(vessel, quadrature, level, sine_tilt, cosine_tilt);
    const Real error = below.volume - volume;
    if (std::abs(error) <= tolerance) break;
    if (error > 0) high = level;
    if (error < 0) low = level;
    Real next = level - error / below.surface;
    const bool shrinks = Real(2) * std::abs(next - level) <= last_move;
    if (!(next > low && next < high && shrinks)) next = Real(0.5) * (low + high);
    if (next == level) break;
    last_move = std::abs(next - level);
    level = next;
  }
  state.volume = volume;
  state.level = level;
  if (below.volume > 0) {
    state.lean = below.lean / below.volume;
    state.height = below.height / below.volume;
  }
  return state;
}

}  // namespace CORE_NS

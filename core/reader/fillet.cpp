// SPDX-License-Identifier: MIT
#include "core/reader/fillet.h"

#include <algorithm>
#include <cmath>

#include "core/scene.h"

namespace wholehand {
namespace {

constexpr double STRAIGHT = 1e-6;  // rad: a smaller bend is no corner
// Share of a length by which rounding may put a point of touch beyond its element's end, or off the circle.
constexpr double ROUNDED = 1e-9;

Point along_line(const PlaneCurve& line) {
  const double length = distance(line.a, line.b);
  return {(line.b[0] - line.a[0]) / length, (line.b[1] - line.a[1]) / length};
}

// Unit direction of the way at an end of the curve.
Point direction(const PlaneCurve& curve, const Point& at) {
  if (!curve.is_arc) return along_line(curve);
  const double way = curve.sweep > 0 ? 1 : -1;
  return {-way * (at[1] - curve.center[1]) / curve.radius, way * (at[0] - curve.center[0]) / curve.radius};
}

// The curve's supporting line or circle moved to the left by `shift`; nothing where no circle is left of it.
std::optional<PlaneCurve> offset_support(const PlaneCurve& curve, double shift) {
  PlaneCurve moved = curve;
  if (curve.is_arc) {
    moved.radius = curve.radius - (curve.sweep > 0 ? shift : -shift);
    if (moved.radius <= 0) return std::nullopt;
    return moved;
  }
  const Point along = along_line(curve);
  for (Point* end : {&moved.a, &moved.b}) *end = {(*end)[0] - along[1] * shift, (*end)[1] + along[0] * shift};
  return moved;
}

// Where a circle about `center` touches the curve's support.
Point touch(const PlaneCurve& curve, const Point& center) {
  if (curve.is_arc) {
    const double share = curve.radius / distance(center, curve.center);
    return {curve.center[0] + share * (center[0] - curve.center[0]), curve.center[1] + share * (center[1] - curve.center[1])};
  }
  const Point along = along_line(curve);
  const double way = (center[0] - curve.a[0]) * along[0] + (center[1] - curve.a[1]) * along[1];
  return {curve.a[0] + way * along[0], curve.a[1] + way * along[1]};
}

double length_of(const PlaneCurve& curve) {
  return curve.is_arc ? curve.radius * std::abs(curve.sweep) : distance(curve.a, curve.b);
}

// How far along the curve p lies, which is on its support; beyond either end a little less than 0 or more than its length.
double way_to(const PlaneCurve& curve, const Point& p) {
  if (!curve.is_arc) {
    const Point along = along_line(curve);
    return (p[0] - curve.a[0]) * along[0] + (p[1] - curve.a[1]) * along[1];
  }
  const double turned = turned_to(curve, p), beyond = (2 * PI - std::abs(curve.sweep)) / 2;
  return curve.radius * (turned > std::abs(curve.sweep) + beyond ? turned - 2 * PI : turned);
}

PlaneCurve between(const PlaneCurve& curve, const Point& a, const Point& b) {
  PlaneCurve part = curve;
  part.a = a;
  part.b = b;
  if (!curve.is_arc) return part;
  const double turned = (way_to(curve, b) - way_to(curve, a)) / curve.radius;
  part.from = std::atan2(a[1] - curve.center[1], a[0] - curve.center[0]);
  part.sweep = curve.sweep > 0 ? turned : -turned;
  return part;
}

}  // namespace

int corner_turn(const PlaneCurve& first, const PlaneCurve& second) {
  const Point in = direction(first, first.b), out = direction(second, second.a);
  const double sine = in[0] * out[1] - in[1] * out[0];
  return std::abs(sine) < STRAIGHT ? 0 : sine > 0 ? 1 : -1;
}

// The arc's center is as far from both elements as its radius: where their offsets to the inside of the corner cross. Chooses the
// crossing that takes less of the elements away.
std::optional<Fillet> make_fillet(const PlaneCurve& first, const PlaneCurve& second, double radius) {
  const int turn = corner_turn(first, second);
  const auto first_offset = offset_support(first, turn * radius), second_offset = offset_support(second, turn * radius);
  if (turn == 0 || !first_offset || !second_offset) return std::nullopt;
  const Crossings centers = support_crossings(*first_offset, *second_offset);
  const double first_length = length_of(first), second_length = length_of(second);
  std::optional<Fillet> best;
  double least = first_length + second_length;
  for (int i = 0; i < centers.count; ++i) {
    const Point &center = centers.points[i], begin = touch(first, center), end = touch(second, center);
    const double rounded = ROUNDED * (radius + first_length + second_length);
    const bool touches =
        std::abs(distance(center, begin) - radius) <= rounded && std::abs(distance(center, end) - radius) <= rounded;
    const double kept = way_to(first, begin), taken = way_to(second, end);
    const bool is_on_both = kept >= -rounded && kept <= first_length && taken >= 0 && taken <= second_length + rounded;
    const double lost = first_length - kept + taken;
    // what is left of an element is an element, or nothing
    const auto is_part = [rounded](double left) { return left <= rounded || left >= SHORTEST_ELEMENT; };
    if (!touches || !is_on_both || lost > least + rounded || !is_part(kept) || !is_part(second_length - taken)) continue;
    least = lost;
    PlaneCurve arc{true, begin, end, center};
    arc.radius = radius;
    arc.from = std::atan2(begin[1] - center[1], begin[0] - center[0]);
    arc.sweep = turn;  // until the angle is known
    arc.sweep = turn * turned_to(arc, end);
    best = Fillet{between(first, first.a, begin), arc, between(second, end, second.b)};
  }
  return best;
}

double largest_fillet(const PlaneCurve& first, const PlaneCurve& second, double radius) {
  double fits = 0, too_large = radius;
  for (int step = 0; step < 80; ++step) {
    const double middle = (fits + too_large) / 2;
    (make_fillet(first, second, middle) ? fits : too_large) = middle;
  }
  // a little more may fit again, where it takes the whole of an element
  const double round = std::ceil(fits * 100) / 100;
  return round <= radius && make_fillet(first, second, round) ? round : std::floor(fits * 1e6) / 1e6;
}

}  // namespace wholehand

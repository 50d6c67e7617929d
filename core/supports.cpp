// SPDX-License-Identifier: MIT
#include "core/supports.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "shaders/layout.h"

namespace wholehand {
namespace {

using Pair = std::array<double, 2>;

// How far beyond a tangent a point may lie, m: rounding of the outline's coordinates, far less than a finger's smallest stop distance.
constexpr double BEYOND_TOLERANCE = 1e-13;

double dot(const Pair& a, const Pair& b) { return a[0] * b[0] + a[1] * b[1]; }
Pair from_to(const Pair& a, const Pair& b) { return {b[0] - a[0], b[1] - a[1]}; }

// Whether the direction from an arc's center meets the arc.
bool meets(const PreparedElement& arc, const Pair& direction) {
  const double size = std::hypot(direction[0], direction[1]);
  if (size == 0 || arc.side * direction[0] < 0) return false;
  const double height = arc.center[1] + arc.radius * direction[1] / size;
  return height >= std::min(arc.a[1], arc.b[1]) && height <= std::max(arc.a[1], arc.b[1]);
}

// How far an element reaches in a direction of length 1.
double reach(const PreparedElement& element, const Pair& direction) {
  const double ends = std::max(dot(direction, element.a), dot(direction, element.b));
  if (element.side == 0 || !meets(element, direction)) return ends;
  return std::max(ends, dot(direction, element.center) + element.radius);
}

bool line_supports(const std::vector<PreparedElement>& outline, std::size_t own) {
  const Pair normal = outline[own].center;
  const double level = dot(normal, outline[own].a);
  return std::all_of(outline.begin(), outline.end(),
                     [&](const PreparedElement& other) { return reach(other, normal) <= level + BEYOND_TOLERANCE; });
}

// Where the tangents at an arc's ends meet: the arc lies in the triangle of this point and its ends. None of an arc of more than 120
// degrees.
std::optional<Pair> corner_of(const PreparedElement& arc) {
  const Pair a = from_to(arc.center, arc.a), b = from_to(arc.center, arc.b);
  const Pair middle{a[0] + b[0], a[1] + b[1]};
  const double size = std::hypot(middle[0], middle[1]);  // 2 r cos(half of the angle)
  if (size < arc.radius) return std::nullopt;
  const double stretch = 2 * arc.radius * arc.radius / (size * size);
  return Pair{arc.center[0] + stretch * middle[0], arc.center[1] + stretch * middle[1]};
}

// A point lies beyond none of an arc's tangents if it lies in the disc or, seen from the center beside the arc, beyond neither end's
// tangent. The ends' distances from the center may differ from the radius by what the scene's reader allows.
bool within_tangents(const PreparedElement& arc, const Pair& p) {
  const Pair from_center = from_to(arc.center, p);
  if (meets(arc, from_center)) return std::hypot(from_center[0], from_center[1]) <= arc.radius + BEYOND_TOLERANCE;
  const auto is_within = [&](const Pair& end) {
    const Pair arm = from_to(arc.center, end);
    const double size = std::hypot(arm[0], arm[1]);
    return dot(from_center, arm) <= size * (size + BEYOND_TOLERANCE);
  };
  return is_within(arc.a) && is_within(arc.b);
}

// All tangents of a convex arc at once: what lies beyond none of them is convex.
bool arc_supports(const std::vector<PreparedElement>& outline, std::size_t own) {
  const PreparedElement& arc = outline[own];
  if ((arc.side > 0) != (arc.b[1] > arc.a[1])) return false;  // it bulges inwards
  return std::all_of(outline.begin(), outline.end(), [&](const PreparedElement& other) {
    if (other.side != 0 && other.center == arc.center && std::abs(other.radius - arc.radius) <= BEYOND_TOLERANCE) return true;
    const std::optional<Pair> corner = other.side != 0 ? corner_of(other) : other.a;
    return corner && within_tangents(arc, *corner) && within_tangents(arc, other.a) && within_tangents(arc, other.b);
  });
}

}  // namespace

// Where two supporting lines meet, so do all lines between their directions support, and of these is each across the way to a point whose
// nearest one is the corner. On the axis the only such points are those beyond the end, and a line across the axis supports where no normal
// turns to the axis.
void mark_supports(std::vector<PreparedElement>& outline) {
  std::vector<bool> supports(outline.size());
  for (std::size_t i = 0; i < outline.size(); ++i)
    supports[i] = outline[i].side == 0 ? line_supports(outline, i) : arc_supports(outline, i);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    PreparedElement& element = outline[i];
    element.supports = 0;
    if (!supports[i]) continue;
    const bool ends_on_axis = element.side == 0 && element.center[0] >= 0 && element.center[1] != 0;
    const bool at_a = i > 0 ? supports[i - 1] : ends_on_axis;
    const bool at_b = i + 1 < outline.size() ? supports[i + 1] : ends_on_axis;
    element.supports = SUPPORTS_BETWEEN | (at_a ? SUPPORTS_AT_A : 0) | (at_b ? SUPPORTS_AT_B : 0);
  }
}

}  // namespace wholehand

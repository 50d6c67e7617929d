// SPDX-License-Identifier: MIT
#include "core/outline_points.h"

#include <algorithm>
#include <cmath>

namespace wholehand {
namespace {

using Point2 = std::array<double, 2>;

// All but its first.
void append_element(const PreparedElement& element, double step, std::vector<Point2>& points) {
  if (element.side != 0) {
    const auto angle = [&](const Point2& p) { return std::atan2(p[1] - element.center[1], p[0] - element.center[0]); };
    const double from = angle(element.a), sweep = std::remainder(angle(element.b) - from, 2 * PI);
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / step)));
    for (int k = 1; k < steps; ++k) {
      const double at = from + sweep * k / steps;
      points.push_back({element.center[0] + element.radius * std::cos(at), element.center[1] + element.radius * std::sin(at)});
    }
  }
  points.push_back(element.b);
}

// Level elements of a cavity are left out: the next one begins elsewhere.
bool is_apart(const Point2& a, const Point2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]) > 1e-9; }

}  // namespace

std::vector<Point2> outline_points(const std::vector<PreparedElement>& elements, std::size_t count, double step) {
  std::vector<Point2> points;
  if (count > 0) points.push_back(elements.front().a);
  for (std::size_t k = 0; k < count; ++k) {
    if (is_apart(elements[k].a, points.back())) points.push_back(elements[k].a);
    append_element(elements[k], step, points);
  }
  return points;
}

}  // namespace wholehand

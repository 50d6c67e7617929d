// SPDX-License-Identifier: MIT
#include "core/meshes/outline_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wholehand {
namespace {

constexpr double STRAIGHT = 1e-9;        // sine of the corner of a triangle whose corners lie on a line
constexpr double LEAST_SAGITTA = 10e-6;  // m: written to a micrometer, a flatter arc may be a line
constexpr double MOST_RADIUS = 10;       // m: a scene takes centers up to 25 m away
constexpr std::size_t LEAST_ARC = 4;     // points of an arc: a circle passes through any three

// The circle through three points.
struct Circle {
  ProfilePoint center{};
  double radius = 0;
};

std::optional<Circle> circle_through(const ProfilePoint& a, const ProfilePoint& b, const ProfilePoint& c) {
  const double bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
  const double turn = bx * cy - by * cx, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  if (std::abs(turn) <= STRAIGHT * std::sqrt(b2 * c2)) return std::nullopt;
  const double x = (cy * b2 - by * c2) / (2 * turn), y = (bx * c2 - cx * b2) / (2 * turn);
  return Circle{{a[0] + x, a[1] + y}, std::hypot(x, y)};
}

bool is_line(const std::vector<ProfilePoint>& points, std::size_t from, std::size_t to, double tolerance) {
  for (std::size_t k = from + 1; k < to; ++k)
    if (segment_distance(points[from], points[to], points[k]) > tolerance) return false;
  return true;
}

// An arc through the ends and the middle one of the points, along which the height does not fall and the radius is not negative.
std::optional<ProfilePoint> arc_through(const std::vector<ProfilePoint>& points, std::size_t from, std::size_t to,
                                        double tolerance) {
  const ProfilePoint &a = points[from], &b = points[to];
  std::size_t middle = from;  // the point farthest from both ends
  double farthest = 0;
  for (std::size_t k = from + 1; k < to; ++k) {
    const double away =
        std::min(std::hypot(points[k][0] - a[0], points[k][1] - a[1]), std::hypot(points[k][0] - b[0], points[k][1] - b[1]));
    if (away > farthest) farthest = away, middle = k;
  }
  if (middle == from) return std::nullopt;
  if (segment_distance(a, b, points[middle]) < LEAST_SAGITTA) return std::nullopt;
  const std::optional<Circle> circle = circle_through(a, points[middle], b);
  if (!circle || circle->radius > MOST_RADIUS) return std::nullopt;
  const auto cross = [&](const ProfilePoint& p, const ProfilePoint& q) {
    const auto& [x, y] = circle->center;
    return (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x);
  };
  const double sense = cross(a, points[middle]) < 0 ? -1 : 1;
  for (std::size_t k = from + 1; k < to; ++k) {
    const ProfilePoint& p = points[k];
    const double off = std::abs(std::hypot(p[0] - circle->center[0], p[1] - circle->center[1]) - circle->radius);
    // beyond its ends an arc, which is half a circle at most, is as far as the nearer end
    const bool is_beside = sense * cross(a, p) >= 0 && sense * cross(p, b) >= 0;
    const double away = is_beside ? off : std::min(std::hypot(p[0] - a[0], p[1] - a[1]), std::hypot(p[0] - b[0], p[1] - b[1]));
    if (away > tolerance) return std::nullopt;
  }
  // between ends on one side of the circle's upright middle line, the height rises all the way
  const double side = points[middle][0] - circle->center[0];
  const double rounding = 1e-9 * circle->radius;
  for (const ProfilePoint& end : {a, b})
    if ((side > 0 ? end[0] - circle->center[0] : circle->center[0] - end[0]) < -rounding) return std::nullopt;
  if (side < 0 && circle->center[0] - circle->radius < 0 && a[1] < circle->center[1] && b[1] > circle->center[1])
    return std::nullopt;
  return points[middle];
}

// The last point up to which `fits` holds from `from`: by doubling, then halving.
template <class Fits>
std::size_t farthest(std::size_t from, std::size_t last, const Fits& fits) {
  std::size_t good = from + 1, step = 1;
  while (good < last && fits(std::min(last, good + step))) {
    good = std::min(last, good + step);
    step *= 2;
  }
  for (; step > 0; step /= 2)
    if (good + step <= last && fits(good + step)) good += step;
  return good;
}

// A line within the tolerance may cut the corner before its end. If a point near the end has a line that is clearly closer, the line ends there.
std::size_t before_corner(const std::vector<ProfilePoint>& points, std::size_t from, std::size_t to, double tolerance) {
  constexpr double CLOSER = 0.05, NEAR_END = 4;  // of the tolerance
  if (is_line(points, from, to, CLOSER * tolerance)) return to;
  for (std::size_t k = to - 1; k > from; --k) {
    if (std::hypot(points[k][0] - points[to][0], points[k][1] - points[to][1]) > NEAR_END * tolerance) break;
    if (is_line(points, from, k, CLOSER * tolerance)) return k;
  }
  return to;
}

std::string number(double length) { return fmt::format("{}", std::round(1e6 * length) / 1e3 + 0.0); }

std::string pair_text(const ProfilePoint& p) { return "[" + number(p[0]) + ", " + number(p[1]) + "]"; }

}  // namespace

double segment_distance(const ProfilePoint& a, const ProfilePoint& b, const ProfilePoint& p) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], squared = dx * dx + dy * dy;
  const double t = squared > 0 ? std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared, 0.0, 1.0) : 0;
  return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

std::vector<FittedElement> fit_outline(const std::vector<ProfilePoint>& points, double tolerance) {
  std::vector<FittedElement> elements;
  for (std::size_t from = 0; from + 1 < points.size();) {
    const std::size_t last = points.size() - 1;
    const std::size_t by_line = farthest(from, last, [&](std::size_t to) { return is_line(points, from, to, tolerance); });
    const std::size_t by_arc = farthest(from, last, [&](std::size_t to) {
      return to <= by_line || to - from < LEAST_ARC || arc_through(points, from, to, tolerance).has_value();
    });
    const std::optional<ProfilePoint> through =
        by_arc > by_line && by_arc - from >= LEAST_ARC ? arc_through(points, from, by_arc, tolerance) : std::nullopt;
    if (through) {
      elements.push_back({true, *through, points[by_arc]});
      from = by_arc;
    } else {
      from = before_corner(points, from, by_line, tolerance);
      elements.push_back({false, {}, points[from]});
    }
  }
  return elements;
}

std::vector<ProfilePoint> points_along(const ProfilePoint& start, const std::vector<FittedElement>& elements, double sagitta) {
  std::vector<ProfilePoint> points{start};
  for (const FittedElement& element : elements) {
    const ProfilePoint a = points.back();
    const std::optional<Circle> circle = element.is_arc ? circle_through(a, element.through, element.end) : std::nullopt;
    if (circle) {
      const auto angle_of = [&](const ProfilePoint& p) { return std::atan2(p[1] - circle->center[1], p[0] - circle->center[0]); };
      const double from = angle_of(a), half = std::remainder(angle_of(element.through) - from, 2 * PI);
      const double sweep = half + std::remainder(angle_of(element.end) - angle_of(element.through), 2 * PI);
      const int steps = static_cast<int>(std::ceil(std::abs(sweep) * std::sqrt(circle->radius / (8 * sagitta)))) + 1;
      for (int k = 1; k < steps; ++k) {
        const double angle = from + sweep * k / steps;
        points.push_back(
            {circle->center[0] + circle->radius * std::cos(angle), circle->center[1] + circle->radius * std::sin(angle)});
      }
    }
    points.push_back(element.end);
  }
  return points;
}

std::string outline_text(const std::vector<FittedElement>& elements) {
  std::string text = "[";
  for (const FittedElement& element : elements) {
    text += text.size() > 1 ? ", " : "";
    text += element.is_arc ? fmt::format("{{ arc_through = {}, to = {} }}", pair_text(element.through), pair_text(element.end))
                           : fmt::format("{{ line = {} }}", pair_text(element.end));
  }
  return text + "]";
}

}  // namespace wholehand

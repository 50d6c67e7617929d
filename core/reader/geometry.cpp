// SPDX-License-Identifier: MIT
#include "core/reader/geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/scene.h"

namespace wholehand {
namespace {

constexpr double EQUAL_WAYS = 1e-9;   // rad: arcs this near to a half circle have two equal ways
constexpr double ON_ONE_LINE = 1e-9;  // rad: sides of a triangle this near to each other's direction

// Whether a direction from the center lies within an arc's turn.
bool turns_through(const PlaneCurve& arc, double angle) {
  return std::abs(std::remainder(angle - (arc.from + arc.sweep / 2), 2 * PI)) <= std::abs(arc.sweep) / 2;
}

void add(Crossings& crossings, const Point& p) { crossings.points[crossings.count++] = p; }

void cross_lines(const PlaneCurve& first, const PlaneCurve& second, Crossings& crossings) {
  const double ur = first.b[0] - first.a[0], uy = first.b[1] - first.a[1];
  const double vr = second.b[0] - second.a[0], vy = second.b[1] - second.a[1];
  const double turn = ur * vy - uy * vr;
  if (turn == 0) return;  // parallel: if they meet, then at an end
  const double t = ((second.a[0] - first.a[0]) * vy - (second.a[1] - first.a[1]) * vr) / turn;
  add(crossings, {first.a[0] + t * ur, first.a[1] + t * uy});
}

void cross_line_circle(const PlaneCurve& line, const PlaneCurve& arc, Crossings& crossings) {
  const double length = distance(line.a, line.b);
  const double ur = (line.b[0] - line.a[0]) / length, uy = (line.b[1] - line.a[1]) / length;
  const double along = (arc.center[0] - line.a[0]) * ur + (arc.center[1] - line.a[1]) * uy;
  const Point foot{line.a[0] + along * ur, line.a[1] + along * uy};
  const double away = distance(foot, arc.center);
  // a line just beyond the circle still counts at its foot: it may touch
  const double half = std::sqrt(std::max(0.0, (arc.radius - away) * (arc.radius + away)));
  add(crossings, {foot[0] + half * ur, foot[1] + half * uy});
  add(crossings, {foot[0] - half * ur, foot[1] - half * uy});
}

void cross_circles(const PlaneCurve& first, const PlaneCurve& second, Crossings& crossings) {
  const double apart = distance(first.center, second.center);
  if (apart == 0) return;  // one circle, or none meets the other: if the arcs meet, then at an end
  const double ur = (second.center[0] - first.center[0]) / apart, uy = (second.center[1] - first.center[1]) / apart;
  const double along = std::clamp((apart + (first.radius - second.radius) * (first.radius + second.radius) / apart) / 2,
                                  -first.radius, first.radius);
  const double half = std::sqrt(std::max(0.0, (first.radius - along) * (first.radius + along)));
  const Point foot{first.center[0] + along * ur, first.center[1] + along * uy};
  add(crossings, {foot[0] - half * uy, foot[1] + half * ur});
  add(crossings, {foot[0] + half * uy, foot[1] - half * ur});
}

// Nearest point of the supporting line to p; of an arc its center, through which every normal of the circle passes.
Point foot_of(const PlaneCurve& curve, const Point& p) {
  if (curve.is_arc) return curve.center;
  const double length = distance(curve.a, curve.b);
  const double ur = (curve.b[0] - curve.a[0]) / length, uy = (curve.b[1] - curve.a[1]) / length;
  const double along = (p[0] - curve.a[0]) * ur + (p[1] - curve.a[1]) * uy;
  return {curve.a[0] + along * ur, curve.a[1] + along * uy};
}

bool are_apart(const PlaneCurve& first, const PlaneCurve& second, double tolerance) {
  for (const double angle : {0.0, PI / 2}) {
    if (first.extent(angle) + second.extent(angle + PI) < -tolerance) return true;
    if (second.extent(angle) + first.extent(angle + PI) < -tolerance) return true;
  }
  return false;
}

}  // namespace

double PlaneCurve::extent(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  if (is_arc && turns_through(*this, angle)) return center[0] * c + center[1] * s + radius;
  return std::max(a[0] * c + a[1] * s, b[0] * c + b[1] * s);
}

PlaneCurve make_line(const Point& a, const Point& b) {
  PlaneCurve line;
  line.a = a;
  line.b = b;
  return line;
}

std::optional<PlaneCurve> make_arc(const Point& a, const Point& b, const Point& center) {
  PlaneCurve arc{true, a, b, center};
  arc.radius = distance(a, center);
  arc.from = std::atan2(a[1] - center[1], a[0] - center[0]);
  arc.sweep = std::remainder(std::atan2(b[1] - center[1], b[0] - center[0]) - arc.from, 2 * PI);
  if (PI - std::abs(arc.sweep) < EQUAL_WAYS) {
    const double outwards = std::cos(arc.from + PI / 2);  // of the way that turns left
    if (std::abs(outwards) < EQUAL_WAYS) return std::nullopt;
    arc.sweep = outwards > 0 ? PI : -PI;
  }
  return arc;
}

std::optional<PlaneCurve> make_arc_through(const Point& a, const Point& through, const Point& b) {
  const double pr = through[0] - a[0], py = through[1] - a[1], qr = b[0] - a[0], qy = b[1] - a[1];
  const double across = pr * qy - py * qr, p_squared = pr * pr + py * py, q_squared = qr * qr + qy * qy;
  if (!(std::abs(across) > ON_ONE_LINE * std::sqrt(p_squared * q_squared))) return std::nullopt;
  PlaneCurve arc{true, a, b, {}};
  arc.center = {a[0] + (qy * p_squared - py * q_squared) / (2 * across), a[1] + (pr * q_squared - qr * p_squared) / (2 * across)};
  arc.radius = distance(a, arc.center);
  arc.from = std::atan2(a[1] - arc.center[1], a[0] - arc.center[0]);
  arc.sweep = 1;  // to the left, until it is known which way passes the point
  const double to_through = turned_to(arc, through), to_end = turned_to(arc, b);
  arc.sweep = to_through < to_end ? to_end : to_end - 2 * PI;
  return arc;
}

double turned_to(const PlaneCurve& arc, const Point& p) {
  const double left = std::atan2(p[1] - arc.center[1], p[0] - arc.center[0]) - arc.from;
  const double turned = std::fmod(arc.sweep >= 0 ? left : -left, 2 * PI);
  return turned < 0 ? turned + 2 * PI : turned;
}

double distance(const Point& p, const Point& q) { return std::hypot(p[0] - q[0], p[1] - q[1]); }

double distance(const PlaneCurve& curve, const Point& p) {
  const double to_ends = std::min(distance(curve.a, p), distance(curve.b, p));
  if (curve.is_arc) {
    const bool faces = turns_through(curve, std::atan2(p[1] - curve.center[1], p[0] - curve.center[0]));
    return faces ? std::min(to_ends, std::abs(distance(p, curve.center) - curve.radius)) : to_ends;
  }
  const double ur = curve.b[0] - curve.a[0], uy = curve.b[1] - curve.a[1], squared = ur * ur + uy * uy;
  if (squared == 0) return to_ends;
  const double t = ((p[0] - curve.a[0]) * ur + (p[1] - curve.a[1]) * uy) / squared;
  if (t <= 0 || t >= 1) return to_ends;
  return distance(p, {curve.a[0] + t * ur, curve.a[1] + t * uy});
}

// Where the curves do not meet, the least distance is at an end, or perpendicular to both: on a circle at a foot seen from its center.
double distance(const PlaneCurve& first, const PlaneCurve& second) {
  if (meeting_point(first, second, 0, std::nullopt, 0)) return 0;
  double least =
      std::min({distance(second, first.a), distance(second, first.b), distance(first, second.a), distance(first, second.b)});
  for (const auto& [arc, other] : {std::pair{&first, &second}, {&second, &first}}) {
    if (!arc->is_arc) continue;
    const Point foot = foot_of(*other, arc->center);
    const double away = distance(foot, arc->center);
    if (away == 0) continue;  // every point of the arc is as near, and so are its ends
    for (const double side : {1.0, -1.0}) {
      const double share = side * arc->radius / away;
      const Point p{arc->center[0] + share * (foot[0] - arc->center[0]), arc->center[1] + share * (foot[1] - arc->center[1])};
      if (turns_through(*arc, std::atan2(p[1] - arc->center[1], p[0] - arc->center[0])))
        least = std::min(least, distance(*other, p));
    }
  }
  // a crossing that rounding leaves a hair beside one of the two
  const Crossings crossings = support_crossings(first, second);
  for (int i = 0; i < crossings.count; ++i)
    least = std::min(least, distance(first, crossings.points[i]) + distance(second, crossings.points[i]));
  return least;
}

Crossings support_crossings(const PlaneCurve& first, const PlaneCurve& second) {
  Crossings crossings;
  if (first.is_arc && second.is_arc) {
    cross_circles(first, second, crossings);
  } else if (first.is_arc) {
    cross_line_circle(second, first, crossings);
  } else if (second.is_arc) {
    cross_line_circle(first, second, crossings);
  } else {
    cross_lines(first, second, crossings);
  }
  return crossings;
}

// Two curves that meet do so where their supporting line and circle cross or touch, or at an end of one of them.
std::optional<Point> meeting_point(const PlaneCurve& first, const PlaneCurve& second, double tolerance,
                                   const std::optional<Point>& shared, double clearance) {
  if (are_apart(first, second, tolerance)) return std::nullopt;
  const auto lies_on_both = [&](const Point& p) {
    return (!shared || distance(p, *shared) > clearance) && distance(first, p) <= tolerance && distance(second, p) <= tolerance;
  };
  for (const Point& end : {first.a, first.b, second.a, second.b}) {
    if (lies_on_both(end)) return end;
  }
  const Crossings crossings = support_crossings(first, second);
  for (int i = 0; i < crossings.count; ++i) {
    if (lies_on_both(crossings.points[i])) return crossings.points[i];
  }
  return std::nullopt;
}

}  // namespace wholehand

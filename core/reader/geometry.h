// SPDX-License-Identifier: MIT
// Plane geometry of an outline's elements: extent, distance, and where two of them meet. In the unit of its input.
#pragma once

#include <array>
#include <optional>

namespace wholehand {

using Point = std::array<double, 2>;  // r, y

constexpr double SHORTEST_ELEMENT = 1e-3;  // mm
constexpr double TOUCHING = 1e-6;          // mm: elements nearer than this touch

// A line segment or circular arc from a to b.
struct PlaneCurve {
  bool is_arc = false;
  Point a{}, b{}, center{};
  double radius = 0;           // distance of a from the center
  double from = 0, sweep = 0;  // direction of a from the center, and the angle turned on the way to b, rad, to the left positive

  // Largest extent along the direction (cos angle, sin angle).
  double extent(double angle) const;
};

PlaneCurve make_line(const Point& a, const Point& b);

// The shorter way round the center; of two equal ways the one further from the axis r = 0. Nothing if both are also equally far from it: a half
// circle with level ends.
std::optional<PlaneCurve> make_arc(const Point& a, const Point& b, const Point& center);

// The arc from a to b that passes `through`; its sweep may exceed a half turn. Nothing if the three lie on one line.
std::optional<PlaneCurve> make_arc_through(const Point& a, const Point& through, const Point& b);

double distance(const Point& p, const Point& q);
double distance(const PlaneCurve& curve, const Point& p);
double distance(const PlaneCurve& first, const PlaneCurve& second);  // 0 where they meet

// Angle from an arc's start to the direction of p from its center, in the arc's own direction, [0, 2 pi).
double turned_to(const PlaneCurve& arc, const Point& p);

// Where the supporting lines and circles cross. A line or circle that just misses a circle counts at its nearest point, so that rounding loses no
// touching point: the caller checks the points.
struct Crossings {
  std::array<Point, 2> points;
  int count = 0;
};
Crossings support_crossings(const PlaneCurve& first, const PlaneCurve& second);

// A point that lies on both curves to within `tolerance` and is further than `clearance` from `shared`, if there is one.
std::optional<Point> meeting_point(const PlaneCurve& first, const PlaneCurve& second, double tolerance,
                                   const std::optional<Point>& shared, double clearance);

}  // namespace wholehand

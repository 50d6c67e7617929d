// SPDX-License-Identifier: MIT
// Plane geometry of outlines: against closed forms and dense sampling.
#include "core/reader/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/scene.h"

namespace wholehand {
namespace {

Point point_of(const PlaneCurve& curve, double t) {
  if (!curve.is_arc) return {curve.a[0] + t * (curve.b[0] - curve.a[0]), curve.a[1] + t * (curve.b[1] - curve.a[1])};
  const double angle = curve.from + t * curve.sweep;
  return {curve.center[0] + curve.radius * std::cos(angle), curve.center[1] + curve.radius * std::sin(angle)};
}

// A random line or arc with p on it, not at its ends.
PlaneCurve curve_through(std::mt19937& random, const Point& p) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double angle = 2 * PI * uniform(random);
  if (uniform(random) < 0.5) {
    const double before = 1 + 30 * uniform(random), after = 1 + 30 * uniform(random);
    return make_line({p[0] - before * std::cos(angle), p[1] - before * std::sin(angle)},
                     {p[0] + after * std::cos(angle), p[1] + after * std::sin(angle)});
  }
  const double radius = 5 + 30 * uniform(random), before = 0.1 + 1.3 * uniform(random), after = 0.1 + 1.3 * uniform(random);
  const Point center{p[0] - radius * std::cos(angle), p[1] - radius * std::sin(angle)};
  const auto at = [&](double turn) { return Point{center[0] + radius * std::cos(turn), center[1] + radius * std::sin(turn)}; };
  return uniform(random) < 0.5 ? *make_arc(at(angle - before), at(angle + after), center)
                               : *make_arc(at(angle + after), at(angle - before), center);
}

TEST(SceneGeometry, ArcsTakeTheShorterWay) {
  const PlaneCurve arc = *make_arc({1, 0}, {0, 1}, {0, 0});
  EXPECT_DOUBLE_EQ(arc.sweep, PI / 2);
  EXPECT_DOUBLE_EQ(make_arc({0, 1}, {1, 0}, {0, 0})->sweep, -PI / 2);
  const PlaneCurve across = *make_arc({-1, 0.1}, {-1, -0.1}, {0, 0});  // over the angle's cut
  EXPECT_NEAR(across.sweep, 2 * std::atan(0.1), 1e-15);
}

TEST(SceneGeometry, HalfCirclesTakeTheWayFurtherFromTheAxis) {
  EXPECT_DOUBLE_EQ(make_arc({5, 0}, {5, 2}, {5, 1})->sweep, PI);
  EXPECT_DOUBLE_EQ(make_arc({5, 2}, {5, 0}, {5, 1})->sweep, -PI);
  EXPECT_NEAR(make_arc({5, 0}, {5, 2}, {5, 1})->extent(0), 6, 1e-15);
  EXPECT_DOUBLE_EQ(make_arc({4, 0}, {6, 2}, {5, 1})->sweep, PI);  // leaning: below and right
  EXPECT_FALSE(make_arc({4, 1}, {6, 1}, {5, 1}));                 // level: neither is further
}

TEST(SceneGeometry, ExtentIsTheLargestOfItsPoints) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const PlaneCurve curve = curve_through(random, {20, 30});
    for (const double angle : {0.0, PI / 2, PI, -PI / 2, 0.7}) {
      double largest = -1e300;
      for (int k = 0; k <= 2000; ++k) {
        const Point p = point_of(curve, k / 2000.0);
        largest = std::max(largest, p[0] * std::cos(angle) + p[1] * std::sin(angle));
      }
      EXPECT_GE(curve.extent(angle), largest - 1e-12);
      EXPECT_LE(curve.extent(angle), largest + 1e-4);  // sagitta of a step of at most 1.4e-3 rad on a radius of at most 35: 1e-5
    }
  }
}

TEST(SceneGeometry, DistanceIsTheSmallestToItsPoints) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-60, 60);
  for (int i = 0; i < 200; ++i) {
    const PlaneCurve curve = curve_through(random, {0, 0});
    const Point q{place(random), place(random)};
    double smallest = 1e300;
    for (int k = 0; k <= 5000; ++k) smallest = std::min(smallest, distance(q, point_of(curve, k / 5000.0)));
    EXPECT_LE(distance(curve, q), smallest + 1e-12);
    EXPECT_GE(distance(curve, q), smallest - 0.02);  // half a step of at most 62/5000 and the sampling's own error
  }
}

TEST(SceneGeometry, FindsEveryCrossing) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-50, 50);
  for (int i = 0; i < 20000; ++i) {
    const Point p{place(random), place(random)};
    const PlaneCurve first = curve_through(random, p), second = curve_through(random, p);
    const auto meeting = meeting_point(first, second, 1e-6, std::nullopt, 0);
    ASSERT_TRUE(meeting) << i;
    EXPECT_LE(distance(first, *meeting), 1e-6);
    EXPECT_LE(distance(second, *meeting), 1e-6);
  }
}

TEST(SceneGeometry, FindsNothingBetweenCurvesThatAreApart) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-50, 50);
  int apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const PlaneCurve first = curve_through(random, {place(random), place(random)});
    const PlaneCurve second = curve_through(random, {place(random), place(random)});
    double smallest = 1e300;
    for (int k = 0; k <= 400; ++k) smallest = std::min(smallest, distance(second, point_of(first, k / 400.0)));
    if (smallest < 0.2) continue;  // a step is at most 62/400
    ++apart;
    EXPECT_FALSE(meeting_point(first, second, 1e-6, std::nullopt, 0)) << i;
  }
  EXPECT_GT(apart, 500);
}

TEST(SceneGeometry, TouchingIsMeeting) {
  const PlaneCurve circle = *make_arc({10, -10}, {10, 10}, {10, 0});                          // the right half
  EXPECT_TRUE(meeting_point(circle, make_line({20, -50}, {20, 50}), 1e-6, std::nullopt, 0));  // tangent
  EXPECT_TRUE(meeting_point(circle, make_line({20 + 9e-7, -50}, {20 + 9e-7, 50}), 1e-6, std::nullopt, 0));
  EXPECT_FALSE(meeting_point(circle, make_line({20 + 2e-6, -50}, {20 + 2e-6, 50}), 1e-6, std::nullopt, 0));
  EXPECT_FALSE(meeting_point(circle, make_line({0, -50}, {0, 50}), 1e-6, std::nullopt, 0));  // tangent to the other half
  const double c = 10 * std::cos(1.0), d = 10 * std::sin(1.0);
  const PlaneCurve left = *make_arc({30 - c, d}, {30 - c, -d}, {30, 0});  // its leftmost point is (20, 0)
  EXPECT_TRUE(meeting_point(circle, left, 1e-6, std::nullopt, 0));
  EXPECT_FALSE(meeting_point(circle, *make_arc({30 + c, d}, {30 + c, -d}, {30, 0}), 1e-6, std::nullopt, 0));
  EXPECT_TRUE(meeting_point(make_line({0, 0}, {10, 0}), make_line({5, 0}, {15, 0}), 1e-6, std::nullopt, 0));  // overlap
  EXPECT_FALSE(meeting_point(make_line({0, 0}, {10, 0}), make_line({11, 0}, {15, 0}), 1e-6, std::nullopt, 0));
  EXPECT_TRUE(meeting_point(make_line({0, 0}, {10, 0}), make_line({5, 3}, {5, 0}), 1e-6, std::nullopt, 0));  // end on the middle
}

TEST(SceneGeometry, DistanceOfTwoCurvesIsTheSmallestOfTheirPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-50, 50);
  for (int i = 0; i < 500; ++i) {
    const PlaneCurve first = curve_through(random, {place(random), place(random)});
    const PlaneCurve second = curve_through(random, {place(random), place(random)});
    double smallest = 1e300;
    for (int k = 0; k <= 4000; ++k) smallest = std::min(smallest, distance(second, point_of(first, k / 4000.0)));
    const double found = distance(first, second);
    EXPECT_LE(found, smallest + 1e-12) << i;
    EXPECT_GE(found, smallest - 0.02) << i;  // half a step of at most 62/4000
    EXPECT_NEAR(found, distance(second, first), 1e-12) << i;
  }
}

TEST(SceneGeometry, ArcsThroughPointsPassThem) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-50, 50);
  for (int i = 0; i < 2000; ++i) {
    const Point a{place(random), place(random)}, p{place(random), place(random)}, b{place(random), place(random)};
    const auto arc = make_arc_through(a, p, b);
    ASSERT_TRUE(arc) << i;
    if (arc->radius > 1e4) continue;
    EXPECT_LE(distance(point_of(*arc, 0), a) + distance(point_of(*arc, 1), b), 1e-9);  // 1e4 and angles of 1e-15
    EXPECT_LE(distance(*arc, p), 1e-9) << i;
  }
  EXPECT_FALSE(make_arc_through({0, 0}, {1, 1}, {3, 3}));
  EXPECT_NEAR(make_arc_through({1, 0}, {-1, 0}, {0, -1})->sweep, 1.5 * PI, 1e-15);
}

TEST(SceneGeometry, TheSharedEndIsNoMeeting) {
  const Point shared{10, 0};
  const PlaneCurve first = make_line({0, 0}, shared);
  EXPECT_FALSE(meeting_point(first, make_line(shared, {10, 10}), 1e-6, shared, 5e-4));
  EXPECT_FALSE(meeting_point(first, make_line(shared, {20, 0}), 1e-6, shared, 5e-4));             // straight on
  EXPECT_FALSE(meeting_point(first, *make_arc(shared, {20, 10}, {10, 10}), 1e-6, shared, 5e-4));  // tangent
  EXPECT_TRUE(meeting_point(first, make_line(shared, {5, 0}), 1e-6, shared, 5e-4));               // back on itself
  EXPECT_TRUE(meeting_point(first, *make_arc(shared, {4, 0.0}, {7, 1}), 1e-6, shared, 5e-4));     // to another point of the first
  const PlaneCurve arc = *make_arc({0, 0}, shared, {5, 5});
  EXPECT_TRUE(meeting_point(arc, *make_arc(shared, {5, 5 - std::sqrt(50)}, {5, 5}), 1e-6, shared, 5e-4));  // back on its circle
}

}  // namespace
}  // namespace wholehand

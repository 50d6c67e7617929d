// SPDX-License-Identifier: MIT
// Which tangents of an outline support all of it, by brute force over points of the outline.
#include "core/supports.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/prepare.h"
#include "shaders/layout.h"
#include "tests/support/sampled_outline.h"

namespace wholehand {
namespace {

// A record's code gives back what it was made of.
constexpr bool codes_are_distinct() {
  for (int side = -1; side <= 1; ++side)
    for (int supports = 0; supports < 8; ++supports) {
      const int code = ELEMENT_CODE(side, supports);
      if (SIDE_OF(code) != side || SUPPORTS_OF(code) != supports) return false;
    }
  return true;
}
static_assert(codes_are_distinct());

// Lines and arcs are met to some roundings of coordinates below 0.2 m, and tangents by a rounding more of each.
constexpr double COORDINATE_ROUNDING = 1e-12;
constexpr int SAMPLES = 400;

Vec2 place_on(const PreparedElement& e, double share) {
  if (e.side == 0) return {e.a[0] + share * (e.b[0] - e.a[0]), e.a[1] + share * (e.b[1] - e.a[1])};
  const double from = std::atan2(e.a[1] - e.center[1], e.side * (e.a[0] - e.center[0]));
  const double to = std::atan2(e.b[1] - e.center[1], e.side * (e.b[0] - e.center[0]));
  const double angle = from + share * (to - from);
  return {e.center[0] + e.side * e.radius * std::cos(angle), e.center[1] + e.radius * std::sin(angle)};
}

Vec2 normal_on(const PreparedElement& e, double share) {
  if (e.side == 0) return {e.center[0], e.center[1]};
  const Vec2 from_center = (place_on(e, share) - Vec2{e.center[0], e.center[1]}) / e.radius;
  return (e.side > 0) == (e.b[1] > e.a[1]) ? from_center : -from_center;
}

// How far the outline reaches beyond the line through `place` across `normal`, m.
double beyond(const std::vector<Vec2>& points, Vec2 place, Vec2 normal) {
  double furthest = 0;
  for (const Vec2& p : points) furthest = std::max(furthest, glm::dot(normal, p - place));
  return furthest;
}

double beyond_tangents(const std::vector<Vec2>& points, const PreparedElement& element) {
  double furthest = 0;
  const int tangents = element.side == 0 ? 1 : 64;
  for (int k = 0; k <= tangents; ++k) {
    const double share = static_cast<double>(k) / tangents;
    furthest = std::max(furthest, beyond(points, place_on(element, share), normal_on(element, share)));
  }
  return furthest;
}

// An outline, and what is counted over all of them.
struct Count {
  int lines = 0, arcs = 0, unsupporting = 0;
};

void expect_those_of_brute_force(const std::string& name, const std::vector<PreparedElement>& outline, Count& count) {
  std::vector<Vec2> points;
  for (const PreparedElement& element : outline)
    for (int k = 0; k <= SAMPLES; ++k) points.push_back(place_on(element, static_cast<double>(k) / SAMPLES));
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::string which = name + ", element " + std::to_string(i);
    const PreparedElement& element = outline[i];
    const bool supports = (element.supports & SUPPORTS_BETWEEN) != 0;
    // samples are fine enough: what reaches beyond a tangent does so by more than rounding
    const double furthest = beyond_tangents(points, element);
    EXPECT_EQ(supports, furthest <= COORDINATE_ROUNDING) << which << " reaches " << furthest;
    ++(!supports ? count.unsupporting : element.side == 0 ? count.lines : count.arcs);
    if (i + 1 == outline.size()) continue;
    const bool both = supports && (outline[i + 1].supports & SUPPORTS_BETWEEN) != 0;
    EXPECT_EQ((element.supports & SUPPORTS_AT_B) != 0, both) << which;
    EXPECT_EQ((outline[i + 1].supports & SUPPORTS_AT_A) != 0, both) << which;
    if (!both) continue;
    for (int k = 0; k <= 8; ++k) {
      const Vec2 between = glm::mix(normal_on(element, 1), normal_on(outline[i + 1], 0), k / 8.0);
      EXPECT_LE(beyond(points, place_on(element, 1), glm::normalize(between)), COORDINATE_ROUNDING) << which;
    }
  }
}

OutlineElement to(double r, double y) { return {.end = {r, y}}; }
OutlineElement bend(double r, double y, double center_r, double center_y) {
  return {.is_arc = true, .end = {r, y}, .center = {center_r, center_y}};
}

TEST(Supports, AreThoseOfBruteForce) {
  Count count;
  for (const VesselData& data :
       {beaker1(), beaker2(), beaker3(), vase(), ledges(), spindle(), shell_of(beaker1()), shell_of(beaker2()), shell_of(vase())})
    expect_those_of_brute_force(data.name, prepare_vessel(data, data.wall > 0).outline, count);
  EXPECT_GT(count.lines, 8);
  EXPECT_EQ(count.arcs, 0);  // each has something above or below it
  const std::vector<std::pair<std::string, std::vector<OutlineElement>>> rounded{
      {"cup", {bend(0.04, 0.04, 0, 0.04), to(0.04, 0.1), to(0, 0.1)}},
      {"can", {to(0.03, 0), bend(0.04, 0.01, 0.03, 0.01), to(0.04, 0.08), bend(0.03, 0.09, 0.03, 0.08), to(0, 0.09)}},
      {"ball", {bend(0.04, 0.04, 0, 0.04), bend(0, 0.08, 0, 0.04)}},
      {"lens", {bend(0.03, 0.01, 0, 0.05), bend(0, 0.02, 0, -0.03)}},
      {"jar", {to(0.04, 0), to(0.04, 0.06), bend(0.02, 0.08, 0.02, 0.06), to(0.02, 0.1), to(0, 0.1)}},
      {"tube", {to(0.04, 0), bend(0.04, 0.06, 0.07, 0.03), to(0, 0.06)}}};
  for (const auto& [name, outline] : rounded) {
    std::vector<PreparedElement> elements = monotone_elements(outline);
    mark_supports(elements);
    expect_those_of_brute_force(name, elements, count);
  }
  EXPECT_GE(count.arcs, 7);
  EXPECT_GT(count.unsupporting, 20);
}

std::vector<PreparedElement> lines(const std::vector<std::array<double, 2>>& corners) {
  std::vector<OutlineElement> outline;
  for (const auto& corner : corners) outline.push_back({.end = corner});
  std::vector<PreparedElement> elements = monotone_elements(outline);
  mark_supports(elements);
  return elements;
}

std::vector<int> bits(const std::vector<PreparedElement>& elements) {
  std::vector<int> all;
  for (const PreparedElement& element : elements) all.push_back(element.supports);
  return all;
}

constexpr int ALL = SUPPORTS_BETWEEN | SUPPORTS_AT_A | SUPPORTS_AT_B;

TEST(Supports, OfLines) {
  EXPECT_EQ(bits(lines({{3, 0}, {3, 2}, {0, 2}})), (std::vector<int>{ALL, ALL, ALL}));
  // a ledge and a wall above it
  EXPECT_EQ(bits(lines({{3, 0}, {3, 2}, {1, 2}, {1, 8}, {0, 8}})),
            (std::vector<int>{ALL, SUPPORTS_BETWEEN | SUPPORTS_AT_A, 0, 0, SUPPORTS_BETWEEN | SUPPORTS_AT_B}));
  // a spindle: beyond a tip on the axis a cone supports
  EXPECT_EQ(bits(lines({{2, 2}, {0, 4}})), (std::vector<int>{ALL, ALL}));
  // a dish supports in the half plane, but not on the axis, where its normals meet
  EXPECT_EQ(bits(lines({{4, 0}, {4, 4}, {0, 1}})), (std::vector<int>{ALL, ALL, SUPPORTS_BETWEEN | SUPPORTS_AT_A}));
  // a level break in a wall is no corner
  EXPECT_EQ(bits(lines({{3, 0}, {3, 1}, {3, 2}, {0, 2}})), (std::vector<int>{ALL, ALL, ALL, ALL}));
}

}  // namespace
}  // namespace wholehand

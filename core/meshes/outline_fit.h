// SPDX-License-Identifier: MIT
// Fits a half outline of few lines and arcs to the points of a profile.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/scene.h"

namespace wholehand {

using ProfilePoint = std::array<double, 2>;  // (r, y), m

// A line or arc to `end`; an arc passes through `through`.
struct FittedElement {
  bool is_arc = false;
  ProfilePoint through{};
  ProfilePoint end{};
};

// The distance of p from the line between a and b, m.
double segment_distance(const ProfilePoint& a, const ProfilePoint& b, const ProfilePoint& p);

// Elements from the first of at least two points to the last, whose heights do not fall where those of `points` do not. They start and end at points,
// and no point lies further than `tolerance` (m) from them.
std::vector<FittedElement> fit_outline(const std::vector<ProfilePoint>& points, double tolerance);

// Points along the elements from `start`, with arcs in chords that deviate by at most `sagitta`, m.
std::vector<ProfilePoint> points_along(const ProfilePoint& start, const std::vector<FittedElement>& elements, double sagitta);

// The value of `inner_outline` or `outline`: one line of TOML, in mm to a micrometer.
std::string outline_text(const std::vector<FittedElement>& elements);

}  // namespace wholehand

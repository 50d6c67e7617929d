// SPDX-License-Identifier: MIT
// The inner outline of a cavity's profile.
#pragma once

#include <optional>
#include <vector>

#include "core/meshes/outline_fit.h"

namespace wholehand {

// Largest distance, m, that an outline should have from its profile.
constexpr double OUTLINE_TOLERANCE = 0.3e-3;

struct CavityOutline {
  std::vector<FittedElement> elements;  // from (0, 0) of the frame, as `inner_outline`
  double volume = 0;                    // turned about the axis, m3
  double off_profile = 0;               // m: the largest distance of the profile's points from it
};

// An outline of few lines and arcs that is nowhere beyond the profile, except by a micrometer. `profile`: at least two points (r, y), m, whose heights do
// not fall, the first one on the axis. Nothing if a scene cannot hold it (1,000 elements) or none is found.
std::optional<CavityOutline> outline_within(const std::vector<ProfilePoint>& profile);

// Points (r, y) of an outline from the floor on its axis to the brim, m, with arcs in chords that deviate by at most `sagitta`, m.
std::vector<ProfilePoint> points_on(const CavityOutline& outline, double sagitta);

// The distance of a point from the lines between points, m.
double distance_from(const std::vector<ProfilePoint>& points, const ProfilePoint& p);

// How far a point is beyond a profile at its height, or below its floor, m; 0 for within.
double depth_beyond(const std::vector<ProfilePoint>& profile, const ProfilePoint& p);

// The volume of a frustum between two points, turned about the axis, m3.
double frustum_volume(const ProfilePoint& a, const ProfilePoint& b);

}  // namespace wholehand

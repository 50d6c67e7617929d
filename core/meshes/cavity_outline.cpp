// SPDX-License-Identifier: MIT
#include "core/meshes/cavity_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/reader/ranges.h"

namespace wholehand {
namespace {

constexpr double FIT_SHARE =
    1.5e-3;  // of the largest radius: twice that share of a capacity, and as much again for the way out of the glass
constexpr double FIT_SAGITTA = 1e-6;        // m, of the chords in which the fitted outline is compared
constexpr double PROBE_STEP = 0.2e-3;       // m, between the points at which it is compared
constexpr double ROUNDING = 1e-6;           // m: heights and radii are written to that
constexpr std::size_t MANY_ELEMENTS = 200;  // a rougher profile is followed less closely
constexpr int MOST_FITS = 12;
constexpr double SHARPEST_CORNER = 0.2;  // 1 + the cosine between a corner's normals: a sharper corner moves less far
constexpr double MOVED = 0.01;           // of the way: chords of a profile are that inexact

// The profile moved to its left, into the room; where it would come nearer than that to another part of it, points are left out. The axis and the
// height of the brim stay.
std::vector<ProfilePoint> moved_inward(const std::vector<ProfilePoint>& points, double by) {
  const auto left_of = [](const ProfilePoint& a, const ProfilePoint& b) {
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    return length > 0 ? ProfilePoint{(a[1] - b[1]) / length, (b[0] - a[0]) / length} : ProfilePoint{};
  };
  std::vector<ProfilePoint> moved;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ProfilePoint before = k > 0 ? left_of(points[k - 1], points[k]) : left_of(points[0], points[1]);
    const ProfilePoint after = k + 1 < points.size() ? left_of(points[k], points[k + 1]) : before;
    // a corner moves along both of its sides' normals
    const double cosine = 1 + before[0] * after[0] + before[1] * after[1], scale = by / std::max(cosine, SHARPEST_CORNER);
    ProfilePoint p{points[k][0] + scale * (before[0] + after[0]), points[k][1] + scale * (before[1] + after[1])};
    if (k == 0) p = {0, points[0][1] + by / std::max(after[1], SHARPEST_CORNER)};
    if (k + 1 == points.size()) p = {points[k][0] - by / std::max(-before[0], SHARPEST_CORNER), points[k][1]};
    if (p[0] < 0 || p[1] > points.back()[1] || distance_from(points, p) < by * (1 - MOVED)) continue;
    if (!moved.empty() && p[1] < moved.back()[1]) p[1] = moved.back()[1];
    moved.push_back(p);
  }
  return moved;
}

// Points along the lines between corners.
std::vector<ProfilePoint> probes(const std::vector<ProfilePoint>& corners) {
  std::vector<ProfilePoint> points{corners.front()};
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const ProfilePoint &a = corners[k - 1], &b = corners[k];
    const int steps = std::min(1000, static_cast<int>(std::hypot(b[0] - a[0], b[1] - a[1]) / PROBE_STEP)) + 1;
    for (int step = 1; step <= steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      points.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
    }
  }
  return points;
}

CavityOutline finished(const std::vector<ProfilePoint>& profile, const ProfilePoint& start, std::vector<FittedElement> fitted) {
  CavityOutline outline;
  const std::vector<ProfilePoint> points = points_along(start, fitted, FIT_SAGITTA);
  for (std::size_t k = 1; k < points.size(); ++k) outline.volume += frustum_volume(points[k - 1], points[k]);
  for (const ProfilePoint& p : profile) outline.off_profile = std::max(outline.off_profile, distance_from(points, p));
  outline.elements = std::move(fitted);
  if (std::abs(start[1]) > ROUNDING) outline.elements.insert(outline.elements.begin(), FittedElement{false, {}, start});
  return outline;
}

}  // namespace

std::vector<ProfilePoint> points_on(const CavityOutline& outline, double sagitta) {
  std::vector<ProfilePoint> points = points_along({0, 0}, outline.elements, sagitta);
  if (points.size() > 1 && points[1][0] == 0) points.erase(points.begin());  // the way along the axis
  return points;
}

double distance_from(const std::vector<ProfilePoint>& points, const ProfilePoint& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < points.size(); ++k) least = std::min(least, segment_distance(points[k - 1], points[k], p));
  return least;
}

double depth_beyond(const std::vector<ProfilePoint>& profile, const ProfilePoint& p) {
  const auto above =
      std::lower_bound(profile.begin(), profile.end(), p[1], [](const ProfilePoint& one, double y) { return one[1] < y; });
  if (above == profile.end()) return 0;
  if (above == profile.begin()) return p[1] < profile.front()[1] ? distance_from(profile, p) : 0;
  const ProfilePoint &a = *(above - 1), &b = *above;
  const double free = b[1] > a[1] ? a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) : std::max(a[0], b[0]);
  return p[0] > free ? distance_from(profile, p) : 0;  // the way back
}

double frustum_volume(const ProfilePoint& a, const ProfilePoint& b) {
  return PI / 3 * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) * (b[1] - a[1]);
}

// Fits the profile, then the profile moved into the room by as much as the outline before it reached beyond.
std::optional<CavityOutline> outline_within(const std::vector<ProfilePoint>& profile) {
  double widest = 0;
  for (const ProfilePoint& p : profile) widest = std::max(widest, p[0]);
  double inset = 0, tolerance = std::min(OUTLINE_TOLERANCE / 3, FIT_SHARE * widest);
  for (int round = 0; round < MOST_FITS; ++round) {
    std::vector<ProfilePoint> within = inset > 0 ? moved_inward(profile, inset) : profile;
    while (within.size() > 1 && within[1][0] < ROUNDING) within.erase(within.begin());  // it touches the axis at its ends only
    if (within.size() < 2) return std::nullopt;
    within.front()[0] = 0;
    std::vector<FittedElement> fitted = fit_outline(within, tolerance);
    if (fitted.size() > MANY_ELEMENTS && tolerance < OUTLINE_TOLERANCE) {
      tolerance = std::min(2 * tolerance, OUTLINE_TOLERANCE);
      continue;
    }
    double deepest = 0;
    for (const ProfilePoint& p : probes(points_along(within.front(), fitted, FIT_SAGITTA)))
      deepest = std::max(deepest, depth_beyond(profile, p));
    inset += deepest;
    if (deepest > ROUNDING) continue;
    CavityOutline outline = finished(profile, within.front(), std::move(fitted));
    return outline.elements.size() <= ranges::LARGEST_OUTLINE ? std::optional(std::move(outline)) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "evidence/report/guidance_statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/statistics/moments.h"

namespace wholehand {
namespace {

constexpr double FAR_OUTSIDE = 1000;  // m: of every vessel that can be described
constexpr double ON_SURFACE = 1e-9;   // m
constexpr int SURFACE_STEPS = 1000;

// A round number of mm that cuts the distances into at most MOST_DISTANCE_BINS, m.
double bin_width(double nearest, double farthest) {
  for (double decade = 1e-3; decade < 1e9; decade *= 10) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double width = step * decade;
      if (std::floor(farthest / width) - std::floor(nearest / width) < static_cast<double>(MOST_DISTANCE_BINS)) return width;
    }
  }
  return 2 * farthest;
}

std::vector<DistanceBin> bins_of(const std::vector<GuidedGrip>& grips, double nearest, double farthest) {
  const double width = bin_width(nearest, farthest), first = std::floor(nearest / width);
  std::vector<DistanceBin> bins(static_cast<std::size_t>(std::floor(farthest / width) - first) + 1);
  for (std::size_t k = 0; k < bins.size(); ++k) {
    bins[k].from = (first + static_cast<double>(k)) * width;
    bins[k].to = bins[k].from + width;
  }
  for (const GuidedGrip& grip : grips) {
    const double place = std::floor(grip.distance / width) - first;
    DistanceBin& bin = bins[std::min(bins.size() - 1, static_cast<std::size_t>(std::max(0.0, place)))];
    ++bin.grips;
    ++bin.by_fingers[static_cast<std::size_t>(std::clamp(grip.fingers, 0, FINGER_COUNT))];
    for (int j = 0; j < JOINT_COUNT; ++j) bin.touching[j] += grip.touch_mask >> j & 1;
  }
  return bins;
}

double apart(const Triple& a, const Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

}  // namespace

const char* lack_words(Lack lack) {
  switch (lack) {
    case Lack::fewer_than_3:
      return "fewer than three grips";
    case Lack::one_x:
      return "one distance";
    case Lack::one_y:
      return "always the same";
    case Lack::never:
      return "never";
    case Lack::always:
      return "always";
    case Lack::none:
      break;
  }
  return "";
}

GuidanceStatistics guidance_statistics(const std::vector<GuidedGrip>& grips) {
  GuidanceStatistics result;
  result.grips = grips.size();
  if (grips.empty()) return result;
  std::vector<double> distances, fingers;
  for (const GuidedGrip& grip : grips) {
    distances.push_back(grip.distance);
    fingers.push_back(grip.fingers);
  }
  const auto [nearest, farthest] = std::minmax_element(distances.begin(), distances.end());
  result.nearest = *nearest;
  result.farthest = *farthest;
  result.mean_fingers = mean_of(fingers);
  result.fingers = pearson(distances, fingers);
  std::vector<char> touches(grips.size());
  for (int j = 0; j < JOINT_COUNT; ++j) {
    PointTouch& point = result.points[j];
    double sum_touching = 0, sum_free = 0;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      touches[i] = static_cast<char>(grips[i].touch_mask >> j & 1);
      point.touching += touches[i] != 0 ? 1 : 0;
      (touches[i] != 0 ? sum_touching : sum_free) += distances[i];
    }
    point.distance_touching = sum_touching / static_cast<double>(point.touching);
    point.distance_free = sum_free / static_cast<double>(grips.size() - point.touching);
    point.correlation = point_biserial(distances, touches);
  }
  result.bins = bins_of(grips, *nearest, *farthest);
  return result;
}

// Sphere tracing inwards along a level ray. What the ray meets beyond the axis counts too, as for a tip (core/closure.cpp).
Triple guidance_place(const Evaluator& core, std::size_t vessel, const GuidancePoint& point) {
  const Triple out{std::cos(point.azimuth), 0, -std::sin(point.azimuth)};
  double t = FAR_OUTSIDE;
  for (int step = 0; step < SURFACE_STEPS && t > -FAR_OUTSIDE; ++step) {
    const Triple place{t * out[0], point.height, t * out[2]};
    const double distance = core.distance(vessel, place);
    if (std::abs(distance) < ON_SURFACE) return place;
    t -= distance;
  }
  return {0, point.height, 0};
}

double guidance_distance(const Evaluator& core, const Scene& scene, std::size_t vessel, const GripInput& grip,
                         const Triple& midpoint, double gap, const std::vector<Triple>& places) {
  const double c = std::cos(grip.obliquity), scale = scene.hand.scale * grip.hand_scale;
  const Triple along{c * std::cos(grip.azimuth), std::sin(grip.obliquity), -c * std::sin(grip.azimuth)};  // thumb to index
  double least = std::numeric_limits<double>::infinity();
  for (const double side : {-0.5, 0.5}) {
    Triple tip{};
    for (int k = 0; k < 3; ++k) tip[k] = midpoint[k] + side * gap * along[k];
    const double radius = scale * (side < 0 ? scene.hand.fingers[0].radii[3] : scene.hand.fingers[1].radii[4]);
    const Triple normal = core.gradient(vessel, tip);
    Triple contact{};
    for (int k = 0; k < 3; ++k) contact[k] = tip[k] - radius * normal[k];
    for (const Triple& place : places) least = std::min(least, apart(contact, place));
  }
  return least;
}

}  // namespace wholehand

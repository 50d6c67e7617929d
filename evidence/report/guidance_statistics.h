// SPDX-License-Identifier: MIT
// How touching depends on a grip's distance from a guidance point: the paper's Table 1 and Fig. 7, for grips instead of people.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/statistics/correlation.h"
#include "core/evaluator.h"

namespace wholehand {

// Why grips have no correlation, in words; empty if there is one.
const char* lack_words(Lack lack);

// A grip as counted.
struct GuidedGrip {
  double distance = 0;  // from the guidance point, m
  int fingers = 0;      // used, 0..5
  std::uint32_t touch_mask = 0;
};

// One point of the hand.
struct PointTouch {
  std::size_t touching = 0;                         // grips
  double distance_touching = 0, distance_free = 0;  // mean, m; NaN if there is none
  Correlation correlation;                          // of touching with the distance
};

// Grips within an interval of distances [from, to), m.
struct DistanceBin {
  double from = 0, to = 0;
  std::size_t grips = 0;
  std::array<std::size_t, FINGER_COUNT + 1> by_fingers{};
  std::array<std::size_t, JOINT_COUNT> touching{};
};

struct GuidanceStatistics {
  std::size_t grips = 0;
  double nearest = 0, farthest = 0;  // m
  double mean_fingers = 0;
  Correlation fingers;  // of the number of fingers used with the distance
  std::array<PointTouch, JOINT_COUNT> points;
  std::vector<DistanceBin> bins;  // all of one width, a round number of mm, at most MOST_DISTANCE_BINS; empty without grips
};
constexpr std::size_t MOST_DISTANCE_BINS = 12;

GuidanceStatistics guidance_statistics(const std::vector<GuidedGrip>& grips);

// ---- places ----

// The place of a guidance point on a vessel, as in a session (docs/method.md, "Tasks"): where a level line from outside to the axis, at its height
// and azimuth, first meets the vessel; on the axis itself if it meets nothing. Vessel frame, m.
Triple guidance_place(const Evaluator& core, std::size_t vessel, const GuidancePoint& point);

// Distance of a grip from the nearest of the places: from the nearer of its two contacts, on the skin. `midpoint`, `gap`: of the tips.
double guidance_distance(const Evaluator& core, const Scene& scene, std::size_t vessel, const GripInput& grip,
                         const Triple& midpoint, double gap, const std::vector<Triple>& places);

}  // namespace wholehand

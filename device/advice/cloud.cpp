// SPDX-License-Identifier: MIT
#include "device/advice/cloud.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/numbers/sobol.h"

namespace wholehand::device {
namespace {

constexpr std::array<double GripInput::*, 5> PLACES{&GripInput::height, &GripInput::azimuth, &GripInput::obliquity,
                                                    &GripInput::roll, &GripInput::offset};
constexpr std::array<double, 5> SIZES{REACH_HEIGHT, REACH_AZIMUTH, REACH_OBLIQUITY, REACH_ROLL, MOST_OFFSET};

bool is_turned_in_vain(const VesselData& vessel) {
  return !vessel.mesh && vessel.center_of_mass[0] == 0 && vessel.center_of_mass[2] == 0;
}

// The part of the box that lies within `share` of its size about `best`.
Reach about(const Reach& reach, const GripInput& best, double share) {
  Reach part = reach;
  for (std::size_t k = 0; k < PLACES.size(); ++k) {
    const auto place = PLACES[k];
    const double half = share * SIZES[k];
    part.low.*place = std::clamp(best.*place - half, reach.low.*place, reach.high.*place);
    part.high.*place = std::clamp(best.*place + half, reach.low.*place, reach.high.*place);
  }
  return part;
}

GripInput at(const Reach& box, const SobolPoint& point, double hand_scale) {
  GripInput grip;
  for (std::size_t k = 0; k < PLACES.size(); ++k) {
    const auto place = PLACES[k];
    grip.*place = box.low.*place + point[k] * (box.high.*place - box.low.*place);
  }
  grip.hand_scale = hand_scale;
  return grip;
}

}  // namespace

bool Reach::has(const GripInput& grip) const {
  return std::all_of(PLACES.begin(), PLACES.end(),
                     [&](const auto place) { return grip.*place >= low.*place - 1e-12 && grip.*place <= high.*place + 1e-12; });
}

GripInput Reach::with_kept(GripInput grip) const {
  for (const auto place : {&GripInput::azimuth, &GripInput::offset})
    if (low.*place == high.*place) grip.*place = low.*place;
  return grip;
}

Reach reach_of(const VesselData& vessel, const GripInput& present, bool keeps_line) {
  Reach reach{present, present};
  const std::array<double, 5> halves{REACH_HEIGHT, keeps_line || is_turned_in_vain(vessel) ? 0 : REACH_AZIMUTH, REACH_OBLIQUITY,
                                     REACH_ROLL, 0};
  for (std::size_t k = 0; k < PLACES.size(); ++k) {
    reach.low.*PLACES[k] -= halves[k];
    reach.high.*PLACES[k] += halves[k];
  }
  reach.low.height = std::clamp(reach.low.height, vessel.base, vessel.height);
  reach.high.height = std::clamp(reach.high.height, vessel.base, vessel.height);
  reach.low.offset = keeps_line ? 0 : -MOST_OFFSET;
  reach.high.offset = keeps_line ? 0 : MOST_OFFSET;
  return reach;
}

GripInput come_in(const GripInput& present) {
  GripInput grip = present;
  // a line that passes far beside the axis is no intended grip
  if (std::abs(grip.offset) > MOST_OFFSET) grip.offset = 0;
  return grip;
}

double way_between(const GripInput& a, const GripInput& b) {
  double sum = 0;
  for (std::size_t k = 0; k < PLACES.size(); ++k) {
    const double part = (b.*PLACES[k] - a.*PLACES[k]) / SIZES[k];
    sum += part * part;
  }
  return std::sqrt(sum / PLACES.size());
}

std::vector<GripInput> grip_cloud(const Reach& reach, const GripInput& present, const std::optional<GripInput>& best, double share,
                                  std::uint64_t turn, std::size_t count) {
  std::vector<SobolPoint> points(count);
  Sobol(turn).points(0, count, points.data());
  const Reach near = best ? about(reach, *best, share) : reach;
  std::vector<GripInput> grips;
  for (std::size_t k = 0; k < count; ++k) grips.push_back(at(k < count / 2 ? reach : near, points[k], present.hand_scale));
  if (!grips.empty()) grips.front() = come_in(present);
  return grips;
}

}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// The grips to evaluate: points around the hand's present place, and around the best one so far.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/result.h"
#include "core/scene.h"

namespace wholehand::device {

// How far from the present grip an advised one may lie: more would not be a correction of a moving hand (ours).
constexpr double REACH_HEIGHT = 40e-3, MOST_OFFSET = 10e-3;  // m; the offset is from the axis, not from the present one
constexpr double REACH_AZIMUTH = radians(30), REACH_OBLIQUITY = radians(20), REACH_ROLL = radians(40);

// The box of grips within reach. Roll and azimuth are not wrapped.
struct Reach {
  GripInput low, high;
  bool has(const GripInput& grip) const;
  // `grip` with this reach's azimuth and offset, where the reach leaves only one.
  GripInput with_kept(GripInput grip) const;
};

// The reach about `present` on a vessel. Heights stay on the vessel. The azimuth stays if it changes nothing: on a body of revolution whose center of
// mass lies on its axis. The hand keeps its own scale. `keeps_line`: azimuth and an offset of 0 stay, too.
Reach reach_of(const VesselData& vessel, const GripInput& present, bool keeps_line = false);

// `present` with its line brought as near to the axis as the reach allows, as if a hand beside the vessel had moved in.
GripInput come_in(const GripInput& present);

// The distance from a to b, in sizes of the reach: 0 to about 1.
double way_between(const GripInput& a, const GripInput& b);

// `count` grips of the reach: Sobol points shifted by `turn`, so that each update evaluates others, and one turn always gives the same. Half of them
// lie in a box of `share` of the reach about `best`, if there is one; all stay within the reach. The first is the present one, moved in.
std::vector<GripInput> grip_cloud(const Reach& reach, const GripInput& present, const std::optional<GripInput>& best, double share,
                                  std::uint64_t turn, std::size_t count);

}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// The grips that are asked about: points about where the hand is, and about the best one so far.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

// How far from the present grip one may lie that is advised: more is no longer a correction of a hand that is under way (ours).
constexpr double REACH_HEIGHT = 40e-3, MOST_OFFSET = 10e-3;  // m; the offset is from the axis, not from the present one
constexpr double REACH_AZIMUTH = radians(30), REACH_OBLIQUITY = radians(20), REACH_ROLL = radians(40);

// The box of grips within reach. Roll and azimuth are not wrapped.
struct Reach {
  GripInput low, high;
  bool has(const GripInput& grip) const;
  // `grip` with the azimuth and the offset of this reach where it leaves only one.
  GripInput with_kept(GripInput grip) const;
};

// About `present` on a vessel. Heights stay on the vessel. The azimuth stays where it changes nothing: on a body of revolution
// whose center of mass lies on its axis. The hand is the person's own: its scale stays. `keeps_line`: azimuth and an offset of 0
// stay, too.
Reach reach_of(const VesselData& vessel, const GripInput& present, bool keeps_line = false);

// `present` with its line brought as near to the axis as the reach goes: the hand that is beside a vessel as if it had come in.
GripInput come_in(const GripInput& present);

// How far b lies from a, in sizes of the reach: 0 to about 1.
double way_between(const GripInput& a, const GripInput& b);

// `count` grips of the reach: Sobol points, shifted by `turn`, so that each update asks about others, and the same turn asks the
// same. Half of them lie in a box of `share` of the reach about `best` where there is one; all stay within the reach. The first is
// the present one, come in.
std::vector<GripInput> grip_cloud(const Reach& reach, const GripInput& present, const std::optional<GripInput>& best, double share,
                                  std::uint64_t turn, std::size_t count);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Detects that a search found its best at an end of its range.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

// The key of a scene's [grips] that an axis comes from: "roll_deg", "height_fraction".
std::string axis_key(const PlanAxis& axis);

// Keys of the axes at whose smallest or largest value the best of a vessel's grips lies, where the range may cut off better ones. `best`: the best
// first. If several grips are equally good, all must lie at ends of the axis. A Sobol point lies at an end if the nearest value of a grid of as many
// grips would. Not named: an axis of one value, full turns of azimuth and roll, azimuth for bodies of revolution, the vessel's ends (height at lowest
// point or mouth, obliquity at 90 degrees), and hand_scale, which belongs to the person.
std::vector<std::string> edge_axes(const Scene& scene, const Plan& plan, std::size_t vessel, const std::vector<Candidate>& best);

// "the best lies on the edge of roll_deg; widen it?"; empty if no axis is named.
std::string edge_line(const std::vector<std::string>& axes);

}  // namespace wholehand::sweeps

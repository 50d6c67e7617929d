// SPDX-License-Identifier: MIT
// Which tilts of a scene count: `[tilts] until_poured` leaves out those after the first at which that share of the fill has poured.
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene.h"

namespace wholehand {

// The number of the scene's tilts that count, from the first on, at each of `fills` (fractions of the vessel's capacity): those up to the first at
// which `until_poured` of the fill has poured. All tilts count in a scene without `until_poured`, for an empty fill, and for a vessel without liquid.
// Computed in double for every evaluator, so that all leave out the same states. Throws as prepare_vessel.
std::vector<std::size_t> counted_tilts(const Scene& scene, std::size_t vessel, const std::vector<double>& fills);
// The same at the scene's own fills; without liquid, at the fill 0.
std::vector<std::size_t> counted_tilts(const Scene& scene, std::size_t vessel);
// The last counted tilt at each fill, rad: a grip that is safe at all tilts is safe up to it. Empty in a scene without tilts.
std::vector<double> last_tilts(const Scene& scene, std::size_t vessel);

}  // namespace wholehand

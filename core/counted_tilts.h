// SPDX-License-Identifier: MIT
// Which tilts of a scene count: `[tilts] until_poured` leaves out those beyond the one at which a share of the fill is out.
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene.h"

namespace wholehand {

// How many of the scene's tilts count, from the first on, at each of `fills` (fractions of the vessel's capacity): those up to the
// first at which `until_poured` of the fill has poured. All of them in a scene without `until_poured`, for an empty fill, and of a
// vessel that holds no liquid. In double for whatever evaluates the scene, so that all leave out the same states. Throws as
// prepare_vessel.
std::vector<std::size_t> counted_tilts(const Scene& scene, std::size_t vessel, const std::vector<double>& fills);
// At the scene's own fills; of a scene without liquid, at the one that it has.
std::vector<std::size_t> counted_tilts(const Scene& scene, std::size_t vessel);
// The last of those tilts at each fill, rad: a grip that is safe at all of them is safe up to it. Empty in a scene without tilts.
std::vector<double> last_tilts(const Scene& scene, std::size_t vessel);

}  // namespace wholehand

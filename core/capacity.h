// SPDX-License-Identifier: MIT
// A vessel's capacity when upright, and the narrow place of its cavity. Both depend only on the cavity; plain doubles. Not for use in a tick.
#pragma once

#include <optional>

#include "core/scene.h"

namespace wholehand {

// m3 up to the brim; 0 without a cavity. A mesh need not have been read. Throws Error (usage) for what prepare_cavity refuses.
double capacity_of(const VesselData& vessel);

// The narrowest place of a cavity that is wider both above and below it, such as a stem between bowl and foot.
struct Narrow {
  double height = 0, radius = 0;  // m
  double beneath = 0;             // m3 of the cavity
};

// The narrow place with a radius below `limit`, if there is one. Throws as capacity_of.
std::optional<Narrow> narrow_place(const VesselData& vessel, double limit);

}  // namespace wholehand

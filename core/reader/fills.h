// SPDX-License-Identifier: MIT
// Liquid in mL as a fraction of what a vessel holds.
#pragma once

#include <string>

#include "core/scene.h"

namespace wholehand {

// `volume` over `capacity`, m3. Throws Error (usage) if the vessel holds less, with `asked`: the request and its place.
double fraction_of_capacity(const VesselData& vessel, double capacity, double volume, const std::string& asked);

}  // namespace wholehand

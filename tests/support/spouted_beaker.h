// SPDX-License-Identifier: MIT
// A beaker whose rim is pulled outward and down to a spout.
#pragma once

#include <string>

#include "tests/support/vessel_model.h"

namespace wholehand {

VesselModel spouted_beaker(const std::string& name);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Pictures of where a rendered wall settles.
#pragma once

#include <string>
#include <vector>

#include "device/loop/wall_sweep.h"

namespace wholehand {

// Pictures as text: rates, damping, delay and encoder; and integrators.
std::string wall_picture(const std::vector<device::WallSheet>& sheets);
std::string integrator_picture(const std::vector<device::WallSheet>& sheets);

}  // namespace wholehand

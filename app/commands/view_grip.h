// SPDX-License-Identifier: MIT
// What `wholehand grip --view` shows. A build without the viewer has no view_grip.
#pragma once

#include <cstddef>

#include "core/scene.h"
#include "sweeps/grips/report.h"

namespace wholehand {

// Shows one grip in the browser until a signal. `port`: 0 is any free port. The address goes to standard error if standard output has JSON.
void view_grip(const Scene& scene, std::size_t vessel, const GripInput& grip, const std::string& label,
               const sweeps::StateAxes& axes, int port, bool has_json);

}  // namespace wholehand

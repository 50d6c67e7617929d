// SPDX-License-Identifier: MIT
// A left hand, as a right one in a mirrored scene.
#pragma once

#include "core/prepared.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

// A left hand is the right hand in the scene mirrored in x: the grip of that mirrored scene, and a point mirrored back.
GripInput mirrored(const GripInput& grip, Handedness handedness);
Triple mirrored(const Triple& point, Handedness handedness);
PreparedGrid mirrored(const PreparedGrid& grid, Handedness handedness);

}  // namespace wholehand

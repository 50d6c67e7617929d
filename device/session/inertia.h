// SPDX-License-Identifier: MIT
// Inertia of an empty vessel, for motion in the fingers.
#pragma once

#include "core/liquid.h"
#include "core/prepared.h"
#include "core/real.h"
#include "core/scene.h"
#include "core/sdf.h"

namespace wholehand::device {

// About the center of the wall, vessel frame in the world of the right hand, kg m2; the wall is uniform and has `vessel`'s mass. A mesh whose
// triangles bound no volume counts as the solid cylinder around it.
core_f64::Mat3 wall_inertia(const PreparedVessel& prepared, const VesselData& data, const core_f64::Vessel& vessel,
                            const core_f64::Quadrature& quadrature, Handedness handedness);

}  // namespace wholehand::device

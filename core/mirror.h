// SPDX-License-Identifier: MIT
// A left hand, as a right one in a mirrored scene.
#pragma once

#include "core/prepared.h"
#include "core/result.h"
#include "core/vectors.h"

namespace wholehand {

// A left hand is the right hand in the scene mirrored in x: the grip of that mirrored scene, and a point mirrored back. A rotation R
// becomes M R M with M = diag(-1, 1, 1). The same both ways.
GripInput mirrored(const GripInput& grip, Handedness handedness);
Triple mirrored(const Triple& point, Handedness handedness);
glm::dvec3 mirrored(const glm::dvec3& point, Handedness handedness);
glm::dmat3 mirrored(const glm::dmat3& rotation, Handedness handedness);
PreparedLattice mirrored(const PreparedLattice& lattice, Handedness handedness);

}  // namespace wholehand

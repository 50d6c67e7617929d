// SPDX-License-Identifier: MIT
// Treats a left hand as a right hand in a mirrored scene.
#pragma once

#include "core/prepared.h"
#include "core/result.h"
#include "core/vectors.h"

namespace wholehand {

// A left hand is the right hand in the scene mirrored in x. Converts a grip to that mirrored scene, and a point back. A rotation R becomes M R M with
// M = diag(-1, 1, 1). Each conversion is its own inverse.
GripInput mirrored(const GripInput& grip, Handedness handedness);
Triple mirrored(const Triple& point, Handedness handedness);
glm::dvec3 mirrored(const glm::dvec3& point, Handedness handedness);
glm::dmat3 mirrored(const glm::dmat3& rotation, Handedness handedness);
PreparedLattice mirrored(const PreparedLattice& lattice, Handedness handedness);

}  // namespace wholehand

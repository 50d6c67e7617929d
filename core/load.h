// SPDX-License-Identifier: MIT
// Prepared scenes in the kernels' own precision.
#pragma once

#include <vector>

#include "core/effort.h"
#include "core/force.h"
#include "core/hand.h"
#include "core/liquid.h"
#include "core/prepared.h"
#include "core/result.h"
#include "core/sdf.h"

namespace CORE_NS {

Hand load_hand(const wholehand::PreparedHand& prepared, const wholehand::HandData& data);
Quadrature load_quadrature(const wholehand::PreparedQuadrature& prepared);
Element load_element(const wholehand::PreparedElement& element);
// Signed volume of revolution under an element, pi int r^2 dy from a to b, and its first moment by y (volume m3, height m4).
Slices revolved_element(const Quadrature& quadrature, const Element& element);

// `density` of the glass or its given mass; lip capacities at whole degrees where `with_liquid` and there is a cavity. The center of mass is mirrored
// in x
// for a left hand.
Vessel load_vessel(const wholehand::PreparedVessel& prepared, const wholehand::VesselData& data, const Quadrature& quadrature,
                   bool with_liquid, wholehand::Handedness handedness);

// The samples are shared, not copied.
Lattice load_lattice(const wholehand::PreparedLattice& prepared);

// Puts the lattice in the outline's place: no lid, and the distance is the lattice's.
void use_lattice(Vessel& vessel, Lattice lattice);

// The arm of who takes a vessel; without azimuths where the scene has none.
Arm load_arm(const wholehand::Scene& scene, const wholehand::VesselData& data);

// The scene's force constants for a vessel; `reference` is filled by the caller.
ForceScale load_force(const wholehand::Scene& scene, const wholehand::VesselData& data);

// Strength of a hand of a scale (the scene's own included) with the middles of the tips of thumb and index finger `gap` apart, m. None
// where the scene has no strength.
HandStrength load_strength(const wholehand::Scene& scene, Real gap, Real scale);
// The same for a hand that holds.
HandStrength load_strength(const wholehand::Scene& scene, const wholehand::GripResult& held);

}  // namespace CORE_NS

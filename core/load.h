// SPDX-License-Identifier: MIT
// Converts prepared scenes to the kernels' precision.
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

// `density` of the glass or its given mass; lip capacities at whole degrees, if `with_liquid` and there is a cavity. A left hand mirrors the center
// of mass in x.
Vessel load_vessel(const wholehand::PreparedVessel& prepared, const wholehand::VesselData& data, const Quadrature& quadrature,
                   bool with_liquid, wholehand::Handedness handedness);

// Shares the samples instead of copying them.
Lattice load_lattice(const wholehand::PreparedLattice& prepared);

// Replaces the outline by the lattice: no lid, and the distance comes from the lattice.
void use_lattice(Vessel& vessel, Lattice lattice);

// The arm of the person who takes a vessel; without azimuths if the scene has none.
Arm load_arm(const wholehand::Scene& scene, const wholehand::VesselData& data);

// The scene's force constants for a vessel; `reference` is filled by the caller.
ForceScale load_force(const wholehand::Scene& scene, const wholehand::VesselData& data);

// Strength of a hand of a scale (including the scene's own) with the middles of the tips of thumb and index finger `gap` apart, m. A scene without
// strength gives none.
HandStrength load_strength(const wholehand::Scene& scene, Real gap, Real scale);
// The same for a hand that holds.
HandStrength load_strength(const wholehand::Scene& scene, const wholehand::GripResult& held);

}  // namespace CORE_NS

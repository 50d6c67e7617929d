// SPDX-License-Identifier: MIT
// From a scene to what the kernels need, in plain doubles: outlines split into y-monotone elements, the cavity as the inner offset of
// the outline, the shell, bounding spheres, the hand's frames and the table of its gap. Done once a scene, off the tick path.
#pragma once

#include <vector>

#include "core/prepared.h"
#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// Splits arcs at the poles of their circles, so that y is monotone along each element.
std::vector<PreparedElement> monotone_elements(const std::vector<OutlineElement>& outline);

// The inner wall: where the distance to the outline without its mouth equals `wall`, from the vessel's `floor`, or where the wall leaves
// room, to the mouth. Throws Error (usage) with the vessel's name where the wall leaves no cavity, fills it above the floor, closes it half
// way up, or makes it fold over itself.
std::vector<PreparedElement> inner_offset(const std::vector<PreparedElement>& hull, double wall, const VesselData& vessel);

// The cavity of an inner outline; its level elements, which hold nothing, are left out.
std::vector<PreparedElement> inner_cavity(const std::vector<OutlineElement>& inner);

// What a vessel with a cavity holds, by its inner outline or its wall; a mesh need not have been read. Throws as inner_offset.
std::vector<PreparedElement> prepare_cavity(const VesselData& vessel);

// A mesh has neither hull nor outline: its distance is its body's lattice. Throws Error: (usage) for what inner_offset refuses, (failure)
// for a mesh that has not been read.
PreparedVessel prepare_vessel(const VesselData& vessel, bool needs_cavity);

// Throws Error (usage) where the gap is not strictly decreasing at 1,025 equal steps of the closure, naming where it turns.
PreparedHand prepare_hand(const HandData& hand, int gap_entries = GAP_TABLE_SIZE);

// A closure up to which the gap falls, of those steps: 1 where it falls all the way, and 0 where not even at the start.
double gap_falls_until(const HandData& hand);

// Largest radius on an element, m: that of an arc's circle only where the arc reaches it.
double widest_on(const PreparedElement& element);

// Samples of the distance to the vessel's outline, taken in double, `samples` along the longest side; the lattice reaches `margin` (m) and
// two cells beyond the vessel. Stored with 32 bits each or with 16 (`halves`).
PreparedLattice prepare_lattice(const PreparedVessel& vessel, int samples, bool halves, double margin = 0);

// Standard deviations that none of [robust] goes beyond: the middle of the first of 2^32 cells has a normal quantile of -6.34.
constexpr double FURTHEST_DEVIATION = 6.4;

// The margin with which a lattice holds every point of the scene's hand whose skin is within LATTICE_BAND of a vessel: beyond it
// only a bound of the distance is known.
constexpr double LATTICE_BAND = 1e-3;  // m
double lattice_margin(const Scene& scene);

PreparedQuadrature prepare_quadrature(int points);

}  // namespace wholehand

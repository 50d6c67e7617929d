// SPDX-License-Identifier: MIT
// Converts a scene to what the kernels need, in plain doubles: outlines split into y-monotone elements, the cavity as the inner offset of the
// outline, the shell, bounding spheres, the hand's frames and the table of its gap. Runs once per scene, outside the tick.
#pragma once

#include <vector>

#include "core/prepared.h"
#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// Splits arcs at the poles of their circles, so that y is monotone along each element.
std::vector<PreparedElement> monotone_elements(const std::vector<OutlineElement>& outline);

// The inner wall: the points at distance `wall` from the outline without its mouth, from the vessel's `floor`, or where the wall leaves room, to the
// mouth. Throws Error (usage) with the vessel's name if the wall leaves no cavity, fills it above the floor, closes it half way up, or makes it fold
// over itself.
std::vector<PreparedElement> inner_offset(const std::vector<PreparedElement>& hull, double wall, const VesselData& vessel);

// The cavity of an inner outline, without its level elements, which hold nothing.
std::vector<PreparedElement> inner_cavity(const std::vector<OutlineElement>& inner);

// What a vessel with a cavity holds, by its inner outline or its wall; a mesh need not have been read. Throws as inner_offset.
std::vector<PreparedElement> prepare_cavity(const VesselData& vessel);

// A mesh has neither hull nor outline: its distance is its body's lattice. Throws Error: (usage) for what inner_offset refuses, (failure)
// for a mesh that has not been read.
PreparedVessel prepare_vessel(const VesselData& vessel, bool needs_cavity);

// Throws Error (usage), naming the closure, if the gap does not strictly decrease at 1,025 equal steps of the closure.
PreparedHand prepare_hand(const HandData& hand, int gap_entries = GAP_TABLE_SIZE);

// The last of those steps up to which the gap falls: 1 if it falls all the way, 0 if not even at the start.
double gap_falls_until(const HandData& hand);

// Largest radius on an element, m; an arc reaches its circle's largest only if it contains that point.
double widest_on(const PreparedElement& element);

// Samples of the distance to the vessel's outline, in double, `samples` along the longest side; the lattice extends `margin` (m) and two cells beyond
// the vessel. Stored with 32 bits each, or 16 (`halves`).
PreparedLattice prepare_lattice(const PreparedVessel& vessel, int samples, bool halves, double margin = 0);

// No deviation of [robust] exceeds this many standard deviations: the middle of the first of 2^32 cells has a normal quantile of -6.34.
constexpr double FURTHEST_DEVIATION = 6.4;

// The margin with which a lattice covers every point of the scene's hand whose skin is within LATTICE_BAND of a vessel. Beyond it, only a bound of
// the distance is known.
constexpr double LATTICE_BAND = 1e-3;  // m
double lattice_margin(const Scene& scene);

PreparedQuadrature prepare_quadrature(int points);

}  // namespace wholehand

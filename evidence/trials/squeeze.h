// SPDX-License-Identifier: MIT
// The forces with which a hand presses on what it holds: those of kernel 10, with a margin against slipping if strength allows.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/effort.h"

namespace wholehand {

// People press more than what just holds. The forces are computed for a reduced friction: the smallest of these shares of the real one at which
// `squeeze` times the effort is within the strength.
constexpr std::array<double, 6> FRICTION_SHARES{0.5, 0.6, 0.7, 0.8, 0.9, 1};

struct Squeeze {
  std::vector<core_f64::ContactForce> forces;  // one for each contact, on the vessel
  double friction = 0;                         // with which they were found
  double effort = 0;                           // at that friction; infinite if no friction up to 10 holds the load
};

// The forces against `load`, times `squeeze`, but never more than the strength. A load beyond the strength gets all of it. A load that is not
// resisted at the contacts' own friction gets the forces that would hold it at the least larger friction that suffices; if none does, it gets a
// quarter of each digit's strength along the normals.
Squeeze squeeze_forces(std::span<const core_f64::ContactPoint> contacts, const core_f64::HandStrength& hand,
                       const core_f64::Wrench& load, double squeeze);

}  // namespace wholehand

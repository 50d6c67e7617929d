// SPDX-License-Identifier: MIT
// Checks the planes of either twin against docs/method.md, "Values that are absent".
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/planes.h"

namespace wholehand {

// The number of values that violate the table, and the first of them.
struct Misplaced {
  std::uint64_t count = 0;
  int field = -1;  // FIELD_*
  int plane = 0;   // within the field
  std::size_t grip = 0;
  double value = 0;
};

// Checks the planes of `count` grips of a vessel: every kept field of `fields` (at least FIELD_STATUS), in planes of `stride`. Feasible grips have
// finite values, except an infinite hold force, an absent safe tilt and the NaN of states that the scene leaves out. Infeasible ones have NaN, zeros
// in score and terms, and gap, midpoint and t from REASON_TOO_WIDE on. An infinite hold force needs a pinch that is not antipodal, a scene without
// friction or torsion, or `overflows` (forces may exceed the largest number).
Misplaced misplaced_values(const Scene& scene, std::size_t vessel, const FieldSet& fields, std::size_t count, std::size_t stride,
                           const double* reals, const std::uint32_t* uints, bool overflows = false);

// One line for people with the value's field, plane and grip. Empty if there is no violation.
std::string describe(const Misplaced& misplaced);

}  // namespace wholehand

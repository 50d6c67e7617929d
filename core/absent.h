// SPDX-License-Identifier: MIT
// Where values must be there: docs/method.md, "Values that are absent", as a check on planes of either twin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/planes.h"

namespace wholehand {

// Values that break the table, and the first of them.
struct Misplaced {
  std::uint64_t count = 0;
  int field = -1;  // FIELD_*
  int plane = 0;   // within the field
  std::size_t grip = 0;
  double value = 0;
};

// Goes through the planes of `count` grips of a vessel that are held: every kept field of `fields` (at least FIELD_STATUS), planes
// of `stride`. Feasible grips have finite values everywhere but for an infinite hold force, an absent safe tilt and the NaN of
// states that the scene leaves out. Infeasible ones have NaN, zeros in score and terms, and gap, midpoint and t from
// REASON_TOO_WIDE on. An infinite hold force needs a pinch that is not antipodal or a scene without friction or torsion, or
// `overflows`: forces may pass the largest number.
Misplaced misplaced_values(const Scene& scene, std::size_t vessel, const FieldSet& fields, std::size_t count, std::size_t stride,
                           const double* reals, const std::uint32_t* uints, bool overflows = false);

// One line for people: which field, plane and grip, and the value. Empty where nothing is misplaced.
std::string describe(const Misplaced& misplaced);

}  // namespace wholehand

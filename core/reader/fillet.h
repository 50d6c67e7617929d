// SPDX-License-Identifier: MIT
// A fillet: an arc that replaces a corner and joins both elements smoothly.
#pragma once

#include <optional>

#include "core/reader/geometry.h"

namespace wholehand {

// The shortened two elements of a corner, and the arc between them.
struct Fillet {
  PlaneCurve first, arc, second;
};

// How two elements meet: +1 the second turns left of the first's end, -1 right, 0 it runs straight on or straight back.
int corner_turn(const PlaneCurve& first, const PlaneCurve& second);

// The fillet of `radius` at the corner where `first` ends and `second` begins; nothing if none touches both.
std::optional<Fillet> make_fillet(const PlaneCurve& first, const PlaneCurve& second, double radius);

// The largest radius up to `radius` that fits, rounded down to a millionth of the unit; 0: none does.
double largest_fillet(const PlaneCurve& first, const PlaneCurve& second, double radius);

}  // namespace wholehand

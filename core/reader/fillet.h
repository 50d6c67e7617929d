// SPDX-License-Identifier: MIT
// A fillet: the arc that takes a corner's place and runs on from one element and into the next without a bend.
#pragma once

#include <optional>

#include "core/reader/geometry.h"

namespace wholehand {

// What is left of the two elements of a corner, and the arc between them.
struct Fillet {
  PlaneCurve first, arc, second;
};

// How two elements meet: +1 the second turns to the left of the first's end, -1 to its right, 0 it runs straight on or straight back.
int corner_turn(const PlaneCurve& first, const PlaneCurve& second);

// The fillet of `radius` at the corner that `first` ends and `second` begins at; nothing where none touches both.
std::optional<Fillet> make_fillet(const PlaneCurve& first, const PlaneCurve& second, double radius);

// The largest of the radii up to `radius` that fits, rounded down to a millionth of the unit; 0: none does.
double largest_fillet(const PlaneCurve& first, const PlaneCurve& second, double radius);

}  // namespace wholehand

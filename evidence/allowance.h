// SPDX-License-Identifier: MIT
// What may differ between two evaluations that are both right: numbers by rounding, and outcomes in how many grips.
#pragma once

#include <cstdint>

#include "core/backend.h"

namespace wholehand {

// Which precision's rounding and stop tolerance the two sides have: the coarser of the two.
struct Allowance {
  double epsilon = 0;          // of the reals
  double stop_tolerance = 0;   // m
  double level_tolerance = 0;  // of the capacity
  // Both sides stop at that tolerance. Where one goes on to a finer one, it may spend its steps on a corner of a lattice that the other
  // was done with: which side took all of them is then no outcome.
  bool same_stop = true;
};
Allowance allowance(Precision precision);
// Float on one side, double on the other.
Allowance float_against_double();

// Within the margin, discrete outcomes may differ in FLIP_SHARE of the grips in the long run. A sample speaks against that where so many
// that differ, or more, would come up in less than FLIP_SIGNIFICANCE of all samples if the share were just that. Strict, since grips beside
// each other differ together, and since a check judges up to three comparisons and must not fail by chance.
constexpr double FLIP_SHARE = 1e-3;
constexpr double FLIP_SIGNIFICANCE = 1e-6;
// How many of so many compared grips may differ: 1 of 1, 3 of 72, 6 of 400, 10 of 1,536, 18 of 4,608.
std::uint64_t allowed_flips(std::uint64_t grips);

}  // namespace wholehand

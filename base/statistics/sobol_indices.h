// SPDX-License-Identifier: MIT
// Finds which input of a model affects its output most.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/statistics/interval.h"

namespace wholehand {

// The first-order index of an input: the share of the output's variance that vanishes on average when this input is known.
struct SensitivityIndex {
  double first = 0;
  Interval interval;  // of 95 %
};

// By Saltelli et al. 2010 (Comput. Phys. Commun. 181:259, Table 2 b): with two unrelated samples of the inputs A and B of the
// same number of rows, `a` and `b` are the model's answers to their rows, and mixed[i] those to the rows of A with input i taken
// from B:
//     V_i = mean of b (mixed_i - a)        S_i = V_i / V, V the variance of all of a and b
// The mean of a and b is subtracted first, which leaves V_i as it is and its error small. All have the same size, at least 2. The
// interval is a bootstrap's over the rows. Indices are 0, with no interval, where the answer does not vary by more than rounding.
std::vector<SensitivityIndex> first_order_indices(std::span<const double> a, std::span<const double> b,
                                                  std::span<const std::vector<double>> mixed, int resamples, std::uint64_t seed);

}  // namespace wholehand

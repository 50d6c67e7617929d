// SPDX-License-Identifier: MIT
// Finds which inputs of a model affect its outputs most, from one existing sample.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/statistics/sobol_indices.h"

namespace wholehand {

// First-order indices S_i = Var(E[Y | X_i]) / Var(Y) of every answer Y and every input X_i, from entries that come one by one: none
// of them is kept. The inputs must be independent of each other and uniform in (0, 1). After Plischke, Borgonovo & Smith 2013 (Eur.
// J. Oper. Res. 226:536): each input is cut into bins, and the means of the answers in the bins take the place of E[Y | X_i]. Noise
// makes these means differ too. Its part is subtracted (epsilon squared, Kelley 1935):
//     S_i = (SS_between - (bins - 1) MS_within) / SS_total
// The estimate may therefore be below 0. What an input does within a bin is not seen: an answer that is a line in the input loses
// 1 / 256 of its index, and a sine loses 5 % where 8 bins are one period.
//
// The interval of 95 % is a delete-a-group jackknife's: the values of an answer are dealt to 20 groups in turn, the index is found
// without each group, and Student's t has 19 degrees of freedom. The interval is rather too wide for an input without influence.
//
// The same entries in the same order give the same bits.
class GivenDataIndices {
 public:
  static constexpr std::size_t BINS = 16, GROUPS = 20;
  static constexpr std::size_t LEAST_VALUES = 10 * BINS;  // of an output: means of fewer are mostly noise

  GivenDataIndices(std::size_t inputs, std::size_t outputs);

  // Adds one entry: that many inputs in [0, 1], and outputs. Only an output that is not finite is skipped.
  void add(std::span<const double> inputs, std::span<const double> outputs);

  std::size_t inputs() const { return inputs_; }
  std::size_t outputs() const { return outputs_.size(); }
  // Entries that have this output.
  std::size_t values(std::size_t output) const { return outputs_[output].values; }

  // NaN if the output has fewer than LEAST_VALUES values. 0 without an interval if the output does not vary by more than rounding
  // (base/statistics/moments.h).
  SensitivityIndex first_order(std::size_t output, std::size_t input) const;

 private:
  // Taken about the output's first value, so that a large mean does not cost digits of the differences.
  struct Sums {
    double count = 0, sum = 0;
  };
  struct Totals {
    double count = 0, sum = 0, squares = 0;
  };
  struct Output {
    std::size_t values = 0;
    double first = 0, low = 0, high = 0;
    std::array<Totals, GROUPS> groups{};
  };
  using Bins = std::array<Sums, BINS>;

  static double index_of(const Bins& bins, const Totals& all, double rounding);

  std::size_t inputs_;
  std::vector<Output> outputs_;
  std::vector<std::array<Bins, GROUPS>> bins_;  // input after input of each output
};

}  // namespace wholehand

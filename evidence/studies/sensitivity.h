// SPDX-License-Identifier: MIT
// Which input of a person affects each output of a study most.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/statistics/given_data_indices.h"
#include "evidence/studies/row.h"

namespace wholehand {

// The prefix of such a row's statistic; the name of the output follows.
inline constexpr const char* FIRST_ORDER_OF = "first_order_of_";

// A row for each input of each output: the output in the statistic, the input as the subject, no pose, and ALL_VESSELS. There are as many names as
// `indices` has inputs (person_input_names) and outputs.
std::vector<StudyRow> sensitivity_rows(const std::string& experiment, std::span<const std::string> outputs,
                                       std::span<const std::string> inputs, const GivenDataIndices& indices);

struct InputIndex {
  std::string input;
  double index = 0;
  Interval interval;
};

// The inputs that affect an output most, at most MOST_INPUTS, the largest index first.
struct OutputIndices {
  std::string experiment, output;
  std::vector<InputIndex> inputs;
};
constexpr std::size_t MOST_INPUTS = 3;

// Reads the rows of sensitivity among `rows`, in order. Leaves out inputs whose interval reaches down to 0; an output may have none left.
std::vector<OutputIndices> strongest_inputs(std::span<const StudyRow> rows);

}  // namespace wholehand

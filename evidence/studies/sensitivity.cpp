// SPDX-License-Identifier: MIT
#include "evidence/studies/sensitivity.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <string_view>

#include "evidence/studies/contact_plan.h"

namespace wholehand {

std::vector<StudyRow> sensitivity_rows(const std::string& experiment, std::span<const std::string> outputs,
                                       std::span<const std::string> inputs, const GivenDataIndices& indices) {
  assert(outputs.size() == indices.outputs() && inputs.size() == indices.inputs());
  std::vector<StudyRow> rows;
  for (std::size_t k = 0; k < outputs.size(); ++k)
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const SensitivityIndex index = indices.first_order(k, i);
      rows.push_back({experiment,
                      "",
                      ALL_VESSELS,
                      FIRST_ORDER_OF + outputs[k],
                      inputs[i],
                      index.first,
                      index.interval,
                      std::nullopt,
                      {indices.values(k)}});
    }
  return rows;
}

std::vector<OutputIndices> strongest_inputs(std::span<const StudyRow> rows) {
  std::vector<OutputIndices> all;
  for (const StudyRow& row : rows) {
    if (!row.statistic.starts_with(FIRST_ORDER_OF)) continue;
    const std::string output = row.statistic.substr(std::string_view(FIRST_ORDER_OF).size());
    if (all.empty() || all.back().output != output || all.back().experiment != row.experiment)
      all.push_back({row.experiment, output, {}});
    if (row.interval.low > 0) all.back().inputs.push_back({row.subject, row.value, row.interval});
  }
  for (OutputIndices& output : all) {
    std::stable_sort(output.inputs.begin(), output.inputs.end(),
                     [](const InputIndex& a, const InputIndex& b) { return a.index > b.index; });
    if (output.inputs.size() > MOST_INPUTS) output.inputs.resize(MOST_INPUTS);
  }
  return all;
}

}  // namespace wholehand

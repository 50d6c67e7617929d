// SPDX-License-Identifier: MIT
// The rows of `wholehand error-time` as CSV and as a short report.
#pragma once

#include <string>
#include <vector>

#include "evidence/check/error_measure.h"

namespace wholehand {

// What the rows were made with.
struct ErrorContext {
  std::string scene, version;
  std::string device, driver;  // the core's machine where there is no other
  std::uint64_t seed = 0;
  std::uint64_t grips = 0, feasible = 0, grazing = 0;  // of all vessels, by the reference
  std::size_t vessels = 0, states = 0;
  bool quick = false;
  bool efforts = false;  // the scene has them
  std::vector<std::string> notes;
};

// The line of column names, and one line a row; an empty cell is what a variant does not have or answers otherwise.
std::string error_csv(const std::vector<ErrorRow>& rows, const ErrorContext& context);

// The grips by vessel and index, for what the worst ones are: m and rad.
std::string error_grips_csv(const std::vector<std::vector<GripInput>>& grips);

// The rows that no other beats in time and in `error` at once, the fastest first. Rows without a finite error, or with
// too many flips, are not among them.
std::vector<const ErrorRow*> pareto_front(const std::vector<ErrorRow>& rows, double (ErrorRow::*error)() const);

// Markdown.
std::string error_report(const std::vector<ErrorRow>& rows, const ErrorContext& context);

}  // namespace wholehand

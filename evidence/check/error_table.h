// SPDX-License-Identifier: MIT
// The rows of `wholehand error-time` as CSV and as a short report.
#pragma once

#include <string>
#include <vector>

#include "evidence/check/error_measure.h"

namespace wholehand {

// How the rows were made.
struct ErrorContext {
  std::string scene, version;
  std::string device, driver;  // the core's machine if there is no other
  std::uint64_t seed = 0;
  std::uint64_t grips = 0, feasible = 0, grazing = 0;  // of all vessels, by the reference
  std::size_t vessels = 0, states = 0;
  bool quick = false;
  bool efforts = false;  // the scene has them
  std::vector<std::string> notes;
};

// The line of column names, and one line per row; a cell is empty if a variant lacks the value or answers another question.
std::string error_csv(const std::vector<ErrorRow>& rows, const ErrorContext& context);

// The grips by vessel and index, to look up the worst ones: m and rad.
std::string error_grips_csv(const std::vector<std::vector<GripInput>>& grips);

// The rows that no other beats in both time and `error`, the fastest first, without rows that have no finite error or too many flips.
std::vector<const ErrorRow*> pareto_front(const std::vector<ErrorRow>& rows, double (ErrorRow::*error)() const);

// Markdown.
std::string error_report(const std::vector<ErrorRow>& rows, const ErrorContext& context);

}  // namespace wholehand

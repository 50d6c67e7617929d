// SPDX-License-Identifier: MIT
// The terminal output of a study.
#pragma once

#include <span>
#include <string>

#include "evidence/studies/row.h"

namespace wholehand {

// Experiment by experiment, whose rows must be adjacent: a line for each pose and vessel of contacts, and for other experiments a line for each
// statistic.
std::string study_summary(std::span<const StudyRow> rows);

}  // namespace wholehand

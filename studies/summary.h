// SPDX-License-Identifier: MIT
// What a study says on the terminal.
#pragma once

#include <span>
#include <string>

#include "studies/row.h"

namespace wholehand {

// A line for each pose and vessel.
std::string study_summary(std::span<const StudyRow> rows);

}  // namespace wholehand

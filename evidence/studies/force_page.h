// SPDX-License-Identifier: MIT
// The page's and the terminal's part on the experiment of forces.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

// `rows`: of force_rows.
StudySection force_section(std::vector<StudyRow> rows);

// For the terminal: a line for each choice of forces, and which of the two forces matters more.
std::string force_summary(std::span<const StudyRow> rows);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// What the page says first: which of the paper's numbers lie inside the intervals, and by how much the others miss them.
#pragma once

#include <span>
#include <string>

#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

// "15 of 44 of the paper's numbers lie inside our 95 % intervals: 4 of 15 for forces, 11 of 29 for sessions. ..."
std::string answer_sentence(std::span<const StudyRow> rows);

// `rows`: of all experiments, each one's together.
StudySection answer_section(std::span<const StudyRow> rows);

}  // namespace wholehand

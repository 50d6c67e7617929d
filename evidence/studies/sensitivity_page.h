// SPDX-License-Identifier: MIT
// The page's part on which trait of people affects what.
#pragma once

#include <vector>

#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

// `rows`: of sensitivity_rows, of any experiments.
StudySection sensitivity_section(std::vector<StudyRow> rows);

}  // namespace wholehand

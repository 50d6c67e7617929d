// SPDX-License-Identifier: MIT
// What the page says about which trait of people moves what.
#pragma once

#include <vector>

#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

// `rows`: of sensitivity_rows, of any experiments.
StudySection sensitivity_section(std::vector<StudyRow> rows);

}  // namespace wholehand

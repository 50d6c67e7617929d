// SPDX-License-Identifier: MIT
// What the page says of the experiment of forces.
#pragma once

#include <vector>

#include "studies/page.h"
#include "studies/row.h"

namespace wholehand {

// `rows`: of force_rows.
StudySection force_section(std::vector<StudyRow> rows);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The page's part on the experiment of sessions.
#pragma once

#include <vector>

#include "evidence/studies/page.h"
#include "evidence/studies/row.h"
#include "evidence/studies/session_statistics.h"

namespace wholehand {

// `rows`: of session_rows. `are_simulated`: the people are virtual, otherwise recorded.
StudySection session_section(const SessionVessels& vessels, std::vector<StudyRow> rows, bool are_simulated);

}  // namespace wholehand

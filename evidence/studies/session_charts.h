// SPDX-License-Identifier: MIT
// Box plots of sessions by vessel, as in the paper's Fig. 9.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "evidence/studies/row.h"
#include "evidence/studies/session_statistics.h"

namespace wholehand {

// Captions and SVG: the increase of the normal force, the grip force before and after the tilt, and the response time, with the paper's means and
// deviations, where the rows (session_rows) have them.
std::vector<std::string> session_charts(std::span<const SessionSubject> subjects, const SessionVessels& vessels,
                                        std::span<const StudyRow> rows);

}  // namespace wholehand

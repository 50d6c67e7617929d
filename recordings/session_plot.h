// SPDX-License-Identifier: MIT
// A session as the paper's Fig. 8 shows it: forces, tilt and grip force over time, the states shaded.
#pragma once

#include <string>

#include "recordings/recording.h"
#include "recordings/session_report.h"

namespace wholehand {

// gnuplot's commands for `file`; there is at least one tick.
std::string session_plot_script(const Recording& recording, const SessionReport& report, const std::string& file);

// Draws it. Returns an empty string, or why it is not there: a sentence for the user.
std::string draw_session(const Recording& recording, const SessionReport& report, const std::string& file);

}  // namespace wholehand

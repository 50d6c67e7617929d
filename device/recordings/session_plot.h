// SPDX-License-Identifier: MIT
// Plots a session like the paper's Fig. 8: forces, tilt and grip force over time, with the states shaded.
#pragma once

#include <string>

#include "device/recordings/recording.h"
#include "device/recordings/session_report.h"

namespace wholehand::device {

// The text of the picture; there is at least one tick.
std::string session_picture(const Recording& recording, const SessionReport& report);

}  // namespace wholehand::device

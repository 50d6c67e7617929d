// SPDX-License-Identifier: MIT
#include "device/session/tick.h"

namespace wholehand::device {

const std::array<const char*, SESSION_STATES> SESSION_STATE_NAMES{"free",     "touching", "lift",     "tilt",
                                                                  "maintain", "slipped",  "released", "let go"};
const std::array<const char*, FAULTS> FAULT_NAMES{"none", "read error",  "timeout", "stale",     "not finite",
                                                  "jump", "write error", "late",    "ring full", "interrupted"};

}  // namespace wholehand::device

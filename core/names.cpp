#include "core/result.h"
#include "core/scene.h"
#include "core/tick.h"

namespace wholehand {

const std::array<const char*, FINGER_COUNT> FINGER_NAMES{"thumb", "index", "middle", "ring", "little"};
const std::array<const char*, 7> REASON_NAMES{"", "degenerate", "not_converged", "misses", "too_wide", "too_narrow", "on_mouth"};
const std::array<const char*, SESSION_STATES> SESSION_STATE_NAMES{"free",     "touching", "lift",    "tilt",
                                                                  "maintain", "slipped",  "released"};
const std::array<const char*, FAULTS> FAULT_NAMES{"none", "read error",  "timeout", "stale",     "not finite",
                                                  "jump", "write error", "late",    "ring full", "interrupted"};

}  // namespace wholehand

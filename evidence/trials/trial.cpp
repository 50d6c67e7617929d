// SPDX-License-Identifier: MIT
#include "evidence/trials/trial.h"

namespace wholehand {

const std::array<const char*, 8> TRIAL_REASON_NAMES{"", "overlap", "buried", "diverged", "release", "turned", "moved", "earlier"};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

const std::array<const char*, FINGER_COUNT> FINGER_NAMES{"thumb", "index", "middle", "ring", "little"};
const std::array<const char*, 7> REASON_NAMES{"", "degenerate", "not_converged", "misses", "too_wide", "too_narrow", "on_mouth"};

}  // namespace wholehand

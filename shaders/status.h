// SPDX-License-Identifier: MIT
// What the bits of a status decide, in C++ and GLSL alike.
#ifndef WHOLEHAND_STATUS_H
#define WHOLEHAND_STATUS_H

#ifdef __cplusplus
#include <cstdint>

#include "shaders/layout.h"

namespace wholehand {
#define STATUS_QUESTION constexpr bool
#define STATUS_WORD std::uint32_t
#else
#define STATUS_QUESTION bool
#define STATUS_WORD uint
#endif

// Whether the hand closes on the vessel; only then do a grip's other results exist.
STATUS_QUESTION is_feasible(STATUS_WORD status) { return (status & STATUS_REASON_MASK) == REASON_NONE; }

// Feasible, nowhere too deep, above the table and within reach of the wrist.
STATUS_QUESTION is_plausible(STATUS_WORD status) {
  return (status & (STATUS_REASON_MASK | STATUS_PLAUSIBLE | STATUS_OUT_OF_TURNS)) == STATUS_PLAUSIBLE;
}

// Whether efforts are computed for a grip: it is plausible, and may reach the lowest wanted score.
STATUS_QUESTION is_judged(STATUS_WORD status) { return is_plausible(status) && (status & STATUS_UNJUDGED) == 0; }

// Whether the grip may be one of the best: judged, and holding as far as efforts are known.
STATUS_QUESTION is_eligible(STATUS_WORD status) { return is_judged(status) && (status & STATUS_NOT_HELD) == 0; }

#undef STATUS_QUESTION
#undef STATUS_WORD
#ifdef __cplusplus
}  // namespace wholehand
#endif

#endif

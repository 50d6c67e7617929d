// SPDX-License-Identifier: MIT
#include "system/version.h"

#ifndef WHOLEHAND_VERSION
#define WHOLEHAND_VERSION "unknown"
#endif

namespace wholehand {

const char* version() { return WHOLEHAND_VERSION; }

}  // namespace wholehand

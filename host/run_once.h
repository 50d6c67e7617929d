// SPDX-License-Identifier: MIT
// Work that is done once: submitted alone and waited for.
#pragma once

#include "host/commands.h"

namespace wholehand::host {

// Runs the commands and waits. Returns the device's seconds in them. The first dispatch of a kernel may include its compilation.
double run_once(const Device& device, const Commands& commands);

}  // namespace wholehand::host

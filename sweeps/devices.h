// What there is to compute on: what `wholehand devices` does.
#pragma once

#include "core/error.h"

namespace wholehand {

// Prints the Vulkan devices and what each can do. Throws Error.
ExitCode list_devices();

}  // namespace wholehand

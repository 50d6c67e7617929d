// SPDX-License-Identifier: MIT
// What there is to compute on: what `wholehand devices` does.
#pragma once

#include <string>

#include "core/error.h"

namespace wholehand {

// Prints the Vulkan devices and what each can do. Throws Error.
ExitCode list_devices();

// A line about what is kept between runs: where, how large, and how large it may become. Throws Error (usage) as cache_limit does.
std::string cache_text();

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Sets the environment variables that Mesa's Vulkan drivers read.
#pragma once

#include <string>

namespace wholehand {

// Sets them for this process if a device is requested; `on`: the value of --on, "core" needs nothing. The user's own settings stay. Call before a
// Vulkan device is opened and while there is only one thread, because another might read the environment meanwhile.
void prepare_vulkan_environment(const std::string& on = "vulkan");

}  // namespace wholehand

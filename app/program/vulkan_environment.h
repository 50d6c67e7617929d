// SPDX-License-Identifier: MIT
// What Mesa's drivers for Vulkan read from the environment.
#pragma once

#include <string>

namespace wholehand {

// Sets it for this process, where a device is asked for; `on`: what the option --on says, "core" needs nothing. Settings of the
// user's own stay. To be called before a Vulkan device is opened, and while there is one thread, as another might read the
// environment meanwhile.
void prepare_vulkan_environment(const std::string& on = "vulkan");

}  // namespace wholehand

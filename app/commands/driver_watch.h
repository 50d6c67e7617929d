// SPDX-License-Identifier: MIT
// Ends a program whose Vulkan driver never returns from a call, as a driver without memory may do.
#pragma once

#include <string>

namespace wholehand {

constexpr unsigned DRIVER_PATIENCE = 150;  // s: more than DeviceOptions::wait_seconds, after which the program reports by itself

// While it lives, a program that waits for one answer of a Vulkan device ends after DRIVER_PATIENCE with one line and exit code 3. Does nothing for
// the core. Only one at a time, because it uses the process's alarm.
class DriverWatch {
 public:
  explicit DriverWatch(const std::string& on);
  ~DriverWatch();
  DriverWatch(const DriverWatch&) = delete;
  DriverWatch& operator=(const DriverWatch&) = delete;
};

}  // namespace wholehand

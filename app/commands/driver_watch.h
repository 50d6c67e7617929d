// SPDX-License-Identifier: MIT
// The end of a program whose Vulkan driver keeps one of its calls for ever, as a driver without memory may.
#pragma once

#include <string>

namespace wholehand {

constexpr unsigned DRIVER_PATIENCE = 150;  // s: more than DeviceOptions::wait_seconds, after which the program has words of its own

// While it lives, a program that asks a Vulkan device for one answer ends after DRIVER_PATIENCE with one line and exit code 3. Does nothing for the
// core. One at a time: it takes the process' alarm.
class DriverWatch {
 public:
  explicit DriverWatch(const std::string& on);
  ~DriverWatch();
  DriverWatch(const DriverWatch&) = delete;
  DriverWatch& operator=(const DriverWatch&) = delete;
};

}  // namespace wholehand

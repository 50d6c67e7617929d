// SPDX-License-Identifier: MIT
// The Vulkan device that is used.
#pragma once

#include <memory>
#include <string_view>

#include "host/device_info.h"

namespace wholehand::host {

struct DeviceState;  // vulkan.h

// A device with its queues. Used from one thread at a time; outlives the buffers and kernels made on it.
class Device {
 public:
  explicit Device(std::string_view selector = "vulkan", const DeviceOptions& options = {});
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const DeviceInfo& info() const;
  void wait_idle();

  DeviceState& state() const { return *state_; }  // for host/ alone

 private:
  std::unique_ptr<DeviceState> state_;
};

}  // namespace wholehand::host

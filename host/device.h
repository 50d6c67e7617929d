// SPDX-License-Identifier: MIT
// The Vulkan device in use.
#pragma once

#include <memory>
#include <string_view>

#include "host/device_info.h"

namespace wholehand::host {

struct DeviceState;  // vulkan.h

// Whether a driver did not return, so that a device and its threads were abandoned.
bool has_abandoned_devices();

// A device with its queues. One thread at a time may use it. It outlives the buffers and kernels made on it.
class Device {
 public:
  explicit Device(std::string_view selector = "vulkan", const DeviceOptions& options = {});
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const DeviceInfo& info() const;
  void wait_idle();
  // Abandons everything on a device whose driver does not return. Nothing may be called afterwards.
  void abandon();

  DeviceState& state() const { return *state_; }  // for host/ alone

 private:
  std::unique_ptr<DeviceState> state_;
};

}  // namespace wholehand::host

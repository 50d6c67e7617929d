// SPDX-License-Identifier: MIT
// A command buffer that is recorded again and again; for host/ alone.
#pragma once

#include "host/vulkan.h"

namespace wholehand::host {

// Stages that work and how they reach memory, for barriers of a queue family.
struct Work {
  vk::PipelineStageFlags stages;
  vk::AccessFlags reads, writes;
};

class CommandRecorder {
 public:
  CommandRecorder(DeviceState& device, std::uint32_t family);
  ~CommandRecorder();

  void begin();
  void copy(const BufferState& from, const BufferState& to, std::size_t bytes);
  void end();  // what was written is visible to the host and to later submits of the queue

  vk::CommandBuffer commands() const { return *buffers_[0]; }

 protected:
  void barrier();  // what was written before is visible to what follows
  const vk::raii::CommandBuffer& buffer() const { return buffers_[0]; }

  DeviceState& device_;

 private:
  Work work_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
};

// Waits for the fence. False: it was not signalled within `seconds`.
bool wait_for(DeviceState& device, vk::Fence fence, double seconds);

// Submits to the compute queue and waits. Throws DeviceLost; the device is marked where it hangs.
void submit_and_wait(DeviceState& device, const CommandRecorder& recorder);

}  // namespace wholehand::host

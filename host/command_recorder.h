// SPDX-License-Identifier: MIT
// A command buffer that is recorded again and again; for host/ alone.
#pragma once

#include "host/vulkan.h"

namespace wholehand::host {

// What waits for what: everything that a command buffer of ours does, and how it reaches memory.
constexpr vk::PipelineStageFlags WORK = vk::PipelineStageFlagBits::eComputeShader | vk::PipelineStageFlagBits::eTransfer;
constexpr vk::AccessFlags WRITES = vk::AccessFlagBits::eShaderWrite | vk::AccessFlagBits::eTransferWrite;
constexpr vk::AccessFlags READS =
    vk::AccessFlagBits::eShaderRead | vk::AccessFlagBits::eUniformRead | vk::AccessFlagBits::eTransferRead;

class CommandRecorder {
 public:
  CommandRecorder(DeviceState& device, std::uint32_t family);
  ~CommandRecorder();

  void begin();
  void copy(const BufferState& from, const BufferState& to, std::size_t bytes);
  void end();  // what was written is visible to the host and to later submits of the queue

  vk::CommandBuffer commands() const { return *buffers_[0]; }

 protected:
  // What was written before is visible to those stages and accesses.
  void barrier(vk::PipelineStageFlags to_stages, vk::AccessFlags to_access);
  const vk::raii::CommandBuffer& buffer() const { return buffers_[0]; }

  DeviceState& device_;

 private:
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
};

// Waits for the fence. False: it was not signalled within `seconds`.
bool wait_for(DeviceState& device, vk::Fence fence, double seconds);

// Submits to the compute queue and waits. Throws DeviceLost; the device is marked where it hangs.
void submit_and_wait(DeviceState& device, const CommandRecorder& recorder);

}  // namespace wholehand::host

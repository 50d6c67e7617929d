// SPDX-License-Identifier: MIT
#include "host/command_recorder.h"

#include <cmath>

namespace wholehand::host {
CommandRecorder::CommandRecorder(DeviceState& device, std::uint32_t family)
    : device_(device),
      pool_(*device.device, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, family}),
      buffers_(*device.device, {*pool_, vk::CommandBufferLevel::ePrimary, 1}) {}

CommandRecorder::~CommandRecorder() {
  leave_behind(device_, pool_);
  for (vk::raii::CommandBuffer& buffer : buffers_) leave_behind(device_, buffer);
}

void CommandRecorder::begin() { buffers_[0].begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit}); }

void CommandRecorder::end() {
  barrier(WORK | vk::PipelineStageFlagBits::eHost, READS | WRITES | vk::AccessFlagBits::eHostRead | vk::AccessFlagBits::eHostWrite);
  buffers_[0].end();
}

void CommandRecorder::barrier(vk::PipelineStageFlags to_stages, vk::AccessFlags to_access) {
  buffers_[0].pipelineBarrier(WORK, to_stages, {}, vk::MemoryBarrier(WRITES, to_access), {}, {});
}

void CommandRecorder::copy(const BufferState& from, const BufferState& to, std::size_t bytes) {
  if (bytes > 0) {
    buffers_[0].copyBuffer(*from.buffer, *to.buffer, vk::BufferCopy(0, 0, bytes));
  }
}

bool wait_for(DeviceState& device, vk::Fence fence, double seconds) {
  const auto nanoseconds = static_cast<std::uint64_t>(std::ceil(seconds * 1e9));
  return device.device->waitForFences(fence, true, nanoseconds) == vk::Result::eSuccess;
}

void submit_and_wait(DeviceState& device, const CommandRecorder& recorder) {
  vk::raii::Fence done(*device.device, vk::FenceCreateInfo());
  const vk::CommandBuffer commands = recorder.commands();
  device.compute.queue.submit(vk::SubmitInfo({}, {}, commands, {}), *done);
  if (!wait_for(device, *done, device.wait_seconds)) {
    device.hung = true;
    leave_behind(device, done);
    throw DeviceLost(
        "the Vulkan device did not finish within " + std::to_string(std::lround(device.wait_seconds)) + " s; try again",
        Remedy::or_core, true);
  }
}

}  // namespace wholehand::host

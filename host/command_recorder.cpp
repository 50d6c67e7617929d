// SPDX-License-Identifier: MIT
#include "host/command_recorder.h"

#include <cmath>

namespace wholehand::host {
namespace {

using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

// A copy-only family has no shader stage and no shader access.
Work work_of(bool only_copies) {
  if (only_copies) return {Stage::eTransfer, Access::eTransferRead, Access::eTransferWrite};
  return {Stage::eComputeShader | Stage::eTransfer, Access::eShaderRead | Access::eUniformRead | Access::eTransferRead,
          Access::eShaderWrite | Access::eTransferWrite};
}

}  // namespace

CommandRecorder::CommandRecorder(DeviceState& device, std::uint32_t family)
    : device_(device),
      work_(work_of(family != device.compute.family)),
      pool_(*device.device, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, family}) {}

CommandRecorder::~CommandRecorder() {
  leave_behind(device_, pool_);
  for (vk::raii::CommandBuffer& buffer : buffers_) leave_behind(device_, buffer);
}

void CommandRecorder::begin() {
  parts_ = 0;
  begin_part();
}

void CommandRecorder::begin_part() {
  if (parts_ == buffers_.size())
    buffers_.push_back(std::move(vk::raii::CommandBuffers(*device_.device, {*pool_, vk::CommandBufferLevel::ePrimary, 1})[0]));
  buffers_[parts_++].begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
}

void CommandRecorder::end() {
  const vk::AccessFlags access = work_.reads | work_.writes | Access::eHostRead | Access::eHostWrite;
  buffer().pipelineBarrier(work_.stages, work_.stages | Stage::eHost, {}, vk::MemoryBarrier(work_.writes, access), {}, {});
  buffer().end();
}

void CommandRecorder::split() {
  buffer().end();
  begin_part();
}

void CommandRecorder::barrier() {
  buffer().pipelineBarrier(work_.stages, work_.stages, {}, vk::MemoryBarrier(work_.writes, work_.reads | work_.writes), {}, {});
}

void CommandRecorder::copy(const BufferState& from, const BufferState& to, std::size_t bytes) {
  if (bytes > 0) {
    buffer().copyBuffer(*from.buffer, *to.buffer, vk::BufferCopy(0, 0, bytes));
  }
}

void CommandRecorder::submit(const vk::raii::Queue& queue, vk::Semaphore wait, vk::Semaphore signal, vk::Fence fence) const {
  for (std::size_t part = 0; part < parts_; part++) {
    const vk::CommandBuffer commands = *buffers_[part];
    const bool is_last = part + 1 == parts_;
    vk::SubmitInfo info({}, {}, commands);
    if (wait && part == 0) {
      info.setWaitSemaphores(wait).setWaitDstStageMask(work_.stages);
    }
    if (signal && is_last) {
      info.setSignalSemaphores(signal);
    }
    queue.submit(info, is_last ? fence : vk::Fence());
  }
}

bool wait_for(DeviceState& device, vk::Fence fence, double seconds) {
  const auto nanoseconds = static_cast<std::uint64_t>(std::ceil(seconds * 1e9));
  return device.device->waitForFences(fence, true, nanoseconds) == vk::Result::eSuccess;
}

void submit_and_wait(DeviceState& device, const CommandRecorder& recorder) {
  vk::raii::Fence done(*device.device, vk::FenceCreateInfo());
  recorder.submit(device.compute.queue, {}, {}, *done);
  if (!wait_for(device, *done, device.wait_seconds)) {
    device.hung = true;
    leave_behind(device, done);
    throw DeviceLost(
        "the Vulkan device did not finish within " + std::to_string(std::lround(device.wait_seconds)) + " s; try again",
        Remedy::or_core, true);
  }
}

}  // namespace wholehand::host

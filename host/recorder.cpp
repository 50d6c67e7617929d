#include "host/recorder.h"

#include <cmath>

namespace wholehand::host {
namespace {

constexpr vk::PipelineStageFlags WORK = vk::PipelineStageFlagBits::eComputeShader | vk::PipelineStageFlagBits::eTransfer;
constexpr vk::AccessFlags WRITES = vk::AccessFlagBits::eShaderWrite | vk::AccessFlagBits::eTransferWrite;
constexpr vk::AccessFlags READS =
    vk::AccessFlagBits::eShaderRead | vk::AccessFlagBits::eUniformRead | vk::AccessFlagBits::eTransferRead;

}  // namespace

Recorder::Recorder(Device::Impl& device, std::uint32_t family)
    : device_(device),
      pool_(*device.device, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, family}),
      buffers_(*device.device, {*pool_, vk::CommandBufferLevel::ePrimary, 1}) {
  if (device.timestamp_period > 0 && family == device.compute.family) {
    timestamps_ = vk::raii::QueryPool(*device.device, {{}, vk::QueryType::eTimestamp, 2});
  }
}

void Recorder::begin() { buffers_[0].begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit}); }

void Recorder::end() {
  barrier(WORK | vk::PipelineStageFlagBits::eHost, READS | WRITES | vk::AccessFlagBits::eHostRead | vk::AccessFlagBits::eHostWrite);
  buffers_[0].end();
}

void Recorder::barrier(vk::PipelineStageFlags to_stages, vk::AccessFlags to_access) {
  buffers_[0].pipelineBarrier(WORK, to_stages, {}, vk::MemoryBarrier(WRITES, to_access), {}, {});
}

void Recorder::copy(const Buffer& from, const Buffer& to, std::size_t bytes) {
  if (bytes > 0) {
    buffers_[0].copyBuffer(*from.impl().buffer, *to.impl().buffer, vk::BufferCopy(0, 0, bytes));
  }
}

void Recorder::steps(const Commands& commands) {
  const vk::raii::CommandBuffer& out = buffers_[0];
  std::uint32_t set_count = 0, storage = 0, uniform = 0, texels = 0;
  for (const Commands::Step& step : commands.steps()) {
    if (step.kernel) {
      set_count++;
      for (const auto& [binding, type] : step.kernel->impl().bindings) {
        (type == vk::DescriptorType::eUniformBuffer        ? uniform
         : type == vk::DescriptorType::eUniformTexelBuffer ? texels
                                                           : storage)++;
      }
    }
  }
  sets_.clear();
  const std::array<vk::DescriptorPoolSize, 3> sizes{vk::DescriptorPoolSize{vk::DescriptorType::eStorageBuffer, storage + 1},
                                                    vk::DescriptorPoolSize{vk::DescriptorType::eUniformTexelBuffer, texels + 1},
                                                    vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, uniform + 1}};
  descriptor_pool_ = vk::raii::DescriptorPool(
      *device_.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, set_count + 1, sizes));

  if (*timestamps_) {
    out.resetQueryPool(*timestamps_, 0, 2);
    out.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *timestamps_, 0);  // bottom: when what came before has finished
  }
  for (const Commands::Step& step : commands.steps()) {
    barrier(WORK, READS | WRITES);
    if (!step.kernel) {
      out.fillBuffer(*step.buffers[0]->impl().buffer, 0, VK_WHOLE_SIZE, 0);
      continue;
    }
    const Kernel::Impl& kernel = step.kernel->impl();
    sets_.push_back(std::move(vk::raii::DescriptorSets(*device_.device, {*descriptor_pool_, *kernel.set_layout})[0]));
    const vk::DescriptorSet set = *sets_.back();
    for (std::size_t i = 0; i < kernel.bindings.size(); i++) {
      const auto& [binding, type] = kernel.bindings[i];
      Buffer::Impl& buffer = step.buffers[i]->impl();
      const vk::DescriptorBufferInfo whole(*buffer.buffer, 0, VK_WHOLE_SIZE);
      const vk::BufferView texels_of = type == vk::DescriptorType::eUniformTexelBuffer ? buffer.texels() : vk::BufferView();
      vk::WriteDescriptorSet write(set, binding, 0, type, {}, whole);
      write.pTexelBufferView = &texels_of;
      device_.device->updateDescriptorSets(write, {});
    }
    out.bindPipeline(vk::PipelineBindPoint::eCompute, *kernel.pipeline);
    out.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *kernel.layout, 0, set, {});
    if (step.push_size > 0) {
      out.pushConstants<std::byte>(*kernel.layout, vk::ShaderStageFlagBits::eCompute, 0,
                                   vk::ArrayProxy<const std::byte>(step.push_size, step.push.data()));
    }
    out.dispatch(step.groups[0], step.groups[1], step.groups[2]);
  }
  if (*timestamps_) {
    out.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *timestamps_, 1);
  }
}

double Recorder::seconds() const {
  if (!*timestamps_) {
    return -1;
  }
  const auto [result, ticks] =
      timestamps_.getResults<std::uint64_t>(0, 2, 2 * sizeof(std::uint64_t), sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
  const std::uint64_t elapsed = (ticks[1] - ticks[0]) & device_.timestamp_mask;
  return result == vk::Result::eSuccess ? static_cast<double>(elapsed) * device_.timestamp_period : -1;
}

bool wait_for(Device::Impl& device, vk::Fence fence, double seconds) {
  const auto nanoseconds = static_cast<std::uint64_t>(std::ceil(seconds * 1e9));
  return device.device->waitForFences(fence, true, nanoseconds) == vk::Result::eSuccess;
}

void submit_and_wait(Device::Impl& device, const Recorder& recorder) {
  const vk::raii::Fence done(*device.device, vk::FenceCreateInfo());
  const vk::CommandBuffer commands = recorder.commands();
  device.compute.queue.submit(vk::SubmitInfo({}, {}, commands, {}), *done);
  if (!wait_for(device, *done, COMPILE_SECONDS)) {
    throw DeviceLost("the Vulkan device did not finish within 120 s; try again, or use --on core", true);
  }
}

}  // namespace wholehand::host

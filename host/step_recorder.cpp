// SPDX-License-Identifier: MIT
#include "host/step_recorder.h"

namespace wholehand::host {

StepRecorder::StepRecorder(DeviceState& device, std::uint32_t family) : CommandRecorder(device, family) {
  if (device.timestamp_period > 0 && family == device.compute.family) {
    timestamps_ = vk::raii::QueryPool(*device.device, {{}, vk::QueryType::eTimestamp, 2});
  }
}

StepRecorder::~StepRecorder() {
  for (vk::raii::DescriptorSet& set : sets_) leave_behind(device_, set);
  leave_behind(device_, descriptor_pool_, timestamps_);
}

void StepRecorder::steps(const Commands& commands) {
  std::uint32_t set_count = 0, storage = 0, uniform = 0, texels = 0;
  for (const Commands::Step& step : commands.steps()) {
    if (step.kernel) {
      set_count++;
      for (const auto& [binding, type] : step.kernel->state().bindings) {
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
    buffer().resetQueryPool(*timestamps_, 0, 2);
    buffer().writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *timestamps_,
                            0);  // bottom: when what came before has finished
  }
  for (const Commands::Step& step : commands.steps()) {
    if (&step != &commands.steps().front()) split();
    barrier();
    const vk::raii::CommandBuffer& out = buffer();
    if (!step.kernel) {
      out.fillBuffer(*step.buffers[0]->state().buffer, 0, VK_WHOLE_SIZE, 0);
      continue;
    }
    const KernelState& kernel = step.kernel->state();
    sets_.push_back(std::move(vk::raii::DescriptorSets(*device_.device, {*descriptor_pool_, *kernel.set_layout})[0]));
    const vk::DescriptorSet set = *sets_.back();
    for (std::size_t i = 0; i < kernel.bindings.size(); i++) {
      const auto& [binding, type] = kernel.bindings[i];
      BufferState& bound = step.buffers[i]->state();
      const vk::DescriptorBufferInfo whole(*bound.buffer, 0, VK_WHOLE_SIZE);
      const vk::BufferView texels_of = type == vk::DescriptorType::eUniformTexelBuffer ? bound.texels() : vk::BufferView();
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
    buffer().writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *timestamps_, 1);
  }
}

double StepRecorder::seconds() const {
  if (!*timestamps_) {
    return -1;
  }
  const auto [result, ticks] =
      timestamps_.getResults<std::uint64_t>(0, 2, 2 * sizeof(std::uint64_t), sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
  const std::uint64_t elapsed = (ticks[1] - ticks[0]) & device_.timestamp_mask;
  return result == vk::Result::eSuccess ? static_cast<double>(elapsed) * device_.timestamp_period : -1;
}

}  // namespace wholehand::host

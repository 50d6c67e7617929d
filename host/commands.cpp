// SPDX-License-Identifier: MIT
#include "host/commands.h"

#include <algorithm>

#include "host/vulkan.h"

namespace wholehand::host {
namespace {

// The largest buffer for a binding of that type, bytes.
std::uint64_t largest_range(const DeviceInfo& device, vk::DescriptorType type) {
  switch (type) {
    case vk::DescriptorType::eUniformBuffer:
      return device.max_uniform_range;
    case vk::DescriptorType::eUniformTexelBuffer:
      return device.max_texel_range;
    default:
      return device.max_storage_range;
  }
}

}  // namespace

void Commands::bind(std::uint32_t binding, const Buffer& buffer) {
  const auto place = std::ranges::find(bound_, binding, &std::pair<std::uint32_t, const Buffer*>::first);
  if (place != bound_.end()) {
    place->second = &buffer;
  } else {
    bound_.emplace_back(binding, &buffer);
  }
}

const Buffer& Commands::bound(std::uint32_t binding) const {
  const auto place = std::ranges::find(bound_, binding, &std::pair<std::uint32_t, const Buffer*>::first);
  if (place == bound_.end()) {
    throw failure_error("internal: nothing is bound at " + std::to_string(binding));
  }
  return *place->second;
}

void Commands::clear(std::uint32_t binding) {
  Step step;
  step.buffers = {&bound(binding)};
  steps_.push_back(std::move(step));
}

void Commands::dispatch(const Kernel& kernel, std::array<std::uint32_t, 3> groups) {
  Step step;
  step.kernel = &kernel;
  step.groups = groups;
  for (const auto& [binding, type] : kernel.state().bindings) {
    const auto place = std::ranges::find(bound_, binding, &std::pair<std::uint32_t, const Buffer*>::first);
    if (place == bound_.end()) {
      throw failure_error("internal: kernel " + kernel.name() + ": nothing is bound at " + std::to_string(binding));
    }
    const Buffer& buffer = *place->second;
    const DeviceInfo& device = buffer.state().device.info;
    const std::uint64_t limit = largest_range(device, type);
    if (buffer.size() > limit) {
      throw failure_error("kernel " + kernel.name() + ": buffer " + std::to_string(binding) + " has " +
                              std::to_string(buffer.size()) + " bytes and " + device.name + " takes " + std::to_string(limit),
                          Remedy::core);
    }
    for (std::size_t axis = 0; axis < 3; axis++) {
      if (groups[axis] > device.max_group_count[axis]) {
        throw failure_error("internal: kernel " + kernel.name() + ": " + std::to_string(groups[axis]) +
                            " groups on one axis, and " + device.name + " takes " + std::to_string(device.max_group_count[axis]));
      }
    }
    step.buffers.push_back(&buffer);
  }
  steps_.push_back(std::move(step));
}

Commands Commands::only(std::size_t step) const {
  Commands alone;
  alone.steps_.push_back(steps_.at(step));
  return alone;
}

std::array<std::uint32_t, 3> groups_for(const Device& device, const Kernel& kernel, std::size_t items) {
  const std::size_t groups = (items + kernel.group_size()[0] - 1) / kernel.group_size()[0];
  const std::size_t width = std::max<std::size_t>(1, std::min<std::size_t>(groups, device.info().max_group_count[0]));
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>((groups + width - 1) / width), 1};
}

}  // namespace wholehand::host

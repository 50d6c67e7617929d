// SPDX-License-Identifier: MIT
#include "host/kernel.h"

#include <algorithm>
#include <cstring>

#include "host/specialize.h"
#include "host/spirv.h"
#include "host/vulkan.h"

namespace wholehand::host {
namespace {

template <class T>
std::uint64_t bits_of(T value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof value);
  return bits;
}

SpecializationBits bits_of(const ShaderInterface& shader, std::span<const Constant> constants, const std::string& name) {
  SpecializationBits result;
  for (const Constant& constant : constants) {
    const auto declared = shader.constants.find(constant.id);
    if (declared == shader.constants.end()) {
      continue;
    }
    const ConstantKind kind = declared->second;
    std::visit(
        [&](auto value) {
          if (std::is_floating_point_v<decltype(value)> != (kind == ConstantKind::float32 || kind == ConstantKind::float64)) {
            throw failure_error("internal: kernel " + name + ": specialization constant " + std::to_string(constant.id) +
                                " is an integer on one side and not on the other");
          }
          switch (kind) {
            case ConstantKind::float32:
              result[constant.id] = bits_of(static_cast<float>(value));
              break;
            case ConstantKind::float64:
              result[constant.id] = bits_of(static_cast<double>(value));
              break;
            case ConstantKind::int32:
              result[constant.id] = bits_of(static_cast<std::int32_t>(value));
              break;
            case ConstantKind::uint32:
              result[constant.id] = bits_of(static_cast<std::uint32_t>(value));
              break;
            case ConstantKind::boolean:
              result[constant.id] = value != 0;
              break;
          }
        },
        constant.value);
  }
  return result;
}

vk::DescriptorType descriptor_type(BindingKind kind) {
  switch (kind) {
    case BindingKind::uniform:
      return vk::DescriptorType::eUniformBuffer;
    case BindingKind::texels:
      return vk::DescriptorType::eUniformTexelBuffer;
    default:
      return vk::DescriptorType::eStorageBuffer;
  }
}

std::array<std::uint32_t, 3> final_group_size(const ShaderInterface& shader, std::span<const Constant> constants) {
  std::array<std::uint32_t, 3> size = shader.group_size;
  for (std::size_t axis = 0; axis < 3; axis++) {
    for (const Constant& constant : constants) {
      if (shader.group_size_id[axis] != ShaderInterface::NO_ID && constant.id == shader.group_size_id[axis]) {
        size[axis] = std::visit([](auto value) { return static_cast<std::uint32_t>(value); }, constant.value);
      }
    }
  }
  return size;
}

// A module may only declare a width of reals that it has.
std::vector<std::uint32_t> kept_widths(const DeviceInfo& device, const ShaderInterface& shader) {
  std::vector<std::uint32_t> widths = device.kept_widths;
  if (!shader.float64) std::erase(widths, 64u);
  return widths;
}

}  // namespace

Kernel::Kernel(const Device& device, std::span<const std::uint32_t> words, std::span<const Constant> constants, std::string name)
    : Kernel(device.state(), words, constants, std::move(name)) {}

Kernel::Kernel(const DeviceState& device, std::span<const std::uint32_t> words, std::span<const Constant> constants,
               std::string name)
    : state_(new KernelState{device}) {
  const DeviceState& on = state_->device;
  const ShaderInterface shader = read_interface(words, name);
  if (shader.float64 && !on.info.float64) {
    throw usage_error(on.info.name + " cannot compute in double precision (kernel " + name + ")", Remedy::float_precision);
  }
  state_->group_size = final_group_size(shader, constants);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (state_->group_size[axis] > on.info.max_group_size[axis])
      throw failure_error("kernel " + name + ": groups of " + std::to_string(state_->group_size[axis]) +
                              " invocations along an axis, and " + on.info.name + " takes " +
                              std::to_string(on.info.max_group_size[axis]),
                          Remedy::core);
  }
  const std::uint64_t invocations = std::uint64_t(state_->group_size[0]) * state_->group_size[1] * state_->group_size[2];
  if (invocations == 0 || invocations > on.info.max_group_invocations) {
    throw failure_error("kernel " + name + ": groups of " + std::to_string(invocations) + " invocations, and " + on.info.name +
                            " takes 1 to " + std::to_string(on.info.max_group_invocations),
                        Remedy::core);
  }
  std::vector<vk::DescriptorSetLayoutBinding> layout;
  for (const ShaderBinding& binding : shader.bindings) {
    state_->bindings.emplace_back(binding.binding, descriptor_type(binding.kind));
    layout.emplace_back(binding.binding, state_->bindings.back().second, 1, vk::ShaderStageFlagBits::eCompute);
  }
  const auto buffers = std::ranges::count(shader.bindings, BindingKind::storage, [](const ShaderBinding& one) { return one.kind; });
  if (buffers > on.info.max_storage_buffers) {
    throw failure_error("kernel " + name + ": " + std::to_string(buffers) + " storage buffers, and " + on.info.name + " takes " +
                            std::to_string(on.info.max_storage_buffers),
                        Remedy::core);
  }
  state_->words = specialized(words, bits_of(shader, constants, name), state_->group_size, kept_widths(on.info, shader));
  checked("compiling kernel " + name, [&] {
    state_->set_layout = vk::raii::DescriptorSetLayout(*on.device, vk::DescriptorSetLayoutCreateInfo({}, layout));
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, MAX_PUSH);
    state_->layout = vk::raii::PipelineLayout(*on.device, vk::PipelineLayoutCreateInfo({}, *state_->set_layout, push));
    const vk::raii::ShaderModule module(*on.device, {{}, state_->words.size() * sizeof(std::uint32_t), state_->words.data()});
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main");
    state_->pipeline = vk::raii::Pipeline(*on.device, *on.cache, vk::ComputePipelineCreateInfo({}, stage, *state_->layout));
  });
  state_->name = std::move(name);
}

Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

const std::string& Kernel::name() const { return state_->name; }
const std::vector<std::uint32_t>& Kernel::words() const { return state_->words; }
const std::array<std::uint32_t, 3>& Kernel::group_size() const { return state_->group_size; }
bool Kernel::uses(std::uint32_t binding) const {
  return std::ranges::any_of(state_->bindings, [&](const auto& one) { return one.first == binding; });
}

}  // namespace wholehand::host

#include "host/kernel.h"

#include <algorithm>
#include <chrono>

#include "host/recorder.h"
#include "host/spirv.h"
#include "host/vulkan.h"

namespace wholehand::host {
namespace {

// Constants as Vulkan wants them: bytes, and where in them each id is.
struct Specialization {
  std::vector<vk::SpecializationMapEntry> entries;
  std::vector<std::byte> bytes;

  template <class T>
  void add(std::uint32_t id, T value) {
    entries.emplace_back(id, static_cast<std::uint32_t>(bytes.size()), sizeof value);
    const auto raw = std::as_bytes(std::span(&value, 1));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  }
};

Specialization specialize(const ShaderInterface& shader, std::span<const Constant> constants, const std::string& name) {
  Specialization result;
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
              result.add(constant.id, static_cast<float>(value));
              break;
            case ConstantKind::float64:
              result.add(constant.id, static_cast<double>(value));
              break;
            case ConstantKind::int32:
              result.add(constant.id, static_cast<std::int32_t>(value));
              break;
            case ConstantKind::uint32:
              result.add(constant.id, static_cast<std::uint32_t>(value));
              break;
            case ConstantKind::boolean:
              result.add(constant.id, static_cast<VkBool32>(value != 0));
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

// The largest buffer that a binding of that type takes, bytes.
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

}  // namespace

Kernel::Kernel(const Device& device, std::span<const std::uint32_t> words, std::span<const Constant> constants, std::string name)
    : impl_(std::make_unique<Impl>()) {
  const Device::Impl& on = device.impl();
  const ShaderInterface shader = read_interface(words, name);
  if (shader.float64 && !on.info.float64) {
    throw usage_error(on.info.name + " cannot compute in double precision (kernel " + name + "); use --precision float");
  }
  impl_->group_size = final_group_size(shader, constants);
  const std::uint64_t invocations = std::uint64_t(impl_->group_size[0]) * impl_->group_size[1] * impl_->group_size[2];
  if (invocations == 0 || invocations > on.info.max_group_invocations) {
    throw failure_error("kernel " + name + ": groups of " + std::to_string(invocations) + " invocations, and " + on.info.name +
                        " takes 1 to " + std::to_string(on.info.max_group_invocations) + "; use --on core");
  }
  std::vector<vk::DescriptorSetLayoutBinding> layout;
  for (const ShaderBinding& binding : shader.bindings) {
    impl_->bindings.emplace_back(binding.binding, descriptor_type(binding.kind));
    layout.emplace_back(binding.binding, impl_->bindings.back().second, 1, vk::ShaderStageFlagBits::eCompute);
  }
  const Specialization specialization = specialize(shader, constants, name);
  checked("compiling kernel " + name, [&] {
    impl_->set_layout = vk::raii::DescriptorSetLayout(*on.device, vk::DescriptorSetLayoutCreateInfo({}, layout));
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, Commands::MAX_PUSH);
    impl_->layout = vk::raii::PipelineLayout(*on.device, vk::PipelineLayoutCreateInfo({}, *impl_->set_layout, push));
    const vk::raii::ShaderModule module(*on.device, {{}, words.size_bytes(), words.data()});
    const vk::SpecializationInfo special(static_cast<std::uint32_t>(specialization.entries.size()), specialization.entries.data(),
                                         specialization.bytes.size(), specialization.bytes.data());
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &special);
    impl_->pipeline = vk::raii::Pipeline(*on.device, *on.cache, vk::ComputePipelineCreateInfo({}, stage, *impl_->layout));
  });
  impl_->name = std::move(name);
}

Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

const std::string& Kernel::name() const { return impl_->name; }
const std::array<std::uint32_t, 3>& Kernel::group_size() const { return impl_->group_size; }
bool Kernel::uses(std::uint32_t binding) const {
  return std::ranges::any_of(impl_->bindings, [&](const auto& one) { return one.first == binding; });
}

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
  for (const auto& [binding, type] : kernel.impl().bindings) {
    const auto place = std::ranges::find(bound_, binding, &std::pair<std::uint32_t, const Buffer*>::first);
    if (place == bound_.end()) {
      throw failure_error("internal: kernel " + kernel.name() + ": nothing is bound at " + std::to_string(binding));
    }
    const Buffer& buffer = *place->second;
    const DeviceInfo& device = buffer.impl().device.info;
    const std::uint64_t limit = largest_range(device, type);
    if (buffer.size() > limit) {
      throw failure_error("kernel " + kernel.name() + ": buffer " + std::to_string(binding) + " has " +
                          std::to_string(buffer.size()) + " bytes and " + device.name + " takes " + std::to_string(limit) +
                          "; use --on core");
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

std::array<std::uint32_t, 3> groups_for(const Device& device, const Kernel& kernel, std::size_t items) {
  const std::size_t groups = (items + kernel.group_size()[0] - 1) / kernel.group_size()[0];
  const std::size_t width = std::max<std::size_t>(1, std::min<std::size_t>(groups, device.info().max_group_count[0]));
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>((groups + width - 1) / width), 1};
}

double run_once(const Device& device, const Commands& commands) {
  Device::Impl& on = device.impl();
  return checked("running a kernel", [&] {
    Recorder recorder(on, on.compute.family);
    recorder.begin();
    recorder.steps(commands);
    recorder.end();
    const auto start = std::chrono::steady_clock::now();
    submit_and_wait(on, recorder);
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    return recorder.seconds() >= 0 ? recorder.seconds() : waited.count();
  });
}

}  // namespace wholehand::host

// The device that is used: its choice, queues and cache of pipelines.
#include "host/device.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "host/pipeline_cache.h"
#include "host/vulkan.h"

namespace wholehand::host {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string names_of(const std::vector<DeviceInfo>& devices) {
  std::string names;
  for (const DeviceInfo& device : devices) {
    names += (names.empty() ? "" : ", ") + ("vulkan:" + std::to_string(device.index)) + " " + device.name;
  }
  return names.empty() ? "no device" : names;
}

const DeviceInfo* first_usable(const std::vector<DeviceInfo>& devices, const std::string& part_of_name) {
  const DeviceInfo* best = nullptr;
  for (const DeviceInfo& device : devices) {
    if (device.unusable.empty() && lower(device.name).find(part_of_name) != std::string::npos &&
        (!best || device.kind < best->kind)) {
      best = &device;
    }
  }
  return best;
}

// Queues: one that computes, and one or two of a family that only copies, where there is one. With one of these it reads back,
// which is the larger part: were it to upload as well, the next chunk's upload would wait behind this chunk's read-back.
struct QueuePlan {
  std::uint32_t compute = 0, copy = 0, copy_queues = 0;
};

QueuePlan plan_queues(const vk::raii::PhysicalDevice& physical, bool staged) {
  const auto families = physical.getQueueFamilyProperties();
  QueuePlan plan;
  const auto computes = [](const auto& family) { return bool(family.queueFlags & vk::QueueFlagBits::eCompute); };
  plan.compute = static_cast<std::uint32_t>(std::ranges::find_if(families, computes) - families.begin());
  for (std::uint32_t i = 0; staged && i < families.size() && plan.copy_queues == 0; i++) {
    const auto busy = vk::QueueFlagBits::eCompute | vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eVideoDecodeKHR;
    if ((families[i].queueFlags & vk::QueueFlagBits::eTransfer) && !(families[i].queueFlags & busy)) {
      plan.copy = i;
      plan.copy_queues = std::min(families[i].queueCount, 2u);
    }
  }
  return plan;
}

void open(Device::Impl& impl) {
  const QueuePlan plan = plan_queues(*impl.physical, !impl.info.unified_memory);
  const std::array<float, 2> priorities{1, 1};
  std::vector<vk::DeviceQueueCreateInfo> queues{{{}, plan.compute, 1, priorities.data()}};
  impl.families = {plan.compute};
  if (plan.copy_queues > 0) {
    queues.push_back({{}, plan.copy, plan.copy_queues, priorities.data()});
    impl.families.push_back(plan.copy);
  }
  vk::PhysicalDeviceVulkan13Features features13;
  features13.maintenance4 = true;  // group sizes as specialization constants (LocalSizeId); every 1.3 device has it
  vk::PhysicalDeviceFeatures features;
  features.shaderFloat64 = impl.info.float64;
  vk::DeviceCreateInfo info({}, queues, {}, {}, &features);
  info.pNext = &features13;
  impl.device.emplace(*impl.physical, info);

  const auto queue = [&](std::uint32_t family, std::uint32_t index) {
    return QueueRef{family, impl.device->getQueue(family, index)};
  };
  impl.compute = queue(plan.compute, 0);
  impl.upload = plan.copy_queues > 1 ? queue(plan.copy, 1) : queue(plan.compute, 0);
  impl.download = plan.copy_queues > 0 ? queue(plan.copy, 0) : queue(plan.compute, 0);
  impl.memory = impl.physical->getMemoryProperties();
  const std::uint32_t bits = impl.physical->getQueueFamilyProperties()[plan.compute].timestampValidBits;
  if (bits > 0) {
    impl.timestamp_mask = ~std::uint64_t(0) >> (64 - bits);
    impl.timestamp_period = static_cast<double>(impl.physical->getProperties().limits.timestampPeriod) * 1e-9;
  }
  impl.info.timestamps = impl.timestamp_period > 0;
}

}  // namespace

const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, std::string_view selector) {
  constexpr std::string_view PREFIX = "vulkan";
  const DeviceInfo* chosen = nullptr;
  if (selector.empty() || selector == PREFIX) {
    chosen = first_usable(devices, "");
  } else if (selector.starts_with("vulkan:")) {
    std::size_t index = devices.size();
    const char* end = selector.data() + selector.size();
    const auto [rest, error] = std::from_chars(selector.data() + PREFIX.size() + 1, end, index);
    if (error == std::errc() && rest == end && index < devices.size()) {
      chosen = &devices[index];
    }
  } else if (selector.find_first_not_of("0123456789") != std::string_view::npos) {  // a number alone is no name
    chosen =
        first_usable(devices, lower(selector) == "lavapipe" ? "llvmpipe" : lower(selector));  // the driver's name for its device
  }
  if (!chosen) {
    throw usage_error("no Vulkan device \"" + std::string(selector) + "\" that can be used; there: core, " + names_of(devices));
  }
  if (!chosen->unusable.empty()) {
    throw usage_error("Vulkan device " + chosen->name + " cannot be used: " + chosen->unusable + "; there: " + names_of(devices));
  }
  return *chosen;
}

Device::Device(std::string_view selector, const DeviceOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->instance = acquire_instance(options);
  checked("opening the Vulkan device", [&] {
    vk::raii::PhysicalDevices physical(*impl_->instance->instance);
    std::vector<DeviceInfo> devices;
    for (const auto& one : physical) {
      devices.push_back(describe_device(one, devices.size()));
    }
    impl_->info = choose_device(devices, selector);
    impl_->physical = std::move(physical[impl_->info.index]);
    impl_->info.unified_memory &= options.unified_memory;
    open(*impl_);
    open_pipeline_cache(*impl_, options.cache_folder);
  });
}

Device::Impl::~Impl() { save_pipeline_cache(*this); }
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const { return impl_->info; }
void Device::wait_idle() {
  checked("waiting for the Vulkan device", [&] { impl_->device->waitIdle(); });
}

}  // namespace wholehand::host

// SPDX-License-Identifier: MIT
// The device that is used: its queues and cache of pipelines.
#include "host/device.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "host/pipeline_cache.h"
#include "host/vulkan.h"

namespace wholehand::host {
namespace {

std::atomic<bool> is_any_abandoned{false};

// Queues: one for compute, and one or two of a copy-only family, if there is one. A single copy queue reads back, which is the larger part: if it
// also uploaded, the next chunk's upload would wait behind this chunk's read-back.
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

void open(DeviceState& state) {
  const QueuePlan plan = plan_queues(*state.physical, !state.info.unified_memory);
  const std::array<float, 2> priorities{1, 1};
  std::vector<vk::DeviceQueueCreateInfo> queues{{{}, plan.compute, 1, priorities.data()}};
  state.families = {plan.compute};
  if (plan.copy_queues > 0) {
    queues.push_back({{}, plan.copy, plan.copy_queues, priorities.data()});
    state.families.push_back(plan.copy);
  }
  vk::PhysicalDeviceVulkan13Features features13;
  features13.maintenance4 = true;  // group sizes as specialization constants (LocalSizeId); every 1.3 device has it
  vk::PhysicalDeviceFeatures features;
  features.shaderFloat64 = state.info.float64;
  vk::DeviceCreateInfo info({}, queues, {}, {}, &features);
  info.pNext = &features13;
  state.device.emplace(*state.physical, info);

  const auto queue = [&](std::uint32_t family, std::uint32_t index) {
    return QueueRef{family, state.device->getQueue(family, index)};
  };
  state.compute = queue(plan.compute, 0);
  state.upload = plan.copy_queues > 1 ? queue(plan.copy, 1) : queue(plan.compute, 0);
  state.download = plan.copy_queues > 0 ? queue(plan.copy, 0) : queue(plan.compute, 0);
  state.memory = state.physical->getMemoryProperties();
  const std::uint32_t bits = state.physical->getQueueFamilyProperties()[plan.compute].timestampValidBits;
  if (bits > 0) {
    state.timestamp_mask = ~std::uint64_t(0) >> (64 - bits);
    state.timestamp_period = static_cast<double>(state.physical->getProperties().limits.timestampPeriod) * 1e-9;
  }
  state.info.timestamps = state.timestamp_period > 0;
}

}  // namespace

Device::Device(std::string_view selector, const DeviceOptions& options) : state_(std::make_unique<DeviceState>()) {
  state_->instance = acquire_instance(options);
  state_->wait_seconds = options.wait_seconds;
  checked("opening the Vulkan device", [&] {
    vk::raii::PhysicalDevices physical(*state_->instance->instance);
    std::vector<DeviceInfo> devices;
    for (const auto& one : physical) {
      devices.push_back(describe_device(one, devices.size()));
    }
    state_->info = choose_device(devices, selector);
    state_->physical = std::move(physical[state_->info.index]);
    state_->info.unified_memory &= options.unified_memory;
    open(*state_);
    open_pipeline_cache(*state_, options.cache_folder);
  });
}

DeviceState::~DeviceState() {
  if (!hung) {
    save_pipeline_cache(*this);
    return;
  }
  // never freed, even at the end of the process: the driver's threads live on it
  static auto& abandoned = *new std::vector<std::shared_ptr<Instance>>;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  abandoned.push_back(instance);
  leave_behind(*this, *cache, *device);
  is_any_abandoned = true;
}
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

void Device::abandon() {
  state_->hung = true;
  static_cast<void>(state_.release());  // never freed: the driver works on it when the process ends
  is_any_abandoned = true;
}

bool has_abandoned_devices() { return is_any_abandoned; }

const DeviceInfo& Device::info() const { return state_->info; }
void Device::wait_idle() {
  checked("waiting for the Vulkan device", [&] { state_->device->waitIdle(); });
}

}  // namespace wholehand::host

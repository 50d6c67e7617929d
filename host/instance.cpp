// SPDX-License-Identifier: MIT
// Loader, instance, validation layer, and the existing devices.
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string_view>

#include "base/system/memory_limit.h"
#include "host/vulkan.h"

namespace wholehand::host {
namespace {

constexpr const char* VALIDATION_LAYER = "VK_LAYER_KHRONOS_validation";
// Without memory for it, a library looks as if it were missing.
std::string first_remedy() {
  const std::string limit = memory_limit_text();
  if (!limit.empty()) return limit + "; raise that";
  // NVIDIA's container runtime sets the first, and leaves Vulkan out of its driver unless the second asks for it
  const char* capabilities = std::getenv("NVIDIA_DRIVER_CAPABILITIES");
  const std::string_view asked = capabilities ? capabilities : "";
  const bool lacks_graphics =
      std::getenv("NVIDIA_VISIBLE_DEVICES") && asked.find("all") == asked.npos && asked.find("graphics") == asked.npos;
  return std::string(": install mesa-vulkan-drivers and libvulkan1") +
         (lacks_graphics ? "; for NVIDIA's, start the container with NVIDIA_DRIVER_CAPABILITIES=all" : "");
}

struct Messages {
  std::mutex mutex;
  std::vector<std::string> lines;
};
Messages& messages() {
  static Messages all;
  return all;
}

VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  const std::lock_guard lock(messages().mutex);
  messages().lines.emplace_back(data->pMessage ? data->pMessage : "");
  return VK_FALSE;
}

bool wants_validation(const DeviceOptions& options) {
  const char* value = std::getenv("WHOLEHAND_VALIDATION");
  return options.validation || (value && *value && std::strcmp(value, "0") != 0);
}

std::string version_string(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

DeviceKind kind_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return DeviceKind::discrete;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return DeviceKind::integrated;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return DeviceKind::virtual_gpu;
    case vk::PhysicalDeviceType::eCpu:
      return DeviceKind::cpu;
    default:
      return DeviceKind::other;
  }
}

void describe_memory(const vk::raii::PhysicalDevice& physical, DeviceInfo& info) {
  const vk::PhysicalDeviceMemoryProperties memory = physical.getMemoryProperties();
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; i++) {
    if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal) {
      info.memory = std::max<std::uint64_t>(info.memory, memory.memoryHeaps[i].size);
    }
  }
  // a discrete GPU may offer a window to all of its memory, but reading through it is slow
  const auto direct = vk::MemoryPropertyFlagBits::eDeviceLocal | vk::MemoryPropertyFlagBits::eHostVisible |
                      vk::MemoryPropertyFlagBits::eHostCoherent;
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; i++) {
    info.unified_memory |= (info.kind == DeviceKind::cpu || info.kind == DeviceKind::integrated) &&
                           (memory.memoryTypes[i].propertyFlags & direct) == direct;
  }
}

}  // namespace

const char* device_kind_name(DeviceKind kind) {
  constexpr const char* NAMES[] = {"discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"};
  return NAMES[static_cast<int>(kind)];
}

std::vector<std::string> take_validation_messages() {
  const std::lock_guard lock(messages().mutex);
  return std::exchange(messages().lines, {});
}

void rethrow(const vk::SystemError& error, const std::string& what) {
  switch (static_cast<vk::Result>(error.code().value())) {
    case vk::Result::eErrorOutOfHostMemory:
    case vk::Result::eErrorOutOfDeviceMemory:
    case vk::Result::eErrorTooManyObjects:
      throw OutOfMemory(what + ": out of memory on the Vulkan device; close other programs", Remedy::or_core);
    case vk::Result::eErrorDeviceLost:
      throw DeviceLost(what + ": the Vulkan device was lost; try again", Remedy::or_core);
    default:
      throw failure_error(what + ": the Vulkan driver answered " + vk::to_string(static_cast<vk::Result>(error.code().value())) +
                              memory_limit_text(),
                          Remedy::core);
  }
}

void Instance::Unload::operator()(void* handle) const { dlclose(handle); }

Instance::Instance(const DeviceOptions& options) {
  // vk::raii::Context opens the loader again, but could not say why it failed
  const std::string name = options.loader.empty() ? "libvulkan.so.1" : options.loader;
  library.reset(dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library) {
    const char* reason = dlerror();
    throw failure_error(std::string("no Vulkan loader (") + (reason ? reason : name.c_str()) + ")" + first_remedy(),
                        Remedy::or_core);
  }
  context.emplace();

  std::vector<const char*> layers, extensions;
  if (wants_validation(options)) {
    const auto there = context->enumerateInstanceLayerProperties();
    if (std::ranges::none_of(there, [](const auto& layer) { return std::strcmp(layer.layerName, VALIDATION_LAYER) == 0; })) {
      throw failure_error(std::string("the validation layer ") + VALIDATION_LAYER +
                          " is asked for and not there: install vulkan-validationlayers, or unset WHOLEHAND_VALIDATION");
    }
    layers.push_back(VALIDATION_LAYER);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  const vk::ApplicationInfo application("wholehand", 1, nullptr, 0, REQUIRED_API);
  const vk::DebugUtilsMessengerCreateInfoEXT listen(
      {}, vk::DebugUtilsMessageSeverityFlagBitsEXT::eWarning | vk::DebugUtilsMessageSeverityFlagBitsEXT::eError,
      vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation | vk::DebugUtilsMessageTypeFlagBitsEXT::ePerformance, collect);
  const vk::InstanceCreateInfo info({}, &application, layers, extensions, layers.empty() ? nullptr : &listen);
  try {
    instance.emplace(*context, info);
  } catch (const vk::IncompatibleDriverError&) {
    const char* files = std::getenv("VK_DRIVER_FILES") ? "VK_DRIVER_FILES" : "VK_ICD_FILENAMES";
    throw failure_error("no Vulkan driver" + (std::getenv(files) ? " in $" + std::string(files) : std::string()) + first_remedy(),
                        Remedy::or_core);
  } catch (const vk::SystemError& error) {
    rethrow(error, "opening Vulkan");
  }
  if (!layers.empty()) {
    messenger.emplace(*instance, listen);
  }
}

std::shared_ptr<Instance> acquire_instance(const DeviceOptions& options) {
  static std::mutex mutex;
  static std::weak_ptr<Instance> kept[2];
  if (!options.loader.empty() || options.has_own_instance) {
    return std::make_shared<Instance>(options);
  }
  const std::lock_guard lock(mutex);
  std::weak_ptr<Instance>& place = kept[wants_validation(options) ? 1 : 0];
  std::shared_ptr<Instance> instance = place.lock();
  if (!instance) {
    instance = std::make_shared<Instance>(options);
    place = instance;
  }
  return instance;
}

DeviceInfo describe_device(const vk::raii::PhysicalDevice& physical, std::size_t index) {
  DeviceInfo info;
  info.index = index;
  const vk::PhysicalDeviceProperties core = physical.getProperties();
  info.name = core.deviceName.data();
  info.kind = kind_of(core.deviceType);
  info.api_version = version_string(core.apiVersion);
  info.max_storage_range = core.limits.maxStorageBufferRange;
  info.max_uniform_range = core.limits.maxUniformBufferRange;
  info.max_texel_range = std::uint64_t(core.limits.maxTexelBufferElements) * sizeof(std::uint32_t);
  info.max_group_invocations = core.limits.maxComputeWorkGroupInvocations;
  std::ranges::copy(core.limits.maxComputeWorkGroupSize, info.max_group_size.begin());
  info.max_storage_buffers = core.limits.maxPerStageDescriptorStorageBuffers;
  std::ranges::copy(core.limits.maxComputeWorkGroupCount, info.max_group_count.begin());
  info.shared_memory = core.limits.maxComputeSharedMemorySize;
  info.float64 = physical.getFeatures().shaderFloat64;
  describe_memory(physical, info);
  bool computes = false;
  for (const auto& family : physical.getQueueFamilyProperties()) {
    if (family.queueFlags & vk::QueueFlagBits::eCompute) {
      computes = true;
      info.timestamps |= family.timestampValidBits > 0;
    }
  }
  if (core.apiVersion < REQUIRED_API) {
    info.unusable = "its driver has Vulkan " + info.api_version + ", and 1.3 is needed";
    info.driver = "driver " + version_string(core.driverVersion);
    return info;
  }
  if (!computes) {
    info.unusable = "it has no compute queue";
  }
  const auto all = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                           vk::PhysicalDeviceVulkan12Properties>();
  const auto& v11 = all.get<vk::PhysicalDeviceVulkan11Properties>();
  const auto& v12 = all.get<vk::PhysicalDeviceVulkan12Properties>();
  info.max_allocation = v11.maxMemoryAllocationSize;
  info.subgroup_size = v11.subgroupSize;
  info.driver = std::string(v12.driverName.data()) + ", " + v12.driverInfo.data();
  const vk::ConformanceVersion& passed = v12.conformanceVersion;
  info.conformance = std::to_string(passed.major) + "." + std::to_string(passed.minor) + "." + std::to_string(passed.subminor) +
                     "." + std::to_string(passed.patch);
  if (v12.shaderSignedZeroInfNanPreserveFloat32) info.kept_widths.push_back(32);
  if (v12.shaderSignedZeroInfNanPreserveFloat64 && info.float64) info.kept_widths.push_back(64);
  for (const std::uint8_t byte : v11.deviceUUID) {
    constexpr const char* DIGITS = "0123456789abcdef";
    info.uuid += {DIGITS[byte >> 4], DIGITS[byte & 15]};
  }
  return info;
}

std::vector<DeviceInfo> list_devices(const DeviceOptions& options) {
  const std::shared_ptr<Instance> instance = acquire_instance(options);
  std::vector<DeviceInfo> devices;
  try {
    for (const vk::raii::PhysicalDevice& physical : vk::raii::PhysicalDevices(*instance->instance)) {
      devices.push_back(describe_device(physical, devices.size()));
    }
  } catch (const vk::SystemError& error) {
    rethrow(error, "listing Vulkan devices");
  }
  return devices;
}

}  // namespace wholehand::host

// SPDX-License-Identifier: MIT
// A Vulkan layer that shows lavapipe as a discrete GPU: queue families of their own for graphics, for compute and for copies, in place of one for
// all, few allocations of memory, and no patience: a submit of more than one dispatch loses the device. It lies under the validation layer, which
// then sees what a command buffer of each family may hold.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#define EXPORTED extern "C" __attribute__((visibility("default")))

namespace {

struct Family {
  VkQueueFlags flags;
  std::uint32_t queues;
};
constexpr std::array<Family, 3> FAMILIES{{{VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_TRANSFER_BIT, 1},
                                          {VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 1},
                                          {VK_QUEUE_TRANSFER_BIT, 2}}};

// Allocations that a device grants, in place of the 4,096 that every driver must.
constexpr std::uint32_t ALLOCATIONS = 48;

// A queue as the program has it. The loader writes its table into the first word.
struct Queue {
  void* loader = nullptr;
  VkQueue driver = VK_NULL_HANDLE;
};

// Functions of what lies below. They are asked for when instance and device are made: later the loader answers with those of the uppermost layer.
struct Below {
  PFN_vkGetInstanceProcAddr instance_address = nullptr;
  PFN_vkGetDeviceProcAddr device_address = nullptr;
  PFN_vkCreateDevice create_device = nullptr;
  PFN_vkGetPhysicalDeviceProperties properties = nullptr;
  PFN_vkGetPhysicalDeviceProperties2 properties2 = nullptr;
  PFN_vkGetPhysicalDeviceQueueFamilyProperties families = nullptr;
  PFN_vkGetDeviceQueue queue = nullptr;
  PFN_vkQueueSubmit submit = nullptr;
  PFN_vkQueueWaitIdle wait_idle = nullptr;
  PFN_vkCreateCommandPool create_pool = nullptr;
  PFN_vkCreateBuffer create_buffer = nullptr;
  PFN_vkBeginCommandBuffer begin = nullptr;
  PFN_vkCmdDispatch dispatch = nullptr;
};

// One instance and one device at a time: those of a test.
Below below;
std::mutex mutex;
std::map<std::pair<std::uint32_t, std::uint32_t>, std::unique_ptr<Queue>> queues;
std::map<VkCommandBuffer, int> dispatches;

template <class Function>
void take(Function& function, PFN_vkVoidFunction address) {
  function = reinterpret_cast<Function>(address);
}

VkQueue of_driver(VkQueue queue) { return reinterpret_cast<Queue*>(queue)->driver; }

// The link of a chain of layers that `type` begins.
template <class Link>
Link* link_of(const void* chain, VkStructureType type) {
  for (auto* at = static_cast<const Link*>(chain); at; at = static_cast<const Link*>(at->pNext))
    if (at->sType == type && at->function == VK_LAYER_LINK_INFO) return const_cast<Link*>(at);
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* made) {
  auto* link = link_of<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  const PFN_vkGetInstanceProcAddr address = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  PFN_vkCreateInstance create;
  take(create, address(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, allocator, made);
  if (result != VK_SUCCESS) return result;
  below.instance_address = address;
  take(below.create_device, address(*made, "vkCreateDevice"));
  take(below.properties, address(*made, "vkGetPhysicalDeviceProperties"));
  take(below.properties2, address(*made, "vkGetPhysicalDeviceProperties2"));
  take(below.families, address(*made, "vkGetPhysicalDeviceQueueFamilyProperties"));
  return result;
}

void change(VkPhysicalDeviceProperties& properties) {
  properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  properties.limits.maxMemoryAllocationCount = ALLOCATIONS;  // the validation layer counts
}

VKAPI_ATTR void VKAPI_CALL properties(VkPhysicalDevice physical, VkPhysicalDeviceProperties* out) {
  below.properties(physical, out);
  change(*out);
}

VKAPI_ATTR void VKAPI_CALL properties2(VkPhysicalDevice physical, VkPhysicalDeviceProperties2* out) {
  below.properties2(physical, out);
  change(out->properties);
}

VKAPI_ATTR void VKAPI_CALL families(VkPhysicalDevice physical, std::uint32_t* count, VkQueueFamilyProperties* out) {
  VkQueueFamilyProperties whole{};
  std::uint32_t one = 1;
  below.families(physical, &one, &whole);
  if (!out) {
    *count = static_cast<std::uint32_t>(FAMILIES.size());
    return;
  }
  *count = std::min(*count, static_cast<std::uint32_t>(FAMILIES.size()));
  for (std::uint32_t i = 0; i < *count; ++i) {
    out[i] = whole;
    out[i].queueFlags = FAMILIES[i].flags;
    out[i].queueCount = FAMILIES[i].queues;
  }
}

VKAPI_ATTR void VKAPI_CALL families2(VkPhysicalDevice physical, std::uint32_t* count, VkQueueFamilyProperties2* out) {
  std::vector<VkQueueFamilyProperties> plain(out ? *count : 0);
  families(physical, count, out ? plain.data() : nullptr);
  for (std::uint32_t i = 0; out && i < *count; ++i) out[i].queueFamilyProperties = plain[i];
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* made) {
  auto* link = link_of<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  const PFN_vkGetDeviceProcAddr address = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  VkDeviceQueueCreateInfo whole = info->pQueueCreateInfos[0];
  whole.queueFamilyIndex = 0;
  whole.queueCount = 1;
  VkDeviceCreateInfo changed = *info;
  changed.queueCreateInfoCount = 1;
  changed.pQueueCreateInfos = &whole;
  const VkResult result = below.create_device(physical, &changed, allocator, made);
  if (result != VK_SUCCESS) return result;
  below.device_address = address;
  take(below.queue, address(*made, "vkGetDeviceQueue"));
  take(below.submit, address(*made, "vkQueueSubmit"));
  take(below.wait_idle, address(*made, "vkQueueWaitIdle"));
  take(below.create_pool, address(*made, "vkCreateCommandPool"));
  take(below.create_buffer, address(*made, "vkCreateBuffer"));
  take(below.begin, address(*made, "vkBeginCommandBuffer"));
  take(below.dispatch, address(*made, "vkCmdDispatch"));
  const std::lock_guard lock(mutex);
  queues.clear();
  return result;
}

VKAPI_ATTR void VKAPI_CALL get_queue(VkDevice on, std::uint32_t family, std::uint32_t index, VkQueue* out) {
  const std::lock_guard lock(mutex);
  std::unique_ptr<Queue>& queue = queues[{family, index}];
  if (!queue) {
    queue = std::make_unique<Queue>();
    below.queue(on, 0, 0, &queue->driver);
  }
  *out = reinterpret_cast<VkQueue>(queue.get());
}

VKAPI_ATTR void VKAPI_CALL get_queue2(VkDevice on, const VkDeviceQueueInfo2* info, VkQueue* out) {
  get_queue(on, info->queueFamilyIndex, info->queueIndex, out);
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* infos, VkFence fence) {
  const std::lock_guard lock(mutex);  // the driver has one queue for all of them
  int together = 0;
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t k = 0; k < infos[i].commandBufferCount; ++k) together += dispatches[infos[i].pCommandBuffers[k]];
  if (together > 1) return VK_ERROR_DEVICE_LOST;
  return below.submit(of_driver(queue), count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL begin(VkCommandBuffer commands, const VkCommandBufferBeginInfo* info) {
  const std::lock_guard lock(mutex);
  dispatches[commands] = 0;
  return below.begin(commands, info);
}

VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const std::lock_guard lock(mutex);
  ++dispatches[commands];
  below.dispatch(commands, x, y, z);
}

VKAPI_ATTR VkResult VKAPI_CALL wait_idle(VkQueue queue) {
  const std::lock_guard lock(mutex);
  return below.wait_idle(of_driver(queue));
}

VKAPI_ATTR VkResult VKAPI_CALL create_pool(VkDevice on, const VkCommandPoolCreateInfo* info, const VkAllocationCallbacks* allocator,
                                           VkCommandPool* made) {
  VkCommandPoolCreateInfo changed = *info;
  changed.queueFamilyIndex = 0;
  return below.create_pool(on, &changed, allocator, made);
}

VKAPI_ATTR VkResult VKAPI_CALL create_buffer(VkDevice on, const VkBufferCreateInfo* info, const VkAllocationCallbacks* allocator,
                                             VkBuffer* made) {
  VkBufferCreateInfo changed = *info;
  changed.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  changed.queueFamilyIndexCount = 0;
  return below.create_buffer(on, &changed, allocator, made);
}

const std::map<std::string, PFN_vkVoidFunction>& own() {
  const auto plain = [](auto function) { return reinterpret_cast<PFN_vkVoidFunction>(function); };
  static const std::map<std::string, PFN_vkVoidFunction> functions{{"vkCreateInstance", plain(create_instance)},
                                                                   {"vkGetPhysicalDeviceProperties", plain(properties)},
                                                                   {"vkGetPhysicalDeviceProperties2", plain(properties2)},
                                                                   {"vkGetPhysicalDeviceQueueFamilyProperties", plain(families)},
                                                                   {"vkGetPhysicalDeviceQueueFamilyProperties2", plain(families2)},
                                                                   {"vkCreateDevice", plain(create_device)},
                                                                   {"vkGetDeviceQueue", plain(get_queue)},
                                                                   {"vkGetDeviceQueue2", plain(get_queue2)},
                                                                   {"vkQueueSubmit", plain(submit)},
                                                                   {"vkQueueWaitIdle", plain(wait_idle)},
                                                                   {"vkCreateCommandPool", plain(create_pool)},
                                                                   {"vkCreateBuffer", plain(create_buffer)},
                                                                   {"vkBeginCommandBuffer", plain(begin)},
                                                                   {"vkCmdDispatch", plain(dispatch)}};
  return functions;
}

}  // namespace

EXPORTED VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice on, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetDeviceProcAddr);
  const auto found = own().find(name);
  return found != own().end() ? found->second : below.device_address(on, name);
}

EXPORTED VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance on, const char* name) {
  if (std::strcmp(name, "vkGetInstanceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetInstanceProcAddr);
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetDeviceProcAddr);
  const auto found = own().find(name);
  return found != own().end() ? found->second : below.instance_address ? below.instance_address(on, name) : nullptr;
}

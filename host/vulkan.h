// SPDX-License-Identifier: MIT
// Vulkan helpers shared within host/; no other folder includes this.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "host/device_info.h"

namespace wholehand::host {

// The build compiles shaders for this version (SHADER_TARGET_ENV in cmake/shaders.cmake); a device must support it.
constexpr std::uint32_t REQUIRED_API = VK_API_VERSION_1_3;

// Loader and instance, shared by all devices of the process with the same options.
struct Instance {
  explicit Instance(const DeviceOptions& options);

  struct Unload {
    void operator()(void* library) const;
  };
  std::unique_ptr<void, Unload> library;
  std::optional<vk::raii::Context> context;
  std::optional<vk::raii::Instance> instance;
  std::optional<vk::raii::DebugUtilsMessengerEXT> messenger;
};
std::shared_ptr<Instance> acquire_instance(const DeviceOptions& options);

DeviceInfo describe_device(const vk::raii::PhysicalDevice& physical, std::size_t index);

// Converts Vulkan's exceptions to ours; `what` names the operation.
[[noreturn]] void rethrow(const vk::SystemError& error, const std::string& what);
template <class Call>
decltype(auto) checked(const std::string& what, Call&& call) {
  try {
    return call();
  } catch (const vk::SystemError& error) {
    rethrow(error, what);
  }
}

struct QueueRef {
  std::uint32_t family = 0;
  vk::raii::Queue queue = nullptr;
};

struct DeviceState;

// An allocation that small buffers share. The last of them frees it.
struct MemoryBlock {
  explicit MemoryBlock(DeviceState& on) : device(on) {}
  ~MemoryBlock();

  DeviceState& device;
  vk::raii::DeviceMemory memory = nullptr;
  std::byte* mapped = nullptr;  // if the host can access it
  vk::DeviceSize size = 0, used = 0;
};

// What a Device holds.
struct DeviceState {
  std::shared_ptr<Instance> instance;
  DeviceInfo info;
  double wait_seconds = 0;  // as in DeviceOptions
  // The device did not finish in time and may work forever. Destroying it would wait for it, and freeing its memory would pull it away while in use,
  // so all of it is abandoned (see leave_behind).
  bool hung = false;
  std::optional<vk::raii::PhysicalDevice> physical;
  std::optional<vk::raii::Device> device;
  QueueRef compute, upload, download;   // upload and download are `compute` if there is no copy-only queue
  std::vector<std::uint32_t> families;  // those in use
  vk::PhysicalDeviceMemoryProperties memory;
  std::array<std::shared_ptr<MemoryBlock>, VK_MAX_MEMORY_TYPES> blocks;  // holds the next small buffer of each type
  double timestamp_period = 0;                                           // s; 0: no timestamps
  std::uint64_t timestamp_mask = 0;                                      // of the bits that count
  std::optional<vk::raii::PipelineCache> cache;
  std::string cache_file;      // empty: not kept
  std::size_t cache_size = 0;  // as read from it

  ~DeviceState();
};

// For destructors: if the device hangs, these handles are leaked instead of destroyed.
template <class... Handles>
void leave_behind(const DeviceState& device, Handles&... handles) {
  if (device.hung) (static_cast<void>(handles.release()), ...);
}

inline MemoryBlock::~MemoryBlock() { leave_behind(device, memory); }

// What a Buffer holds.
struct BufferState {
  DeviceState& device;
  std::size_t size;
  std::shared_ptr<MemoryBlock> memory{};
  vk::raii::Buffer buffer = nullptr;    // declared after its memory, so destroyed first
  vk::raii::BufferView view = nullptr;  // of uints; made by texels()
  std::byte* mapped = nullptr;
  bool cached = false;  // reading the mapping is fast

  ~BufferState() { leave_behind(device, view, buffer); }
  vk::BufferView texels();
};

// What a Kernel holds.
struct KernelState {
  const DeviceState& device;
  std::string name{};
  std::vector<std::uint32_t> words{};
  std::vector<std::pair<std::uint32_t, vk::DescriptorType>> bindings{};
  std::array<std::uint32_t, 3> group_size{1, 1, 1};
  vk::raii::DescriptorSetLayout set_layout = nullptr;
  vk::raii::PipelineLayout layout = nullptr;
  vk::raii::Pipeline pipeline = nullptr;

  ~KernelState() { leave_behind(device, pipeline, layout, set_layout); }
};

}  // namespace wholehand::host

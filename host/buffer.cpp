// SPDX-License-Identifier: MIT
#include "host/buffer.h"

#include <bit>

#include "host/command_recorder.h"
#include "host/vulkan.h"

namespace wholehand::host {
namespace {

using Flag = vk::MemoryPropertyFlagBits;

// The memory type with all of `needed` and most of `wanted`; the driver's first in a tie.
std::optional<std::uint32_t> find_type(const vk::PhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                                       vk::MemoryPropertyFlags needed, vk::MemoryPropertyFlags wanted,
                                       vk::MemoryPropertyFlags unwanted) {
  std::optional<std::uint32_t> best;
  int best_score = 0;
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; i++) {
    const vk::MemoryPropertyFlags flags = memory.memoryTypes[i].propertyFlags;
    const int score =
        std::popcount(static_cast<std::uint32_t>(flags & wanted)) - std::popcount(static_cast<std::uint32_t>(flags & unwanted));
    if ((allowed >> i & 1) && (flags & needed) == needed && (!best || score > best_score)) {
      best = i;
      best_score = score;
    }
  }
  return best;
}

std::uint32_t choose_type(const DeviceState& device, std::uint32_t allowed, Memory memory) {
  const vk::MemoryPropertyFlags direct = Flag::eHostVisible | Flag::eHostCoherent;  // coherent: nothing to flush
  std::optional<std::uint32_t> type;
  if (memory == Memory::upload) {
    type = find_type(device.memory, allowed, direct, {}, Flag::eDeviceLocal);
  } else if (memory == Memory::readback) {
    type = find_type(device.memory, allowed, direct, Flag::eHostCached, Flag::eDeviceLocal);
  } else if (device.info.unified_memory) {
    type = find_type(device.memory, allowed, direct | Flag::eDeviceLocal, Flag::eHostCached, {});
  } else {
    type = find_type(device.memory, allowed, Flag::eDeviceLocal, {}, Flag::eHostVisible);
  }
  if (!type) {
    throw failure_error("the Vulkan device " + device.info.name + " has no memory of the kind needed", Remedy::core);
  }
  return *type;
}

// A device may limit allocations to 4,096 (maxMemoryAllocationCount), and each vessel of a scene has seven or more buffers. So buffers of up to SMALL
// bytes share blocks. At most a sixteenth of a block stays unused at its end.
constexpr vk::DeviceSize BLOCK = 1 << 20, SMALL = BLOCK / 16;

std::shared_ptr<MemoryBlock> make_block(DeviceState& device, vk::DeviceSize size, std::uint32_t type) {
  const auto block = std::make_shared<MemoryBlock>(device);
  block->memory = vk::raii::DeviceMemory(*device.device, {size, type});
  block->size = size;
  if (device.memory.memoryTypes[type].propertyFlags & Flag::eHostVisible)
    block->mapped = static_cast<std::byte*>(block->memory.mapMemory(0, VK_WHOLE_SIZE));
  return block;
}

struct Place {
  std::shared_ptr<MemoryBlock> block;
  vk::DeviceSize offset = 0;
};

Place place_for(DeviceState& device, const vk::MemoryRequirements& needs, std::uint32_t type) {
  if (needs.size > SMALL) return {make_block(device, needs.size, type)};
  std::shared_ptr<MemoryBlock>& block = device.blocks[type];
  if (block.use_count() == 1) block->used = 0;  // no buffer is left in it
  vk::DeviceSize offset = block ? (block->used + needs.alignment - 1) / needs.alignment * needs.alignment : 0;
  if (!block || offset + needs.size > block->size) {
    block = make_block(device, BLOCK, type);
    offset = 0;
  }
  block->used = offset + needs.size;
  return {block, offset};
}

}  // namespace

Buffer::Buffer(const Device& device, std::size_t bytes, Memory memory) : Buffer(device.state(), bytes, memory) {}

Buffer::Buffer(DeviceState& on, std::size_t bytes, Memory memory) : state_(new BufferState{on, bytes}) {
  const std::size_t allocated = std::max<std::size_t>(16, (bytes + 15) / 16 * 16);  // Vulkan knows no empty buffer
  if (allocated > on.info.max_allocation) {
    throw OutOfMemory("a buffer of " + std::to_string(bytes) + " bytes is more than the Vulkan device allocates at once (" +
                      std::to_string(on.info.max_allocation) + "); ask for less at a time");
  }
  checked("allocating a buffer", [&] {
    vk::BufferCreateInfo info({}, allocated, vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst);
    if (memory == Memory::device) {
      info.usage |= vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eUniformBuffer |
                    vk::BufferUsageFlagBits::eUniformTexelBuffer;
    }
    if (on.families.size() > 1) {
      info.sharingMode = vk::SharingMode::eConcurrent;
      info.setQueueFamilyIndices(on.families);
    }
    state_->buffer = vk::raii::Buffer(*on.device, info);
    const vk::MemoryRequirements needs = state_->buffer.getMemoryRequirements();
    const std::uint32_t type = choose_type(on, needs.memoryTypeBits, memory);
    const Place place = place_for(on, needs, type);
    state_->memory = place.block;
    state_->buffer.bindMemory(*place.block->memory, place.offset);
    if (memory != Memory::device || on.info.unified_memory) {
      state_->mapped = place.block->mapped + place.offset;
      state_->cached = bool(on.memory.memoryTypes[type].propertyFlags & Flag::eHostCached);
    }
  });
}

vk::BufferView BufferState::texels() {
  if (!*view) view = vk::raii::BufferView(*device.device, {{}, *buffer, vk::Format::eR32Uint, 0, VK_WHOLE_SIZE});
  return *view;
}

Buffer::Buffer() = default;
Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

std::size_t Buffer::size() const { return state_ ? state_->size : 0; }
bool Buffer::reads_fast() const { return state_ && state_->cached; }
std::span<std::byte> Buffer::mapped() const {
  return state_ && state_->mapped ? std::span(state_->mapped, state_->size) : std::span<std::byte>();
}

void Buffer::write(std::span<const std::byte> bytes) {
  if (bytes.size() > size()) {
    throw failure_error("internal: " + std::to_string(bytes.size()) + " bytes written to a buffer of " + std::to_string(size()));
  }
  if (bytes.empty()) {
    return;
  }
  if (state_->mapped) {
    std::memcpy(state_->mapped, bytes.data(), bytes.size());
    return;
  }
  DeviceState& device = state_->device;
  Buffer staging(device, bytes.size(), Memory::upload);
  staging.write(bytes);
  checked("writing a buffer", [&] {
    CommandRecorder recorder(device, device.compute.family);
    recorder.begin();
    recorder.copy(staging.state(), *state_, bytes.size());
    recorder.end();
    submit_and_wait(device, recorder);
  });
}

void Buffer::read(std::span<std::byte> bytes) const {
  if (bytes.size() > size()) {
    throw failure_error("internal: " + std::to_string(bytes.size()) + " bytes read from a buffer of " + std::to_string(size()));
  }
  if (bytes.empty()) {
    return;
  }
  if (state_->mapped) {
    std::memcpy(bytes.data(), state_->mapped, bytes.size());
    return;
  }
  DeviceState& device = state_->device;
  Buffer staging(device, bytes.size(), Memory::readback);
  checked("reading a buffer", [&] {
    CommandRecorder recorder(device, device.compute.family);
    recorder.begin();
    recorder.copy(*state_, staging.state(), bytes.size());
    recorder.end();
    submit_and_wait(device, recorder);
  });
  staging.read(bytes);
}

}  // namespace wholehand::host

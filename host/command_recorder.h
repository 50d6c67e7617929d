// SPDX-License-Identifier: MIT
// Commands that are recorded again and again, in one submit or in several; for host/ alone.
#pragma once

#include "host/vulkan.h"

namespace wholehand::host {

// Stages that work and how they reach memory, for barriers of a queue family.
struct Work {
  vk::PipelineStageFlags stages;
  vk::AccessFlags reads, writes;
};

class CommandRecorder {
 public:
  CommandRecorder(DeviceState& device, std::uint32_t family);
  ~CommandRecorder();

  void begin();
  void copy(const BufferState& from, const BufferState& to, std::size_t bytes);
  void end();  // what was written is visible to the host and to later submits of the queue

  // One submit for each part. The first waits for `wait`, the last signals `signal` and `fence`, where these are given.
  void submit(const vk::raii::Queue& queue, vk::Semaphore wait, vk::Semaphore signal, vk::Fence fence) const;

 protected:
  void barrier();  // what was written before is visible to what follows
  void split();    // what follows is a part of its own
  const vk::raii::CommandBuffer& buffer() const { return buffers_[parts_ - 1]; }

  DeviceState& device_;

 private:
  Work work_;
  vk::raii::CommandPool pool_;
  std::vector<vk::raii::CommandBuffer> buffers_;  // one a part, and those of a longer recording before
  std::size_t parts_ = 0;

  void begin_part();
};

// Waits for the fence. False: it was not signalled within `seconds`.
bool wait_for(DeviceState& device, vk::Fence fence, double seconds);

// Submits to the compute queue and waits. Throws DeviceLost; the device is marked where it hangs.
void submit_and_wait(DeviceState& device, const CommandRecorder& recorder);

}  // namespace wholehand::host

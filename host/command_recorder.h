// SPDX-License-Identifier: MIT
// Records commands for repeated use, in one submit or several; for host/ alone.
#pragma once

#include "host/vulkan.h"

namespace wholehand::host {

// Working stages and their memory accesses, for barriers of a queue family.
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
  void end();  // makes writes visible to the host and to later submits of the queue

  // One submit for each part. The first waits for `wait`; the last signals `signal` and `fence`; each may be null.
  void submit(const vk::raii::Queue& queue, vk::Semaphore wait, vk::Semaphore signal, vk::Fence fence) const;

 protected:
  void barrier();  // makes earlier writes visible to what follows
  void split();    // starts a new part
  const vk::raii::CommandBuffer& buffer() const { return buffers_[parts_ - 1]; }

  DeviceState& device_;

 private:
  Work work_;
  vk::raii::CommandPool pool_;
  std::vector<vk::raii::CommandBuffer> buffers_;  // one for each part; may include those of an earlier, longer recording
  std::size_t parts_ = 0;

  void begin_part();
};

// Waits for the fence. Returns false if it was not signaled within `seconds`.
bool wait_for(DeviceState& device, vk::Fence fence, double seconds);

// Submits to the compute queue and waits. Throws DeviceLost and, if the device hangs, marks it.
void submit_and_wait(DeviceState& device, const CommandRecorder& recorder);

}  // namespace wholehand::host

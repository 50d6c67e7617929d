// A command buffer that is recorded again and again, with the descriptor sets and timestamps that it needs; for host/ alone.
#pragma once

#include "host/vulkan.h"

namespace wholehand::host {

// Longest wait for what is run once and for the first chunk of a stream: the driver may compile the kernel there.
constexpr double COMPILE_SECONDS = 120;

class Recorder {
 public:
  Recorder(Device::Impl& device, std::uint32_t family);

  void begin();
  void copy(const Buffer& from, const Buffer& to, std::size_t bytes);
  void steps(const Commands& commands);  // with a timestamp before and after
  void end();                            // what was written is visible to the host and to later submits of the queue

  vk::CommandBuffer commands() const { return *buffers_[0]; }
  double seconds() const;  // of the steps, by the device; negative where it has no timestamps

 private:
  void barrier(vk::PipelineStageFlags to_stages, vk::AccessFlags to_access);

  Device::Impl& device_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
  vk::raii::QueryPool timestamps_ = nullptr;
  vk::raii::DescriptorPool descriptor_pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> sets_;  // after their pool: destroyed first
};

// Waits for the fence. False: it was not signalled within `seconds`.
bool wait_for(Device::Impl& device, vk::Fence fence, double seconds);

// Submits to the compute queue and waits. Throws DeviceLost.
void submit_and_wait(Device::Impl& device, const Recorder& recorder);

}  // namespace wholehand::host

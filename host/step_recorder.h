// SPDX-License-Identifier: MIT
// A command buffer of dispatches, with the descriptor sets and timestamps that they need; for host/ alone.
#pragma once

#include <vector>

#include "host/command_recorder.h"
#include "host/commands.h"

namespace wholehand::host {

class StepRecorder : public CommandRecorder {
 public:
  StepRecorder(DeviceState& device, std::uint32_t family);
  ~StepRecorder();

  // With a timestamp before and after. Each step is a submit of its own, because a driver may end one that computes for seconds
  // (docs/drivers.md).
  void steps(const Commands& commands);
  double seconds() const;  // of the steps, by the device; negative where it has no timestamps

 private:
  vk::raii::QueryPool timestamps_ = nullptr;
  vk::raii::DescriptorPool descriptor_pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> sets_;  // after their pool: destroyed first
};

}  // namespace wholehand::host

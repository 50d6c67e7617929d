// SPDX-License-Identifier: MIT
// A command buffer of dispatches, with their descriptor sets and timestamps; for host/ alone.
#pragma once

#include <vector>

#include "host/command_recorder.h"
#include "host/commands.h"

namespace wholehand::host {

class StepRecorder : public CommandRecorder {
 public:
  StepRecorder(DeviceState& device, std::uint32_t family);
  ~StepRecorder();

  // With a timestamp before and after. Each step has its own submit, because a driver may end a submit that computes for seconds (docs/drivers.md).
  void steps(const Commands& commands);
  double seconds() const;  // device time of the steps; negative without timestamps

 private:
  vk::raii::QueryPool timestamps_ = nullptr;
  vk::raii::DescriptorPool descriptor_pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> sets_;  // declared after their pool, so destroyed first
};

}  // namespace wholehand::host

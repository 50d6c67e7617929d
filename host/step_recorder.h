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
  // (Linux 7's amdgpu after 2 s). The longest invocations are those of efforts and reserves: 4,100 pivots a dispatch, of some 67,000
  // cycles each as AMD's compiler counts them for VEGA10, which is 0.3 s at 1 GHz. A small GPU runs the 1,024 invocations of a
  // stream's first chunk, or of a piece of the liquid (make_liquid), side by side. Later chunks follow the time that was measured.
  void steps(const Commands& commands);
  double seconds() const;  // of the steps, by the device; negative where it has no timestamps

 private:
  vk::raii::QueryPool timestamps_ = nullptr;
  vk::raii::DescriptorPool descriptor_pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> sets_;  // after their pool: destroyed first
};

}  // namespace wholehand::host

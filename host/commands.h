// SPDX-License-Identifier: MIT
// A list of dispatches that run in order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/buffer.h"
#include "host/device.h"
#include "host/kernel.h"

namespace wholehand::host {

// Steps in order, each in its own submit. A step sees what earlier ones wrote.
class Commands {
 public:
  // From here on, every kernel that uses `binding` gets `buffer`, which must outlive the last submit.
  void bind(std::uint32_t binding, const Buffer& buffer);

  // Runs x * y * z groups. Throws Error unless every binding that the kernel uses is bound and the device takes so many groups. `push` is a plain
  // struct of up to Kernel::MAX_PUSH bytes, laid out as the shader's push constants (std430).
  void dispatch(const Kernel& kernel, std::array<std::uint32_t, 3> groups);
  template <class Push>
  void dispatch(const Kernel& kernel, std::array<std::uint32_t, 3> groups, const Push& push) {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= Kernel::MAX_PUSH && sizeof(Push) % 4 == 0);
    dispatch(kernel, groups);
    steps_.back().push_size = sizeof(Push);
    std::memcpy(steps_.back().push.data(), &push, sizeof(Push));
  }

  // Zeroes the buffer at that binding.
  void clear(std::uint32_t binding);

  // The buffer at that binding, to bind it elsewhere: one kernel's output as the next one's input. Throws Error if there is none.
  const Buffer& bound(std::uint32_t binding) const;

  struct Step {
    const Kernel* kernel = nullptr;  // null: zero `buffers[0]`
    std::array<std::uint32_t, 3> groups{};
    std::vector<const Buffer*> buffers;  // in the order of the kernel's bindings
    std::array<std::byte, Kernel::MAX_PUSH> push{};
    std::uint32_t push_size = 0;
  };
  const std::vector<Step>& steps() const { return steps_; }
  // One step alone, to run or time it.
  Commands only(std::size_t step) const;

 private:
  std::vector<std::pair<std::uint32_t, const Buffer*>> bound_;
  std::vector<Step> steps_;
};

// Groups for `items` invocations in x: along x as far as the device goes, then along y. The shader's index, below the items, is
//   (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x
std::array<std::uint32_t, 3> groups_for(const Device& device, const Kernel& kernel, std::size_t items);

}  // namespace wholehand::host

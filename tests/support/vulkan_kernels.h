// SPDX-License-Identifier: MIT
// Kernels of tests/shaders for the tests of host/.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "host/stream.h"
#include "tests/shaders/probe_shaders.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {

// SPIR-V of a shader of tests/shaders, precision 0 float, 1 double.
std::span<const std::uint32_t> test_shader(std::string_view name, int precision = 0);

// host_scale.comp: out[i] = factor * in[i] + offset, out[stride + i] = index of the item.
struct ScaleProgram : host::Program {
  explicit ScaleProgram(const host::DeviceOptions& options = {}, float factor = 2);
  host::Device& device() override { return on; }

  host::Device on;
  host::Kernel scale;
};

struct ScalePush {
  std::uint32_t count, stride, first;
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "tests/support/vulkan_kernels.h"

#include <stdexcept>
#include <string>

namespace wholehand {

std::span<const std::uint32_t> test_shader(std::string_view name, int precision) {
  for (const EmbeddedShader& shader : probe_shaders()) {
    if (shader.name == name && shader.precision == precision) {
      return shader.words;
    }
  }
  throw std::runtime_error("no test shader " + std::string(name));
}

ScaleProgram::ScaleProgram(const host::DeviceOptions& options, float factor)
    : on("vulkan", options),
      scale(on, test_shader("host_scale"), std::vector<host::Constant>{{0, 64u}, {1, factor}}, "host_scale") {}

}  // namespace wholehand

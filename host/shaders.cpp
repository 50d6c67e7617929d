// SPDX-License-Identifier: MIT
#include "host/shaders.h"

#include <string>

#include "base/text/error.h"

namespace wholehand::host {

std::span<const std::uint32_t> find_shader(std::string_view name, Precision precision, KernelBuild build, OutlineSource outline,
                                           std::span<const EmbeddedShader> among) {
  const int wanted = precision == Precision::full ? 1 : 0;
  for (const auto shaders : {among, embedded_shaders()})
    for (const EmbeddedShader& shader : shaders)
      if (shader.name == name && shader.precision == wanted && (shader.build == BUILD_ANY || shader.build == build) &&
          (shader.outline_source == OUTLINE_NONE || shader.outline_source == outline))
        return shader.words;
  throw failure_error("this build lacks the shader '" + std::string(name) + "'; build it again");
}

}  // namespace wholehand::host

// SPDX-License-Identifier: MIT
// The compiled shaders embedded in the binary (made by cmake/shaders.cmake).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/backend.h"

namespace wholehand {

// How a shader reads the vessel's outline (OUTLINE_SOURCE at compile time).
enum OutlineSource : int {
  OUTLINE_NONE = -1,   // the shader does not read it
  OUTLINE_BUFFER = 0,  // elements and their number from a storage buffer, in the loop
  OUTLINE_COPIED = 1   // copied once per invocation from a storage buffer
};

// The build of a shader (shaders/build.glsl).
enum KernelBuild : int {
  BUILD_ANY = -1,   // both are the same
  BUILD_WIDE = 0,   // for llvmpipe
  BUILD_SMALL = 1,  // for all other drivers; reads an outline from a buffer
};

struct EmbeddedShader {
  std::string_view name;  // stem of the .comp file
  int precision = 0;      // 0: float, 1: double (REAL_IS_DOUBLE)
  int build = BUILD_ANY;
  int outline_source = OUTLINE_NONE;
  std::span<const std::uint32_t> words;  // SPIR-V
};

// Every entry point of shaders/ in all its variants; sorted by name, then precision, then build, then outline source.
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace wholehand

namespace wholehand::host {

// The embedded shader of that name in a precision; the variant for a build and an outline source if it has any. Shaders in `among` take precedence,
// for comparisons. Throws Error if the build lacks it.
std::span<const std::uint32_t> find_shader(std::string_view name, Precision precision, KernelBuild build = BUILD_WIDE,
                                           OutlineSource outline = OUTLINE_NONE, std::span<const EmbeddedShader> among = {});

}  // namespace wholehand::host

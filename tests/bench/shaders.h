// SPDX-License-Identifier: MIT
// Embedded in the benchmarks alone: the shaders of tests/bench/shaders, and those of the program that count their useful lanes
// (shaders/real.glsl).
#pragma once

#include "host/shaders.h"

namespace wholehand {

std::span<const EmbeddedShader> bench_shaders();
std::span<const EmbeddedShader> lane_shaders();

}  // namespace wholehand

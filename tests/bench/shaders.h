// SPDX-License-Identifier: MIT
// The shaders of tests/bench/shaders, and those of grips and forces as they were, of tests/bench/former: embedded in the benchmarks alone.
#pragma once

#include "host/shaders.h"

namespace wholehand {

std::span<const EmbeddedShader> bench_shaders();
std::span<const EmbeddedShader> former_shaders();

}  // namespace wholehand

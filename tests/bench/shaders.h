// SPDX-License-Identifier: MIT
// The shaders of tests/bench/shaders: embedded in the benchmarks alone.
#pragma once

#include "host/shaders.h"

namespace wholehand {

std::span<const EmbeddedShader> bench_shaders();

}  // namespace wholehand

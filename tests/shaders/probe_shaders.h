// SPDX-License-Identifier: MIT
// The shaders of this folder, which evaluate one leaf function on a table: embedded in the tests, not in the product.
#pragma once

#include "host/shaders.h"

namespace wholehand {

std::span<const EmbeddedShader> probe_shaders();
// The program's own, each followed by meter.glsl.
std::span<const EmbeddedShader> metered_shaders();

}  // namespace wholehand

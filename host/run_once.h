// SPDX-License-Identifier: MIT
// Work that runs once: submitted alone and waited for.
#pragma once

#include <span>
#include <vector>

#include "host/commands.h"
#include "host/shaders.h"

namespace wholehand::host {

// Runs the commands, waits, and returns their device time in seconds. The first dispatch of a kernel may include its compilation.
double run_once(const Device& device, const Commands& commands);

// Precisions in which the driver fuses a product with a sum although a shader says `precise` (NoContraction). Compiles and runs a kernel of one
// invocation, taken from `among` if it is there.
std::vector<Precision> contracted_precisions(const Device& device, std::span<const EmbeddedShader> among = {});

}  // namespace wholehand::host

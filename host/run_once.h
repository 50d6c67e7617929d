// SPDX-License-Identifier: MIT
// Work that is done once: submitted alone and waited for.
#pragma once

#include <span>
#include <vector>

#include "host/commands.h"
#include "host/shaders.h"

namespace wholehand::host {

// Runs the commands and waits. Returns the device's seconds in them. The first dispatch of a kernel may include its compilation.
double run_once(const Device& device, const Commands& commands);

// Precisions of the device in which its driver does not round a product before it adds it, although a shader says `precise` (NoContraction). Compiles
// and
// runs a kernel of one invocation, that of `among` where it is there.
std::vector<Precision> contracted_precisions(const Device& device, std::span<const EmbeddedShader> among = {});

}  // namespace wholehand::host

// SPDX-License-Identifier: MIT
// Opens the backend that a user names.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/backend.h"
#include "host/compile.h"

namespace wholehand {

// `on`: "core", "vulkan" (the first device of the kinds discrete, integrated, CPU driver) or a device's name. `threads`: of the core; 0 uses all.
// Throws Error: (usage) no such device; (failure) the device does not answer.
std::unique_ptr<Backend> open_backend(const Scene& scene, const FieldSet& fields, const std::string& on, Precision precision,
                                      int threads, const host::CompileWatch& watch = {});

// Shows on a terminal how many kernels are compiled, once compilation takes longer than a second.
host::CompileWatch show_compiling();

// Bytes that one buffer of `on` can hold; the largest number for the core. Throws as open_backend does.
std::uint64_t largest_buffer(const std::string& on);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Identifies the code that computes. The definition comes from cmake/code_id.cmake.
#pragma once

namespace wholehand::sweeps {

// "sha1-155c253a..": the same in every program of a build, and in every build of the same sources with the same compiler and options.
const char* code_id();

}  // namespace wholehand::sweeps

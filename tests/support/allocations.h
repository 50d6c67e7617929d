// SPDX-License-Identifier: MIT
// How often this thread asks for memory: for what must not. Only in programs without sanitizers, which have a malloc of their own.
#pragma once

namespace wholehand {

// Calls of malloc, calloc and realloc by this thread so far, of libraries too.
long allocations();

}  // namespace wholehand

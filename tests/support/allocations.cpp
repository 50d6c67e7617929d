// SPDX-License-Identifier: MIT
#include "tests/support/allocations.h"

#include <cstddef>

namespace {
thread_local long count = 0;
}

// The program's malloc goes before the C library's; these are the C library's by their other names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);

void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  ++count;
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  ++count;
  return __libc_realloc(memory, size);
}
}

namespace wholehand {

long allocations() { return count; }

}  // namespace wholehand

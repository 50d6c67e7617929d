// SPDX-License-Identifier: MIT
// To be preloaded: memory that ends after some allocations. MALLOC_WORKS says how many are served; MALLOC_FAILS how many fail then
// (all).
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

extern "C" {
// glibc's own, under names that it keeps
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

std::atomic<long> calls{0};

bool fails() {
  static const char* const works = std::getenv("MALLOC_WORKS");
  static const char* const failing = std::getenv("MALLOC_FAILS");
  if (!works) return false;
  const long call = calls++ - std::atol(works);
  if (call < 0 || (failing && call >= std::atol(failing))) return false;
  errno = ENOMEM;
  return true;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) { return fails() ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) { return fails() ? nullptr : __libc_calloc(count, size); }
void* realloc(void* old, std::size_t size) { return fails() ? nullptr : __libc_realloc(old, size); }
void* memalign(std::size_t alignment, std::size_t size) { return fails() ? nullptr : __libc_memalign(alignment, size); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  void* made = memalign(alignment, size);
  if (!made) return ENOMEM;
  *out = made;
  return 0;
}

}  // extern "C"

// SPDX-License-Identifier: MIT
// What every call of the C interface does at its border: no exception crosses it, and an error becomes a line of the thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "app/c/wholehand/wholehand.h"
#include "base/text/error.h"

namespace wholehand {

// Stores the line for wh_message(), cut to its room and without control characters, and returns the status. A thread's first failure may allocate the
// room for its line.
[[gnu::format(printf, 2, 3)]] wh_status fail(wh_status status, const char* format, ...) noexcept;
wh_status fail(wh_status status, const std::string& line) noexcept;

// With the remedy, in the words of the C interface.
wh_status fail(const Error& error) noexcept;

// Runs the work of a call. `work` returns a wh_status, or throws.
template <class Work>
wh_status guarded(const Work& work) noexcept {
  try {
    return work();
  } catch (const Error& error) {
    return fail(error);
  } catch (const std::bad_alloc&) {
    return fail(WH_SYSTEM, "there is no memory left");
  } catch (const std::exception& error) {
    return fail(WH_SYSTEM, "%s", error.what());
  } catch (...) {
    return fail(WH_SYSTEM, "the library failed");
  }
}

// The size that a struct had in the first header of this WH_ABI. If a struct grows at its end, its earlier size is written here.
template <class Struct>
inline constexpr std::size_t FIRST_SIZE = sizeof(Struct);
template <>
inline constexpr std::size_t FIRST_SIZE<wh_grip_result> = offsetof(wh_grip_result, wrist_share);

// Whether the size that a caller's struct claims is allowed: at least that of the first header, and at most that of this one. A larger struct comes
// from a later header and may ask for something that this library does not know. `place` begins the failure's line.
wh_status check_size(std::size_t size, std::size_t first, std::size_t own, const char* place) noexcept;

// Takes the caller's struct; members unknown to the caller's version are 0.
template <class Struct>
wh_status take_over(const Struct* in, Struct& own, const char* place) noexcept {
  if (const wh_status status = check_size(in ? in->size : 0, FIRST_SIZE<Struct>, sizeof own, place); status != WH_OK) return status;
  own = Struct{};
  std::memcpy(&own, in, in->size);
  own.size = sizeof own;
  return WH_OK;
}

// Whether `out` can take an answer; checked before any work.
template <class Struct>
wh_status check_answer(const Struct* out, const char* place) noexcept {
  return check_size(out ? out->size : 0, FIRST_SIZE<Struct>, sizeof *out, place);
}

// Copies as much of it as the caller's version knows. `out` has been checked.
template <class Struct>
void give_back(const Struct& own, Struct* out) noexcept {
  const std::size_t size = out->size;
  std::memcpy(out, &own, size);
  out->size = size;
}

// Only one thread at a time; a second one is refused and does not wait.
class Entered {
 public:
  explicit Entered(std::atomic_flag& is_in_use) noexcept
      : is_in_use_(is_in_use), has_(!is_in_use.test_and_set(std::memory_order_acquire)) {}
  ~Entered() {
    if (has_) is_in_use_.clear(std::memory_order_release);
  }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;
  explicit operator bool() const noexcept { return has_; }

 private:
  std::atomic_flag& is_in_use_;
  bool has_;
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// What every call of the C face does at its border: nothing is thrown across it, and what went wrong is a line of the thread.
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

// Keeps the line for wh_message(), cut to its room and without control characters, and gives the status back. The first failure of a
// thread may allocate the room of its line.
[[gnu::format(printf, 2, 3)]] wh_status fail(wh_status status, const char* format, ...) noexcept;
wh_status fail(wh_status status, const std::string& line) noexcept;

// With what would help, in the words of the C face.
wh_status fail(const Error& error) noexcept;

// Runs what a call does. `work` returns a wh_status, or throws.
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

// The size that a struct had in the first header of this WH_ABI. When a struct grows at its end, its size before is written here.
template <class Struct>
inline constexpr std::size_t FIRST_SIZE = sizeof(Struct);
template <>
inline constexpr std::size_t FIRST_SIZE<wh_grip_result> = offsetof(wh_grip_result, wrist_share);

// Whether a caller's struct may be as large as it says: at least as in the first header, and not larger than here. A larger one is of
// a later header, and what it asks for this library does not know. `place` begins the line of a failure.
wh_status check_size(std::size_t size, std::size_t first, std::size_t own, const char* place) noexcept;

// Takes the caller's struct: members that the caller's version does not know are 0.
template <class Struct>
wh_status take_over(const Struct* in, Struct& own, const char* place) noexcept {
  if (const wh_status status = check_size(in ? in->size : 0, FIRST_SIZE<Struct>, sizeof own, place); status != WH_OK) return status;
  own = Struct{};
  std::memcpy(&own, in, in->size);
  own.size = sizeof own;
  return WH_OK;
}

// Whether `out` can take an answer: before any work.
template <class Struct>
wh_status check_answer(const Struct* out, const char* place) noexcept {
  return check_size(out ? out->size : 0, FIRST_SIZE<Struct>, sizeof *out, place);
}

// As much of it as the caller's version knows. `out` has been checked.
template <class Struct>
void give_back(const Struct& own, Struct* out) noexcept {
  const std::size_t size = out->size;
  std::memcpy(out, &own, size);
  out->size = size;
}

// One thread at a time; a second one is turned away and does not wait.
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

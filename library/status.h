// SPDX-License-Identifier: MIT
// What every call of the C face does at its border: nothing is thrown across it, and what went wrong is a line of the thread.
#pragma once

#include <cstddef>
#include <exception>
#include <new>
#include <string>

#include "core/error.h"
#include "include/wholehand/wholehand.h"

namespace wholehand {

// Keeps the line for wh_message() and gives the status back. Does not throw: a line that there is no memory for is a shorter one.
wh_status fail(wh_status status, const char* line) noexcept;

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
    return fail(WH_SYSTEM, error.what());
  } catch (...) {
    return fail(WH_SYSTEM, "the library failed");
  }
}

// Takes the caller's struct: members that the caller's version does not know are 0.
template <class Struct>
bool take_over(const Struct* in, Struct& own) noexcept {
  if (!in || in->size < sizeof in->size || in->size > 4096) return false;
  own = Struct{};
  __builtin_memcpy(&own, in, in->size < sizeof own ? in->size : sizeof own);
  own.size = sizeof own;
  return true;
}

// The other way: as much of it as the caller's version knows.
template <class Struct>
bool give_back(const Struct& own, Struct* out) noexcept {
  if (!out || out->size < sizeof out->size || out->size > 4096) return false;
  const std::size_t size = out->size;
  __builtin_memcpy(out, &own, size < sizeof own ? size : sizeof own);
  out->size = size;
  return true;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Ticks on their way from the haptic thread to recorder and displays.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

#include "device/session/tick.h"

namespace wholehand::device {

// A ring of ticks between one thread that pushes and one that pops. Neither ever waits for the other: no locks, no system calls, and no
// allocation after construction. Ticks come out in the order in which they went in, each once.
class TickRing {
 public:
  // Room for `capacity` ticks, rounded up to a power of two; at least 1. Its memory is touched here, so that no push meets a page fault.
  explicit TickRing(std::size_t capacity) : ticks_(std::bit_ceil(capacity)), mask_(ticks_.size() - 1) {}
  TickRing(const TickRing&) = delete;
  TickRing& operator=(const TickRing&) = delete;

  // False: it is full, and the tick was not added.
  bool push(const Tick& tick) noexcept {
    const std::size_t at = pushed_.load(std::memory_order_relaxed);
    if (at - popped_seen_ == ticks_.size()) {
      popped_seen_ = popped_.load(std::memory_order_acquire);
      if (at - popped_seen_ == ticks_.size()) return false;
    }
    ticks_[at & mask_] = tick;
    pushed_.store(at + 1, std::memory_order_release);
    return true;
  }

  // False: it is empty, and `tick` is unchanged.
  bool pop(Tick& tick) noexcept {
    const std::size_t at = popped_.load(std::memory_order_relaxed);
    if (at == pushed_seen_) {
      pushed_seen_ = pushed_.load(std::memory_order_acquire);
      if (at == pushed_seen_) return false;
    }
    tick = ticks_[at & mask_];
    popped_.store(at + 1, std::memory_order_release);
    return true;
  }

  // Number of ticks in it, from any thread; it may change at any moment.
  std::size_t size() const noexcept {
    // read popped first: otherwise it could overtake the pushed count that was read
    const std::size_t popped = popped_.load(std::memory_order_acquire);
    const std::size_t in_it = pushed_.load(std::memory_order_acquire) - popped;
    return in_it < ticks_.size() ? in_it : ticks_.size();
  }
  std::size_t capacity() const noexcept { return ticks_.size(); }

 private:
  static constexpr std::size_t CACHE_LINE = 64;  // separates what the two threads write

  std::vector<Tick> ticks_;
  std::size_t mask_;
  alignas(CACHE_LINE) std::atomic<std::size_t> pushed_{0};  // counts, never reduced; their low bits are the position
  std::size_t popped_seen_ = 0;                             // written by the pushing thread
  alignas(CACHE_LINE) std::atomic<std::size_t> popped_{0};
  std::size_t pushed_seen_ = 0;  // written by the popping thread
};

}  // namespace wholehand::device

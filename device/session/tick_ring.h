// SPDX-License-Identifier: MIT
// Ticks on their way from the haptic thread to recorder and displays.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

#include "device/session/tick.h"

namespace wholehand {

// A ring of ticks between one thread that pushes and one that pops. Neither ever waits for the other: no locks, no system calls, and no
// allocation after construction. Ticks come out in the order in which they went in, each once.
class TickRing {
 public:
  // Room for `capacity` ticks, rounded up to a power of two; at least 1. Its memory is touched here, so that no push meets a page fault.
  explicit TickRing(std::size_t capacity) : ticks_(std::bit_ceil(capacity)), mask_(ticks_.size() - 1) {}
  TickRing(const TickRing&) = delete;
  TickRing& operator=(const TickRing&) = delete;

  // False: it is full and the tick was not taken.
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

  // False: it is empty and `tick` was left alone.
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

  // Ticks in it, from any thread; a moment later there may be others.
  std::size_t size() const noexcept {
    // popped first: the other way round it could overtake what was seen to be pushed
    const std::size_t popped = popped_.load(std::memory_order_acquire);
    const std::size_t in_it = pushed_.load(std::memory_order_acquire) - popped;
    return in_it < ticks_.size() ? in_it : ticks_.size();
  }
  std::size_t capacity() const noexcept { return ticks_.size(); }

 private:
  static constexpr std::size_t CACHE_LINE = 64;  // what each thread writes lies apart from what the other does

  std::vector<Tick> ticks_;
  std::size_t mask_;
  alignas(CACHE_LINE) std::atomic<std::size_t> pushed_{0};  // counts, never reduced: the place is their low bits
  std::size_t popped_seen_ = 0;                             // by the thread that pushes
  alignas(CACHE_LINE) std::atomic<std::size_t> popped_{0};
  std::size_t pushed_seen_ = 0;  // by the thread that pops
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Passes the newest value from one thread to another; older unread values are dropped.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace wholehand::device {

// One thread puts, one takes; neither ever waits for the other: no locks, no system calls, no allocation. There are three slots: each thread owns one
// and exchanges it for the third.
template <class T>
class Newest {
 public:
  Newest() = default;
  Newest(const Newest&) = delete;
  Newest& operator=(const Newest&) = delete;

  void put(const T& value) noexcept {
    places_[back_].value = value;
    back_ = between_.exchange(back_ | FRESH, std::memory_order_acq_rel) & ~FRESH;
  }

  // False: nothing was put since the last take, and `value` is unchanged.
  bool take(T& value) noexcept {
    if ((between_.load(std::memory_order_relaxed) & FRESH) == 0) return false;
    front_ = between_.exchange(front_, std::memory_order_acq_rel) & ~FRESH;
    value = places_[front_].value;
    return true;
  }

 private:
  static constexpr std::size_t CACHE_LINE = 64;  // separates what the two threads write
  static constexpr unsigned FRESH = 4;           // flag on a slot's number: put and not yet taken
  struct alignas(CACHE_LINE) Place {
    T value{};
  };

  std::array<Place, 3> places_{};
  alignas(CACHE_LINE) unsigned back_ = 0;  // owned by the putting thread
  alignas(CACHE_LINE) std::atomic<unsigned> between_{1};
  alignas(CACHE_LINE) unsigned front_ = 2;  // owned by the taking thread
};

}  // namespace wholehand::device

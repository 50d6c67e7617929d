// SPDX-License-Identifier: MIT
// A second thread that watches how long the haptic thread has been in a call of the device.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "device/loop/gripper.h"

namespace wholehand {

constexpr double CALL_PATIENCE = 12e-3;  // s: READ_PATIENCE and what a wait is longer than was asked
constexpr double CALL_LOST = 1;          // s: a call that has not returned by then is given up, and the session with it

// While it lives, a call of the gripper that does not return within CALL_PATIENCE has Gripper::release_from_watchdog() called on its own thread, once
// a call.
class CallWatch {
 public:
  // `gripper` must outlive it. Throws std::system_error where there is no thread.
  explicit CallWatch(Gripper& gripper);
  // Waits for its own call of the gripper, if there is one.
  ~CallWatch();
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;

  // ---- the haptic thread, around its calls: atomics only ----
  // `moment`: of the monotonic clock, s.
  void enter(double moment) noexcept { since_.store(moment); }
  // True: zero force has been or is being written since the last answer, and what is written next must begin at zero. After false
  // none is written on behalf of that call.
  bool leave() noexcept {
    since_.store(0);
    return has_acted_.exchange(false);
  }

  // ---- other threads ----
  // A line on the first call that did not return in time, once, as soon as it is known what became of the force.
  std::optional<std::string> take_warning();
  // Calls that did not return in time.
  int count() const noexcept { return count_.load(); }
  // For how long the call under way has not returned, s; 0: none is under way.
  double lasted() const noexcept;
  // What became of the last attempt to take the force away; not_attempted while one is under way.
  ReleaseResult outcome() const noexcept { return outcome_.load(); }

  // Whether the second thread is, or comes within CALL_LOST, out of its own call of the gripper; asked while the haptic thread is in no call. If
  // not, the destructor would wait without end.
  bool wait_for_return() const noexcept;
  // Zero force by the second thread, for a signal handler or a program that is being ended, on any thread. Waits a while; not_attempted: the
  // second thread has no answer.
  ReleaseResult rescue() noexcept;

 private:
  void run() noexcept;
  void look() noexcept;
  void act() noexcept;

  Gripper& gripper_;
  std::atomic<double> since_{0};  // s on the clock; 0: in no call
  std::atomic<bool> has_acted_{false}, is_over_{false}, is_wanted_{false}, is_answered_{false}, is_looking_{false};
  std::atomic<int> count_{0};
  std::atomic<double> acted_at_{0};  // s on the clock
  std::atomic<ReleaseResult> outcome_{ReleaseResult::no_force};
  double handled_ = 0;  // beginning of the last call that was acted upon, s on the clock
  bool was_reported_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace wholehand

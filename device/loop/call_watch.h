// SPDX-License-Identifier: MIT
// A second thread that watches how long the haptic thread has been in a device call.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "device/loop/gripper.h"

namespace wholehand::device {

constexpr double CALL_PATIENCE = 12e-3;  // s: READ_PATIENCE, plus the excess of a wait
constexpr double CALL_LOST = 1;          // s: then a call that has not returned, and the session, are given up

// While it lives, a gripper call that does not return within CALL_PATIENCE triggers Gripper::release_from_watchdog() on this object's thread, once
// per call.
class CallWatch {
 public:
  // `gripper` must outlive it. Throws std::system_error if no thread can be started.
  explicit CallWatch(Gripper& gripper);
  // Waits for its own call of the gripper, if there is one.
  ~CallWatch();
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;

  // ---- for the haptic thread, around its calls: atomics only ----
  // `moment`: of the monotonic clock, s.
  void enter(double moment) noexcept { since_.store(moment); }
  // True: zero force has been or is being written since the last answer, so the next write must begin at zero. After false, no zero force is written
  // because of that call.
  bool leave() noexcept {
    since_.store(0);
    return has_acted_.exchange(false);
  }

  // ---- for other threads ----
  // A line about the first call that did not return in time, once, as soon as the force's fate is known.
  std::optional<std::string> take_warning();
  // Number of calls that did not return in time.
  int count() const noexcept { return count_.load(); }
  // Age of the unreturned call in progress, s; 0: none is in progress.
  double lasted() const noexcept;
  // The result of the last attempt to remove the force; not_attempted during one.
  ReleaseResult outcome() const noexcept { return outcome_.load(); }

  // Whether the second thread is out of its own gripper call, or returns within CALL_LOST; only ask while the haptic thread is in no call. If false,
  // the destructor would wait forever.
  bool wait_for_return() const noexcept;
  // Has the second thread write zero force; for a signal handler or a program that is ending, on any thread. Waits briefly; not_attempted: the second
  // thread gave no answer.
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
  double handled_ = 0;  // start of the last call that it acted on, s on the clock
  bool was_reported_ = false;
  std::thread thread_;  // declared last: it uses all of the above
};

}  // namespace wholehand::device

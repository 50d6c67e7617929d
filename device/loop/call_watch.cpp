// SPDX-License-Identifier: MIT
#include "device/loop/call_watch.h"

#include <poll.h>

#include <cerrno>
#include <ctime>

#include "base/system/block_signals.h"
#include "base/system/clock.h"
#include "device/loop/realtime.h"

namespace wholehand::device {
namespace {

constexpr long LOOK_NS = 2'000'000;     // between two looks
constexpr double OWN_PATIENCE = 20e-3;  // s that its own call of the gripper may take before it counts as waiting
constexpr int RESCUE_PATIENCE = 20;     // ms: less than any watchdog that matters, and ten looks
static_assert(std::atomic<ReleaseResult>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "used in a signal handler");

}  // namespace

CallWatch::CallWatch(Gripper& gripper) : gripper_(gripper) {
  const BlockSignals inherited;
  thread_ = std::thread([this] { run(); });
}

CallWatch::~CallWatch() {
  is_over_ = true;
  thread_.join();
}

void CallWatch::run() noexcept {
  outrank_realtime();
  const timespec pause{0, LOOK_NS};
  while (!is_over_) {
    clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
    is_looking_ = true;
    look();
    is_looking_ = false;
  }
}

void CallWatch::look() noexcept {
  if (is_wanted_.exchange(false)) {
    act();
    is_answered_ = true;
  }
  const double since = since_;
  if (since == 0 || since == handled_ || monotonic_now() - since < CALL_PATIENCE) return;
  // sets the flag first, and then checks that it is still the same call: one that has returned meanwhile may not have seen the flag, and the zero
  // would come beside the next full force
  has_acted_ = true;
  if (since_ != since) {
    has_acted_ = false;
    return;
  }
  handled_ = since;
  acted_at_ = monotonic_now();
  act();
  if (outcome_ != ReleaseResult::no_force) ++count_;  // a gripper that discards forces has no call that matters
}

void CallWatch::act() noexcept {
  outcome_ = ReleaseResult::not_attempted;
  outcome_ = gripper_.release_from_watchdog();
}

std::optional<std::string> CallWatch::take_warning() {
  if (was_reported_) return std::nullopt;
  const ReleaseResult outcome = outcome_;
  const bool is_waiting = acted_at_ > 0 && outcome == ReleaseResult::not_attempted && monotonic_now() - acted_at_ >= OWN_PATIENCE;
  if (count_ == 0 && !is_waiting) return std::nullopt;
  was_reported_ = true;
  SafeLine line;
  line.add("a call of the device did not return within ").add(CALL_PATIENCE * 1e3, 3).add(" ms; meanwhile ");
  add_force_words(line, outcome, gripper_.last_written_force(), gripper_.limits().watchdog);
  return std::string(line.text());
}

double CallWatch::lasted() const noexcept {
  const double since = since_;
  return since > 0 ? monotonic_now() - since : 0;
}

bool CallWatch::wait_for_return() const noexcept {
  // counted, not timed: a process that was stopped meanwhile has not waited
  for (int k = 0; k < CALL_LOST * 1e3 && is_looking_; ++k) poll(nullptr, 0, 1);
  return !is_looking_;
}

ReleaseResult CallWatch::rescue() noexcept {
  const int saved = errno;
  is_answered_ = false;
  is_wanted_ = true;
  for (int k = 0; k < RESCUE_PATIENCE && !is_answered_; ++k) poll(nullptr, 0, 1);
  errno = saved;
  return is_answered_ ? outcome_.load() : ReleaseResult::not_attempted;
}

}  // namespace wholehand::device

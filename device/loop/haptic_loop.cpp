// SPDX-License-Identifier: MIT
#include "device/loop/haptic_loop.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "base/system/clock.h"
#include "core/vectors.h"
#include "device/loop/panic.h"

namespace wholehand::device {
namespace {

void sleep_until(double moment) noexcept {
  timespec time{};
  time.tv_sec = static_cast<time_t>(std::floor(moment));
  time.tv_nsec = static_cast<long>((moment - std::floor(moment)) * 1e9);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace

HapticLoop::HapticLoop(const LiveData& live, Gripper& gripper, Session& session, TickSink sink, const LoopOptions& options)
    : live_(live),
      gripper_(gripper),
      session_(session),
      sink_(std::move(sink)),
      options_(options),
      guard_(live, gripper.limits()),
      period_(1 / live.rate) {}

void HapticLoop::run(const std::atomic<bool>& stop) noexcept {
  gripper_.begin();
  start_ = clock() + period_;
  for (std::int64_t number = next_number(-1);; number = next_number(number)) {
    const double due = start_ + period_ * static_cast<double>(number);
    if (!options_.is_simulated) sleep_until(due);
    number = number_now(number);
    if (stop.load(std::memory_order_relaxed)) return end(Fault::interrupted, number);
    if (is_over(number) || gripper_.is_done()) return end(Fault::none, number);
    if (!step(number, due)) return;
    number = report_.last.number;
  }
}

bool HapticLoop::is_over(std::int64_t number) const noexcept {
  return options_.seconds > 0 && period_ * static_cast<double>(number) >= options_.seconds;
}

// s on the clock; 0 where there is none.
double HapticLoop::clock() const noexcept { return options_.is_simulated ? 0 : monotonic_now(); }

// The next tick that is not over yet. A replay dictates the recorded number.
std::int64_t HapticLoop::next_number(std::int64_t number) noexcept {
  const std::int64_t replayed = gripper_.replayed_tick();
  if (replayed > number) return replayed;
  return number < 0 ? number + 1 : number_now(number + 1);
}

// The tick by the clock, `number` or later; the ticks in between are missed. After a stall it is at least so late that the guard sees the stall in
// the numbers, from which a replay makes the same forces.
std::int64_t HapticLoop::number_now(std::int64_t number) noexcept {
  if (options_.is_simulated || gripper_.replayed_tick() >= 0) return number;
  const double moment = clock();
  auto passed = static_cast<std::int64_t>(std::floor((moment - start_) / period_));
  if (wrote_ > 0 && (has_stalled_ || moment - wrote_ >= STALL)) passed = std::max(passed, wrote_in_ + guard_.stall_periods());
  has_stalled_ = false;
  if (passed <= number) return number;
  const auto last = options_.seconds > 0 ? static_cast<std::int64_t>(std::ceil(options_.seconds / period_)) : passed;
  report_.missed += std::max<std::int64_t>(0, std::min(passed, last) - number);
  sleep_until(start_ + period_ * static_cast<double>(passed));
  return passed;
}

void HapticLoop::enter(double moment) noexcept {
  if (options_.watch) options_.watch->enter(moment);
}

void HapticLoop::leave() noexcept {
  if (options_.watch && options_.watch->leave()) has_stalled_ = true;
}

// A late measurement belongs to the tick in which it arrives.
ReadOutcome HapticLoop::read(std::int64_t& number, Tick& tick) noexcept {
  const double began = clock();
  enter(began);
  const ReadOutcome outcome = gripper_.read(state_, number);
  leave();
  read_ = clock();
  read_time_ = read_ - began;
  if (read_time_ >= CALL_PATIENCE || has_stalled_ || (wrote_ > 0 && read_ - wrote_ >= STALL)) number = number_now(number);
  tick.number = number;
  tick.read = outcome;
  tick.device = state_;
  return outcome;
}

bool HapticLoop::step(std::int64_t number, double due) noexcept {
  const double woke = clock();
  Tick& tick = report_.last;
  const std::int64_t planned = number;
  const ReadOutcome outcome = read(number, tick);
  if (number > planned && is_over(number)) {
    release(Fault::none, tick);
    return false;
  }
  // what a recording dictates was on time when recorded
  const bool is_late = late_ >= live_.late_steps && gripper_.replayed_tick() < 0;
  const Fault fault = is_late ? Fault::late : guard_.check(outcome, state_, number);
  if (fault != Fault::none) {
    release(fault, tick);
    return false;
  }
  session_.step(state_, number, tick);
  tick.read = outcome;
  tick.device = state_;
  if (!is_finite(tick.wanted)) {
    release(Fault::not_finite, tick);
    return false;
  }
  tick.written = guard_.limit(tick.wanted, number);
  const bool is_written = write(tick);
  if (!options_.is_simulated) {
    tick.latency = woke - start_ - period_ * static_cast<double>(tick.number);
    tick.step_time = clock() - read_;
    report_.latency.add(woke - due);
    report_.step.add(tick.step_time);
    if (woke_ > 0) report_.period.add(woke - woke_);
    woke_ = woke;
    late_ = tick.step_time > period_ || read_time_ > CALL_PATIENCE ? late_ + 1 : 0;
    if (late_ > 0) ++report_.late;
  }
  ++report_.ticks;
  if (!is_written) {
    release(Fault::write_error, tick);
    return false;
  }
  if (sink_ && !sink_(tick)) {
    release(Fault::ring_full, tick);
    return false;
  }
  gripper_.show(tick);
  return true;
}

// Zero after a stall, because the device may have released its force. A stall that the numbers did not show yet lay between measurement and here.
bool HapticLoop::write(Tick& tick) noexcept {
  const double began = clock();
  const bool is_old =
      wrote_ > 0 && began - wrote_ >= STALL && tick.number - wrote_in_ < guard_.stall_periods() && gripper_.replayed_tick() < 0;
  if (is_old || gripper_.replays_zero() || is_releasing()) tick.written = {};
  if (is_old) has_stalled_ = true;
  gripper_.set_last_written_force(tick.written);
  enter(began);
  const bool is_written = gripper_.write(tick.written);
  leave();
  wrote_ = began;
  wrote_in_ = tick.number;
  if (is_written) report_.force = tick.written;
  return is_written;
}

void HapticLoop::end(Fault fault, std::int64_t number) noexcept {
  Tick tick = report_.last;
  tick.number = number;
  release(fault, tick);
}

// Zero force, at once and without slew; the report keeps the last tick.
void HapticLoop::release(Fault fault, Tick& tick) noexcept {
  // records the fault and its words first: releasing may have words of its own, or may not return
  std::snprintf(last_error_.data(), last_error_.size(), "%s", gripper_.last_error());
  tick.state = SessionState::released;
  tick.fault = fault;
  tick.wanted = tick.written = {};
  tick.coupling = {};
  tick.feedback = tick.user_force = tick.weight = 0;
  report_.last = tick;
  report_.fault = fault;
  is_ending_ = true;
  enter(clock());
  report_.release = gripper_.release();
  leave();
  if (report_.release == ReleaseResult::refused) {
    std::snprintf(release_error_.data(), release_error_.size(), "%s", gripper_.last_error());
  } else {
    gripper_.set_last_written_force({});
  }
  release_ = report_.release;
  try {
    report_.error = last_error_.data();
    report_.release_error = release_error_.data();
  } catch (...) {  // no memory for words
  }
  if (sink_) sink_(tick);
}

std::optional<LoopReport> HapticLoop::ending() const {
  if (!is_ending_) return std::nullopt;
  LoopReport ending;
  ending.fault = report_.fault;
  ending.error = last_error_.data();
  ending.release = release_;
  if (ending.release == ReleaseResult::refused) ending.release_error = release_error_.data();
  ending.force = report_.force;
  ending.ticks = report_.ticks;
  ending.missed = report_.missed;
  ending.late = report_.late;
  ending.period = report_.period;
  ending.latency = report_.latency;
  ending.step = report_.step;
  ending.last = report_.last;
  return ending;
}

}  // namespace wholehand::device

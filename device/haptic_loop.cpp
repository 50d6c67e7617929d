#include "device/haptic_loop.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

namespace wholehand {
namespace {

double now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

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
  if (!options_.is_simulated) start_ = now() + period_;
  std::int64_t number = next_number(-1);
  for (;;) {
    const double time = period_ * static_cast<double>(number);
    if (!options_.is_simulated) sleep_until(start_ + time);
    if (stop.load(std::memory_order_relaxed)) {
      Tick tick = report_.last;
      tick.number = number;
      release(Fault::interrupted, tick);
      break;
    }
    if ((options_.seconds > 0 && time >= options_.seconds) || gripper_.is_done()) {
      Tick tick = report_.last;
      tick.number = number;
      release(Fault::none, tick);
      break;
    }
    if (!step(number, start_ + time)) break;
    number = next_number(number);
  }
}

// The next tick that is not over yet. A replay dictates the number that was recorded.
std::int64_t HapticLoop::next_number(std::int64_t number) noexcept {
  const std::int64_t dictated = gripper_.dictated_tick();
  if (dictated > number) return dictated;
  if (options_.is_simulated || number < 0) return number + 1;
  const auto passed = static_cast<std::int64_t>(std::floor((now() - start_) / period_));
  if (passed <= number + 1) return number + 1;
  const auto last = options_.seconds > 0 ? static_cast<std::int64_t>(std::ceil(options_.seconds / period_)) : passed;
  report_.missed += std::max<std::int64_t>(0, std::min(passed, last) - number - 1);
  return passed;
}

bool HapticLoop::step(std::int64_t number, double due) noexcept {
  const double woke = options_.is_simulated ? 0 : now();
  Tick& tick = report_.last;
  const ReadOutcome read = gripper_.read(state_, number);
  const double began = options_.is_simulated ? 0 : now();
  // what a recording dictates was on time when it counted
  const bool is_late = late_ >= live_.late_steps && gripper_.dictated_tick() < 0;
  const Fault fault = is_late ? Fault::late : guard_.check(read, state_, number);
  if (fault != Fault::none) {
    tick.number = number;
    tick.read = read;
    tick.device = state_;
    release(fault, tick);
    return false;
  }
  session_.step(state_, number, tick);
  tick.read = read;
  tick.device = state_;
  const double size = std::hypot(tick.wanted.arm[0], tick.wanted.arm[1], tick.wanted.arm[2]) + std::abs(tick.wanted.grip);
  if (!std::isfinite(size)) {
    release(Fault::not_finite, tick);
    return false;
  }
  tick.written = guard_.limit(tick.wanted, number);
  const bool is_written = gripper_.write(tick.written);
  if (!options_.is_simulated) {
    const double done = now();
    tick.latency = woke - due;
    tick.step_time = done - began;
    report_.latency.add(tick.latency);
    report_.step.add(tick.step_time);
    if (woke_ > 0) report_.period.add(woke - woke_);
    woke_ = woke;
    late_ = tick.step_time > period_ ? late_ + 1 : 0;
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

// No force, at once and without slew; what was last is told with it.
void HapticLoop::release(Fault fault, Tick& tick) noexcept {
  gripper_.let_go();
  tick.state = SessionState::released;
  tick.fault = fault;
  tick.wanted = tick.written = {};
  tick.coupling = {};
  tick.feedback = tick.user_force = tick.weight = 0;
  report_.last = tick;
  report_.fault = fault;
  try {
    report_.trouble = gripper_.trouble();
  } catch (...) {  // no memory for words
  }
  if (sink_) sink_(tick);
}

}  // namespace wholehand

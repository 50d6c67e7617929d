// The haptic loop: ties a gripper to a session, tick by tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "core/session.h"
#include "device/gripper.h"
#include "device/guard.h"
#include "device/histogram.h"

namespace wholehand {

struct LoopOptions {
  double seconds = 0;         // after which it ends; 0: when the gripper is done, or never
  bool is_simulated = false;  // no clock: a tick follows the other at once, and no time is measured
};

// How a loop went.
struct LoopReport {
  Fault fault = Fault::none;
  std::string trouble;  // the gripper's words for it
  std::int64_t ticks = 0;
  std::int64_t missed = 0;  // periods without a tick, since the one before took too long
  std::int64_t late = 0;    // steps that took longer than a period
  Histogram period;         // between two wakings
  Histogram latency;        // from a tick's time to its waking
  Histogram step;           // Tick::step_time
  Tick last;
};

// Where each tick goes; false: it is full. Called on the haptic thread.
using TickSink = std::function<bool(const Tick&)>;

class HapticLoop {
 public:
  // All that it needs is allocated here. `gripper` and `session` must outlive it. The sink may be empty.
  HapticLoop(const LiveData& live, Gripper& gripper, Session& session, TickSink sink, const LoopOptions& options);

  // Runs until the time is over, the gripper is done, `stop` is set, or a fault: in each case zero force is the last that is written.
  // Read, guard, session, limits, write, sink, in this order; nothing else happens between two ticks but waiting. Does not throw.
  void run(const std::atomic<bool>& stop) noexcept;

  const LoopReport& report() const noexcept { return report_; }
  const Guard& guard() const noexcept { return guard_; }

 private:
  bool step(std::int64_t number, double due) noexcept;
  void release(Fault fault, Tick& tick) noexcept;
  std::int64_t next_number(std::int64_t number) noexcept;

  LiveData live_;
  Gripper& gripper_;
  Session& session_;
  TickSink sink_;
  LoopOptions options_;
  Guard guard_;
  double period_;       // s
  double start_ = 0;    // of tick 0, s on the clock
  double woke_ = 0;     // s on the clock; 0: not yet
  int late_ = 0;        // steps in a row
  GripperState state_;  // of the last read
  LoopReport report_;
};

}  // namespace wholehand

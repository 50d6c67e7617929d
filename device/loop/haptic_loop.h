// SPDX-License-Identifier: MIT
// The haptic loop: ties a gripper to a session, tick by tick.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "device/loop/call_watch.h"
#include "device/loop/gripper.h"
#include "device/loop/guard.h"
#include "device/loop/histogram.h"
#include "device/session/session.h"

namespace wholehand {

struct LoopOptions {
  double seconds = 0;          // after which it ends; 0: when the gripper is done, or never
  bool is_simulated = false;   // no clock: a tick follows the other at once, and no time is measured
  CallWatch* watch = nullptr;  // of the gripper's calls; must outlive the loop
};

// How a loop went.
struct LoopReport {
  Fault fault = Fault::none;
  std::string error;                                // the gripper's words for it
  ReleaseResult release = ReleaseResult::no_force;  // what became of the force at the end
  std::string release_error;                        // the gripper's words where zero force was not taken
  GripperForce force;                               // the last that the device took before
  std::int64_t ticks = 0;
  std::int64_t missed = 0;  // periods without a tick, since the one before took too long
  std::int64_t late = 0;    // steps that took longer than a period, or whose read took longer than CALL_PATIENCE
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

  // Runs until the time is over, the gripper is done, `stop` is set, or a fault: in each case zero force is the last that is written. The first
  // write after a stall of the process (STALL) or a call that took longer than CALL_PATIENCE is zero as well.
  // Read, guard, session, limits, write, sink, in this order; nothing else happens between two ticks but waiting. Does not throw.
  void run(const std::atomic<bool>& stop) noexcept;

  const LoopReport& report() const noexcept { return report_; }
  // The report of a loop that has come to its end, from any thread, also while its last call of the gripper has not returned:
  // release is not_attempted then. Nothing: it still runs.
  std::optional<LoopReport> ending() const;
  const Guard& guard() const noexcept { return guard_; }

 private:
  bool is_over(std::int64_t number) const noexcept;
  bool step(std::int64_t number, double due) noexcept;
  ReadOutcome read(std::int64_t& number, Tick& tick) noexcept;
  bool write(Tick& tick) noexcept;
  void end(Fault fault, std::int64_t number) noexcept;
  void release(Fault fault, Tick& tick) noexcept;
  std::int64_t next_number(std::int64_t number) noexcept;
  std::int64_t number_now(std::int64_t number) noexcept;
  void enter(double moment) noexcept;
  void leave() noexcept;
  double clock() const noexcept;

  LiveData live_;
  Gripper& gripper_;
  Session& session_;
  TickSink sink_;
  LoopOptions options_;
  Guard guard_;
  double period_;              // s
  double start_ = 0;           // of tick 0, s on the clock
  double woke_ = 0;            // s on the clock; 0: not yet
  double read_ = 0;            // when the last measurement was there, s on the clock
  double wrote_ = 0;           // when the last write was begun, s on the clock; 0: not yet
  std::int64_t wrote_in_ = 0;  // its tick
  double read_time_ = 0;       // s that the last read took
  bool has_stalled_ = false;   // the force must begin at zero
  int late_ = 0;               // steps in a row
  GripperState state_;         // of the last read
  LoopReport report_;
  // words of report_, before they are strings; set before the flags below
  std::array<char, 200> last_error_{}, release_error_{};
  std::atomic<bool> is_ending_{false};  // all of report_ stays as it is, but for what became of the force
  std::atomic<ReleaseResult> release_{ReleaseResult::not_attempted};
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The haptic loop: connects a gripper to a session, tick by tick.
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

namespace wholehand::device {

struct LoopOptions {
  double seconds = 0;          // duration; 0: until the gripper is done, or forever
  bool is_simulated = false;   // no clock: one tick follows another at once, and no time is measured
  CallWatch* watch = nullptr;  // of the gripper's calls; must outlive the loop
};

// How a loop went.
struct LoopReport {
  Fault fault = Fault::none;
  std::string error;                                // the gripper's words for it
  ReleaseResult release = ReleaseResult::no_force;  // the force's fate at the end
  std::string release_error;                        // the gripper's words if it did not accept zero force
  GripperForce force;                               // the last that the device accepted before
  std::int64_t ticks = 0;
  std::int64_t missed = 0;  // periods without a tick, because the previous one took too long
  std::int64_t late = 0;    // steps longer than a period, or whose read took longer than CALL_PATIENCE
  Histogram period;         // between two wakings
  Histogram latency;        // from a tick's time to its waking
  Histogram step;           // Tick::step_time
  Tick last;
};

// Receives each tick; false: it is full. Called on the haptic thread.
using TickSink = std::function<bool(const Tick&)>;

class HapticLoop {
 public:
  // Allocates everything that it needs. `gripper` and `session` must outlive it. The sink may be empty.
  HapticLoop(const LiveData& live, Gripper& gripper, Session& session, TickSink sink, const LoopOptions& options);

  // Runs until the time is over, the gripper is done, `stop` is set, or a fault; in each case the last write is zero force. The first write after a
  // stall of the process (STALL) or a call longer than CALL_PATIENCE is also zero. Between two ticks it only does this, in order: read, guard,
  // session, limits, write, sink, wait. Does not throw.
  void run(const std::atomic<bool>& stop) noexcept;

  const LoopReport& report() const noexcept { return report_; }
  // The report of a loop that has ended; from any thread, even while its last gripper call has not returned (release is then not_attempted). Nothing:
  // it still runs.
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
  double read_ = 0;            // when the last measurement arrived, s on the clock
  double wrote_ = 0;           // when the last write was begun, s on the clock; 0: not yet
  std::int64_t wrote_in_ = 0;  // its tick
  double read_time_ = 0;       // s, duration of the last read
  bool has_stalled_ = false;   // the force must begin at zero
  int late_ = 0;               // steps in a row
  GripperState state_;         // of the last read
  LoopReport report_;
  // words of report_, before they become strings; set before the flags below
  std::array<char, 200> last_error_{}, release_error_{};
  std::atomic<bool> is_ending_{false};  // all of report_ is final, except the force's fate
  std::atomic<ReleaseResult> release_{ReleaseResult::not_attempted};
};

}  // namespace wholehand::device

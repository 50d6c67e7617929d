// SPDX-License-Identifier: MIT
// A whole live session: the haptic thread, and beside it recording, displays, advice and messages.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/system/interrupt.h"
#include "base/text/error.h"
#include "device/advice/live_advice.h"
#include "device/loop/haptic_loop.h"
#include "device/recordings/recorder.h"
#include "device/run/board.h"
#include "device/run/display_loop.h"
#include "device/session/session.h"
#include "device/session/tick_ring.h"

namespace wholehand::device {

struct LiveRunOptions {
  double seconds = 0;                     // 0: until the gripper is done, or forever
  bool has_clock = true;                  // false: as fast as possible
  bool json = false;                      // prints only the report at the end on standard output
  std::string record;                     // file; empty: none
  const char* record_name = "recording";  // what messages call it
  std::uint64_t seed = 1;                 // for the recording: of the simulated user, and
  std::optional<std::uint64_t> person;    // the virtual person's number
  LiveAdvice* advice = nullptr;           // null: none
};

class LiveRun {
 public:
  // All must outlive it. Allocates what the haptic thread needs.
  LiveRun(const Scene& scene, Gripper& gripper, const LiveRunOptions& options);

  const LiveScene& live() const { return session_.live(); }
  // Before run(). The display must live until run() has returned.
  void add(Display& display) { displays_.push_back(&display); }
  // A line for the report.
  void add_note(const std::string& line) { notes_.push_back(line); }

  // Runs the session, and prints events and a final report. `begin` is called just before it starts, once nothing can be refused any more. Returns
  // done, or interrupted after a signal or when nobody reads the output any more (a session without a clock goes on); failure: the recording lies
  // elsewhere. Throws Error (failure): the recording cannot be made or is not whole, or a fault ended the session. If a device call does not return,
  // it ends the process itself, with the line and the exit code of a failure.
  ExitCode run(const std::function<void()>& begin);

 private:
  TickSink sink();
  void loop_thread(InterruptGuard& interrupt, Recorder& recorder);
  [[noreturn]] void give_up(InterruptGuard& interrupt, Recorder& recorder);
  std::string fault_words(const LoopReport& report) const;
  void note(const std::string& line);
  void report_recording_error(Recorder& recorder);
  void report_advice();
  void report_warnings();
  void print_summary(const LoopReport& report, const Recorder& recorder, bool is_recorded, bool has_times);

  const Scene& scene_;
  Gripper& gripper_;
  LiveRunOptions options_;
  std::vector<std::string> notes_;
  std::vector<Display*> displays_;
  Board board_;
  std::unique_ptr<CallWatch> watch_;  // of a session with a clock
  Session session_;
  TickRing ring_;
  HapticLoop loop_;
};

}  // namespace wholehand::device

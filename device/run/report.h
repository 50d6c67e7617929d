// SPDX-License-Identifier: MIT
// The report of a live session: events during it, numbers after it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "device/advice/live_advice.h"
#include "device/loop/haptic_loop.h"
#include "device/session/amounts.h"
#include "device/session/tick.h"

namespace wholehand::device {

// Turns ticks, of which some may be missing, into lines for people.
class Narrator {
 public:
  // `scene` must outlive it.
  explicit Narrator(const Scene& scene);
  // Lines for what has happened since the previous tick: the guidance points of a new task, grasped, put down, lost, delivered, poured; each with the
  // time, s.
  std::vector<std::string> look(const Tick& tick);
  // One line for a status that is redrawn: state, tilt, force, amounts.
  std::string status(const Tick& tick) const;

 private:
  std::string stamp(const Tick& tick) const;
  std::string guidance(const Tick& tick) const;
  const Scene& scene_;
  Tick last_;
};

// Prints a line for each new situation (the hand comes near a vessel, a grasp), once its advice exists.
class AdviceNarrator {
 public:
  explicit AdviceNarrator(const Scene& scene) : rate_(scene.live.rate), scene_(scene) {}
  // Nothing: the same vessel, still free or still held, or nothing to advise.
  std::optional<std::string> narrate(const Advice& advice);

 private:
  double rate_;
  const Scene& scene_;
  int vessel_ = -1;
  bool is_held_ = false;
};

// The report at the end, as text or as JSON (times in s). `notes`: lines about missing permissions.
struct LiveSummary {
  const Scene& scene;
  const GripperLimits& gripper;
  const LoopReport& loop;
  double seconds = 0;  // of session time
  bool has_clock = true;
  std::vector<std::string> notes;
  std::string recording;    // the file; empty: none
  bool is_recorded = true;  // all of it
  std::optional<AdviceTally> advice{};
  bool is_by_signal = true;  // it was interrupted; a note names another cause
};
std::string live_text(const LiveSummary& summary);
std::string live_json(const LiveSummary& summary);

// "computed on vulkan, llvmpipe (..): 312 updates of 1,024 grips on average, 9.8 a second, no two further apart than 0.15 s".
std::string tally_words(const AdviceTally& tally);

// "live: a fault ended the session after 2.004 s: read error (unplugged); zero force was written": the line for a session that a fault ended, with
// the finding, the limit, and the force's fate. Also for a session without a fault that left a force on the device.
std::string fault_line(const LoopReport& report, const Guard& guard, const LiveData& live, double watchdog);
// Whether the device did not accept zero force at the end.
bool is_force_left(const LoopReport& report);
// The force's fate at the end of a session; `watchdog`: the device's, s.
std::string force_words(const LoopReport& report, double watchdog);

}  // namespace wholehand::device

// What a live session tells: events while it runs, numbers when it is over.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"
#include "core/tick.h"
#include "device/haptic_loop.h"

namespace wholehand {

// Turns ticks, some of which may be left out, into lines for people.
class Narrator {
 public:
  // `scene` must outlive it.
  explicit Narrator(const Scene& scene);
  // Lines for what has happened since the tick before: the guidance points of a new task, grasped, put down, lost,
  // delivered, poured; each with the time, s.
  std::vector<std::string> look(const Tick& tick);
  // One line for a status that is overwritten: state, tilt, force, amounts.
  std::string status(const Tick& tick) const;

 private:
  std::string stamp(const Tick& tick) const;
  std::string guidance(const Tick& tick) const;
  const Scene& scene_;
  Tick last_;
};

// The paper's mixing board: of each liquid that a task wants what is in the target, m3.
struct MixedAmount {
  std::string liquid;
  double arrived = 0, wanted = 0, spilt = 0;
};
std::vector<MixedAmount> mixing_board(const Scene& scene, const Tick& tick);
// m3: of a liquid in the target, and of all vessels beside it. They allocate nothing.
double total_arrived(const Scene& scene, const Tick& tick, std::string_view liquid);
double total_spilt(const Scene& scene, const Tick& tick);

// The report at the end, as text or as JSON (times in s). `notes`: lines on what was not permitted.
struct LiveSummary {
  const Scene& scene;
  const GripperLimits& gripper;
  const LoopReport& loop;
  double seconds = 0;  // of the session's own time
  bool has_clock = true;
  std::vector<std::string> notes;
  std::string recording;    // the file; empty: none
  bool is_recorded = true;  // all of it
};
std::string live_text(const LiveSummary& summary);
std::string live_json(const LiveSummary& summary);

// "released after 2.004 s: read error (unplugged)": the line for a session that ended by a fault, with what was found and what is allowed.
std::string fault_line(const LoopReport& report, const Guard& guard, const LiveData& live);

}  // namespace wholehand

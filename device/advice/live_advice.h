// SPDX-License-Identifier: MIT
// The advice of a running session.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/advice/advice.h"
#include "device/session/vessel_tracker.h"
#include "device/simulated/shown_grip.h"

namespace wholehand::device {

// The advice in a session's report.
struct AdviceTally {
  std::string place;            // what it is computed on
  std::uint64_t updates = 0;    // with a vessel near
  std::uint64_t grips = 0;      // asked for in them
  double longest = 0;           // s between two consecutive such updates
  double seconds = 0;           // total of these, s
  std::uint64_t intervals = 0;  // number of intervals

  double rate() const { return seconds > 0 ? static_cast<double>(intervals) / seconds : 0; }  // updates a second
};

class LiveAdvice {
 public:
  virtual ~LiveAdvice() = default;
  // Takes ticks in order, from one thread, with the vessels at `poses`.
  virtual void look(const Tick& tick, const VesselPoses& poses) = 0;
  // For a simulated user who follows it, on the haptic thread.
  virtual ShownGripSource& shown() = 0;

  // From any thread. The newest advice, the same object until the next, or nothing.
  virtual std::shared_ptr<const Advice> newest() const = 0;
  // Lines that the user must see, each once.
  virtual std::vector<std::string> take_warnings() = 0;
  virtual AdviceTally tally() const = 0;
};

}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// A grip shown to the user of a simulated gripper, like a ghost hand on a screen.
#pragma once

#include <cstdint>

#include "core/result.h"
#include "device/session/newest.h"
#include "device/simulated/pour_path.h"

namespace wholehand::device {

// In the world of the right hand; at azimuth and offset 0. A copy allocates nothing.
struct ShownGrip {
  int vessel = -1;  // -1: only the planned grip is shown
  GripInput grip;
  double gap = 0;  // of the hand there, m
  PourPath path;   // middle of the tips while it pours from this grip
};

// Supplies the shown grips to the haptic thread. Neither waits, allocates nor throws.
class ShownGripSource {
 public:
  virtual ~ShownGripSource() = default;
  // Returns false, and leaves `grip` unchanged, if nothing new was shown since the last call. `tick`: the session's.
  virtual bool take(std::int64_t tick, ShownGrip& grip) noexcept = 0;
};

// Another thread puts them.
class ShownGrips final : public ShownGripSource {
 public:
  void put(const ShownGrip& grip) noexcept { newest_.put(grip); }
  bool take(std::int64_t /*tick*/, ShownGrip& grip) noexcept override { return newest_.take(grip); }

 private:
  Newest<ShownGrip> newest_;
};

}  // namespace wholehand::device

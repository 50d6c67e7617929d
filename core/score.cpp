// SPDX-License-Identifier: MIT
#include "core/score.h"

#include <algorithm>
#include <cmath>

namespace CORE_NS {

Real fingers_term(int fingers_used) { return Real(fingers_used) / Real(FINGERS); }

Real contacts_term(int points_touching) { return Real(points_touching) / Real(JOINTS); }

Real depth_term(Real phalanx_depth, Real palm_depth) {
  return Real(1) - std::min(Real(1), std::max(phalanx_depth, palm_depth) / Real(DEPTH_SCALE));
}

Real posture_term(Real closure) { return Real(1) - std::abs(Real(2) * closure - Real(1)); }

Real force_term(Real largest_feedback, Real max) { return max > 0 ? Real(1) - largest_feedback / max : Real(0); }

Real hold_term(Real largest_hold, Real grip_strength) {
  return largest_hold > grip_strength ? grip_strength / largest_hold : Real(1);
}

}  // namespace CORE_NS

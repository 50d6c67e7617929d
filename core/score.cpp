// SPDX-License-Identifier: MIT
#include "core/score.h"

#include <algorithm>
#include <cmath>

namespace CORE_NS {

// score = sum of weight x term (core/scene_states weighs them). Each term is in [0, 1] and larger is better:
//   fingers   fingers used / 5                    contacts   points touching / 24
//   depth     1 - min(1, deepest / 10 mm)         posture    1 - |2 c - 1|
//   force     1 - largest feedback / F_max        hold       min(1, grip strength / largest hold force)
// In a scene with an arm the posture term is the mean of that and 1 - min(1, share of the wrist's range).
// In a scene with efforts the hold term is 1 / (1 + worst effort), and the score of a grip that does not hold is 0.
// Degenerate: an F_max of 0 gives the force term 0; an infinite hold force gives the hold term 0.
Real fingers_term(int fingers_used) { return Real(fingers_used) / Real(FINGERS); }

Real contacts_term(int points_touching) { return Real(points_touching) / Real(JOINTS); }

Real depth_term(Real phalanx_depth, Real palm_depth) {
  return Real(1) - std::min(Real(1), std::max(phalanx_depth, palm_depth) / Real(DEPTH_SCALE));
}

Real posture_term(Real closure) { return Real(1) - std::abs(Real(2) * closure - Real(1)); }

Real wrist_term(Real posture, Real wrist_share) { return Real(0.5) * (posture + Real(1) - std::min(Real(1), wrist_share)); }

Real force_term(Real largest_feedback, Real max) { return max > 0 ? Real(1) - largest_feedback / max : Real(0); }

Real hold_term(Real largest_hold, Real grip_strength) {
  return largest_hold > grip_strength ? grip_strength / largest_hold : Real(1);
}

Real effort_term(Real worst_effort) { return Real(1) / (Real(1) + worst_effort); }

// All of the strength is enough. A worst effort belongs to forces that were found, and is up to 1e-3 above the least, so a grip that counts as held
// is held.
bool effort_holds(Real worst_effort) { return worst_effort <= Real(1); }

}  // namespace CORE_NS

// SPDX-License-Identifier: MIT
// Twin of core/score.cpp.
#ifndef SCORE_GLSL
#define SCORE_GLSL

#include "real.glsl"

Real fingers_term(int fingers_used) { return Real(fingers_used) / Real(FINGERS); }
Real contacts_term(int points_touching) { return Real(points_touching) / Real(JOINTS); }

Real depth_term(Real phalanx_depth, Real palm_depth) { return Real(1) - min(Real(1), max(phalanx_depth, palm_depth) / DEPTH_SCALE); }

Real posture_term(Real closure) { return Real(1) - abs(Real(2) * closure - Real(1)); }
Real wrist_term(Real posture, Real wrist_share) { return Real(0.5) * (posture + Real(1) - min(Real(1), wrist_share)); }
Real force_term(Real largest_feedback, Real max) { return max > Real(0) ? Real(1) - largest_feedback / max : Real(0); }

Real hold_term(Real largest_hold, Real grip_strength) {
  return largest_hold > grip_strength ? grip_strength / largest_hold : Real(1);
}

Real effort_term(Real worst_effort) { return Real(1) / (Real(1) + worst_effort); }
bool effort_holds(Real worst_effort) { return worst_effort <= Real(1); }

#endif

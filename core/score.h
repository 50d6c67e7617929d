// SPDX-License-Identifier: MIT
// Scores of a grip: each term in [0, 1], larger is better; the weights come from the scene.
#pragma once

#include "core/real.h"

namespace CORE_NS {

// Fingers used / 5, and points touching / 24.
Real fingers_term(int fingers_used);
Real contacts_term(int points_touching);
// 1 - min(1, deepest / 10 mm); m.
Real depth_term(Real phalanx_depth, Real palm_depth);
// 1 - |2 c - 1|.
Real posture_term(Real closure);
// The same in a scene with an arm: its mean with 1 - min(1, share of the wrist's range).
Real wrist_term(Real posture, Real wrist_share);
// 1 - largest feedback force over all states / F_max, N; 0 if F_max is 0.
Real force_term(Real largest_feedback, Real max);
// min(1, grip strength / largest hold force over all states), N; 0 if the hold force is infinite.
Real hold_term(Real largest_hold, Real grip_strength);

// The same in a scene with efforts: 1 / (1 + worst effort); 0 if it is infinite.
Real effort_term(Real worst_effort);
// Whether a grip with that worst effort holds: up to 1.
bool effort_holds(Real worst_effort);

}  // namespace CORE_NS

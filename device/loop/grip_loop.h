// SPDX-License-Identifier: MIT
// The held state as a loop: a gripper that pushes the fingers apart with the feedback force, and a user who holds a grip force.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

// One session of holding and tilting; SI. x is how far the fingers have closed since the grasp, g_grasp - g.
//
//   gripper and finger   (m_d + m_f) x'' + (b_d + b_f) x' + k_f x = f - F
//   feedback             F = clamp(F_base + F_range tau / tau_ref + k_open x, 0, F_max), once a sample and held
//   user                 f' = (G_wanted - G(t - reaction)) / response, 0 at the grasp and never a pull
//
// f is the force of the user's muscles, behind the finger's impedance. G is the user's grip force, F less what the torque has added since
// the grasp; its target is F_base + excess.
struct GripLoop {
  double base = 0.8, range = 3, k_open = 600, max = 8;  // F_base, F_range, F_max: N; N/m
  double rate = 1000;                                   // Hz
  double device_mass = 0.05, device_damping = 0.5;      // the gripper's jaw
  double finger_mass = 0.012, finger_damping = 4, finger_stiffness = 500;
  double reaction = 0.075, response = 0.15;  // s
  double excess = 3;                         // N beyond F_base that the user holds
  double tilt = 1.5707963267948966;          // rad
  double tilt_speed = 0.43;                  // rad/s
  double band = 8e-3;                        // m of opening beyond the grasp at which it is lost
};

enum class GripOutcome { settles, creeps, oscillates, saturates, lost };
constexpr int GRIP_OUTCOMES = 5;
extern const char* const GRIP_OUTCOME_NAMES[GRIP_OUTCOMES];

struct GripLoopResult {
  GripOutcome outcome = GripOutcome::settles;
  double response_time = 0;  // from the grasp until the gap's speed stays under 2 mm/s for 50 ms; NaN: never before the tilt
  double overshoot = 0;      // of x before the tilt, over where it then is; at least 0
  double opened = 0;         // furthest below the place at the tilt's begin, m
  double swing = 0;          // of x in the end, m
};

// Two seconds to grasp, the tilt, and two seconds and ten reactions to settle. The grip is lost where x falls below -band; oscillates where
// x still rises and falls by more than GRIP_SWING in the end (half a second, or five reactions: more than a period of the user's loop at
// its limit), creeps where it only does one of them; saturates where the feedback is then at F_max throughout, so that the user feels neither torque
// nor grip and closes on.
GripLoopResult hold_and_tilt(const GripLoop& loop);
constexpr double GRIP_SWING = 0.2e-3;  // m

// Whether what a step of F_base sets in motion dies away: by simulation without tilt, clamp or band.
bool decays(const GripLoop& loop);
// The largest k_open, N/m, at which it does, found as largest_stable does.
double largest_k_open(const GripLoop& loop);
// By theory: where the sampled spring and the finger are linearly stable (no user), and where the user's delayed integral is: k_open /
// (k_f + k_open) reaction / response < pi / 2. Infinite where nothing limits it.
double sampled_k_open(const GripLoop& loop);
double reaction_k_open(const GripLoop& loop);

// The sessions of the report: every value of one parameter with the others at their defaults, and the products of the five that decide.
struct GripLoopRow {
  std::string varied;
  GripLoop loop;
  GripLoopResult result;
};
std::vector<GripLoopRow> grip_loop_rows(bool quick);
std::string grip_loop_csv(const std::vector<GripLoopRow>& rows, const std::string& run);  // `run` as for wall_limits_csv

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The held state as a control loop: a gripper that pushes the fingers apart with the feedback force, and a user who holds a grip force.
#pragma once

#include <string>
#include <vector>

namespace wholehand::device {

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
  double band = 8e-3;                        // m of opening beyond the grasp at which the grip is lost
};

enum class GripOutcome { settles, creeps, oscillates, saturates, lost };
constexpr int GRIP_OUTCOMES = 5;
extern const char* const GRIP_OUTCOME_NAMES[GRIP_OUTCOMES];

struct GripLoopResult {
  GripOutcome outcome = GripOutcome::settles;
  double response_time = 0;  // from the grasp until the gap's speed stays under 2 mm/s for 50 ms; NaN: not before the tilt
  double overshoot = 0;      // of x before the tilt, above its value at the tilt's start; at least 0
  double opened = 0;         // largest drop below the place at the tilt's start, m
  double swing = 0;          // of x at the end, m
};

// Simulates two seconds of grasp, the tilt, and two seconds and ten reactions to settle. The grip is lost if x falls below -band. The end is the last
// half second, or five reactions if longer (more than a period of the user's loop at its limit). The grip oscillates if x then still rises and falls
// by more than GRIP_SWING, and creeps if it only does one of them. It saturates if the feedback is at F_max throughout the end: the user then feels
// neither torque nor grip and keeps closing.
GripLoopResult hold_and_tilt(const GripLoop& loop);
constexpr double GRIP_SWING = 0.2e-3;  // m

// Whether motion after a step of F_base dies away, by simulation without tilt, clamp or band.
bool decays(const GripLoop& loop);
// The largest k_open, N/m, at which it does, found as by largest_stable.
double largest_k_open(const GripLoop& loop);
// Theoretical limits: linear stability of the sampled spring with the finger (no user), and of the user's delayed integral: k_open / (k_f + k_open)
// reaction / response < pi / 2. Infinite if nothing limits it.
double sampled_k_open(const GripLoop& loop);
double reaction_k_open(const GripLoop& loop);

// The sessions of the report: every value of one parameter with the others at their defaults, and the products of the five that matter most.
struct GripLoopRow {
  std::string varied;
  GripLoop loop;
  GripLoopResult result;
};
std::vector<GripLoopRow> grip_loop_rows(bool quick);
std::string grip_loop_csv(const std::vector<GripLoopRow>& rows, const std::string& run);  // `run` as for wall_limits_csv

}  // namespace wholehand::device

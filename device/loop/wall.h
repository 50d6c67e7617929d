// SPDX-License-Identifier: MIT
// How stiff a wall one axis of a haptic device can render.
#pragma once

#include <functional>
#include <string>

#include "core/wall_case.h"

namespace wholehand::device {

// One axis of a device and, if there is one, the finger on it; SI.
struct WallDevice {
  double mass = 0.1;        // m, kg
  double damping = 1;       // b, N s/m
  double rate = 1000;       // samples a second, Hz
  double wall_damping = 0;  // B of the rendered wall, N s/m
  int delay = 0;            // whole samples
  double encoder_step = 0;  // D, m
  double coulomb = 0;       // f_c, N
  double finger_mass = 0, finger_damping = 0, finger_stiffness = 0;
};

// Largest stiffness of the wall, N/m; infinite if nothing limits it.
struct WallLimits {
  double simulated = 0;  // up to which a press against the wall settles
  double passive = 0;    // b > K T / 2 + |B|: for any user (Colgate & Schenkel)
  double linear = 0;     // the sampled loop's eigenvalues within the unit circle, with the finger
  double coulomb = 0;    // min(2 b / T, 2 f_c / D) (Abbott & Okamura); the second if D > 0
};

// Presses a device against a wall of that stiffness, releases it off its rest, and gives the energy about its rest that the last quarter of
// WALL_SAMPLES samples may have for it to settle: no more than at the start. With an encoder or friction, it starts ten times as far off, and the
// limit is the energy of two encoder steps and twice the friction's band.
struct WallTrial {
  WallCase press;
  double allowed = 0;  // J
};
WallTrial wall_trial(const WallDevice& device, double stiffness);
constexpr int WALL_SAMPLES = 20000, LATE_SAMPLES = WALL_SAMPLES / 4;
// By the core, in double.
bool settles(const WallDevice& device, double stiffness);

// The magnitude of the linear loop's largest eigenvalue (no encoder, no friction).
double spectral_radius(const WallDevice& device, double stiffness);

WallLimits wall_theory(const WallDevice& device);  // all but `simulated`
WallLimits wall_limits(const WallDevice& device);
// The largest stiffness (N/m) for which `is_stable` holds throughout, found by doubling and halving to a millionth; infinite if it holds at 10^12, 0
// below 0.001.
double largest_stable(const std::function<bool(double stiffness)>& is_stable);

std::string wall_json(const WallLimits& limits);                             // one line; null if nothing limits
std::string wall_table(const WallDevice& device, const WallLimits& limits);  // for people

}  // namespace wholehand::device

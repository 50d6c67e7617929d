// SPDX-License-Identifier: MIT
// How far efforts and scores of two correct evaluations may differ: for `check`, which compares them, and for lists, which say where another backend
// may decide otherwise. docs/method.md has the derivations.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// Roundings that one number accumulates in a kernel, as a share of the quantity's largest value.
constexpr double ROUNDINGS = 64;

// How far two worst efforts may differ, as a share. Each side solves to half of the tolerance 1e-3 and skips states that are worse by up to another
// half; in float, contacts also differ by up to 1e-6 m on arms of 5 mm, on both sides.
constexpr double EFFORT_SHARE = 2.4e-3;

// The effort tolerance for a hand. If strengths are far apart the core widens a bracket, up to a tenth, until its forces balance.
inline double effort_share(const StrengthData& strengths) {
  constexpr double FAR_APART = 1e3, WIDEST = 0.1;
  double strongest = 0, weakest = std::numeric_limits<double>::infinity();
  for (const double strength : strengths.digits) {
    strongest = std::max(strongest, strength);
    if (strength > 0) weakest = std::min(weakest, strength);
  }
  return strongest > FAR_APART * weakest ? WIDEST : EFFORT_SHARE;
}

// A hand that squeezes much more than it lifts obtains a small force from large ones. Rounding costs it a share of its strength S, which changes 1 /
// effort by this much. `weight`: of the empty vessel, N.
inline double rounded_reserve(const StrengthData& strengths, double weight, double epsilon) {
  const double strongest = *std::max_element(strengths.digits.begin(), strengths.digits.end());
  return weight > 0 ? 4 * ROUNDINGS * epsilon * strongest / weight : 0;
}

// How far the form t = 1 / (1 + effort) of a worst effort may differ, apart from contacts: the share of e times the slope 1 / (1 + e)^2 of t is the
// share of t (1 - t), and a change of y = 1 / effort changes t = y / (1 + y) by (1 - t)^2 times that.
inline double effort_tolerance(const StrengthData& strengths, double weight, double epsilon, double form) {
  return effort_share(strengths) * form * (1 - form) + rounded_reserve(strengths, weight, epsilon) * (1 - form) * (1 - form);
}

// The same at the gate, an effort of 1, in single precision; 0 in a scene without [strength]. `mass`: of the empty vessel, kg. No holding grip has a
// larger one.
inline double gate_tolerance(const Scene& scene, double mass) {
  return scene.strength ? effort_tolerance(*scene.strength, scene.gravity * mass, std::numeric_limits<float>::epsilon(), 0.5) : 0;
}

// Whether two evaluations may place a worst effort on opposite sides of 1. False for NaN.
inline bool is_at_gate(double effort, double gate_tolerance) { return std::abs(1 / (1 + effort) - 0.5) <= gate_tolerance; }

// How far the scores of a holding grip may differ in single precision: by its hold term, by its depth, since each side ends within a stop tolerance
// of the surface, and by rounding. The load's part is much smaller. `weights`: of the six terms (effective_weights).
inline double score_tolerance(const std::array<double, 6>& weights, double gate_tolerance) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  return weights[5] * gate_tolerance + 2 * STOP_TOLERANCE_F32 * weights[2] / DEPTH_SCALE +
         ROUNDINGS * std::numeric_limits<float>::epsilon() * sum;
}

}  // namespace wholehand

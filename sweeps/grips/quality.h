// SPDX-License-Identifier: MIT
// Grasp quality as defined by Ferrari and Canny (1992): the size of the set of wrenches that contacts exert together.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/effort.h"
#include "core/evaluator.h"

namespace wholehand::sweeps {

// The set W of the wrenches (force, moment / scale) of all contacts whose normal forces add up to at most 1, each in its exact cone (kernel 10).
// Each pair is a bracket of the true number.
struct WrenchQuality {
  std::array<double, 2> epsilon{};  // radius of the largest ball about 0 within W; 0 where 0 is not inside
  std::array<double, 2> volume{};   // of W; 0 where W is flat
};

struct ContactMaterial {
  double friction = 0;  // mu
  double torsion = 0;   // gamma, m
};

constexpr std::size_t MOST_FACETS = 150'000;

// Moments about `center`, in units of `scale` (m, > 0). The search ends where epsilon is known to 1 % and the volume to 10 %, or with the first
// hull of `most_facets` faces. docs/method.md, section 10, says how wide the brackets then are.
WrenchQuality wrench_quality(std::span<const core_f64::ContactPoint> contacts, const ContactMaterial& material,
                             const core_f64::Vec3& center, double scale, std::size_t most_facets = MOST_FACETS);

// The quality of a grip: about the center of mass of the empty glass, in units of the distance of its farthest point from there.
struct GripQuality {
  WrenchQuality wrenches;
  double scale = 0;  // m
  Triple center{};   // vessel frame, m
};

// `result` is of a feasible grip; `evaluator` was made for `scene`. `most_facets`: as above.
GripQuality grip_quality(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripResult& result,
                         std::size_t most_facets = MOST_FACETS);

}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// Triples of scenes and results, vectors of the core and of the references: each as the other; and directions at random.
#pragma once

#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/scene.h"
#include "tests/support/scenes.h"

namespace wholehand {

inline core_f64::Vec3 vec(const Triple& p) { return {p[0], p[1], p[2]}; }
inline Triple triple(const core_f64::Vec3& p) { return {p.x, p.y, p.z}; }

inline double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline Long3 widened(const core_f64::Vec3& p) { return {p.x, p.y, p.z}; }
inline Long3 widened(const Triple& p) { return {p[0], p[1], p[2]}; }

inline core_f64::Vec3 random_unit(Random& random) {
  for (;;) {
    const core_f64::Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (glm::length(v) > 0.1 && glm::length(v) < 1) return glm::normalize(v);
  }
}

}  // namespace wholehand

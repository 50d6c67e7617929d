// SPDX-License-Identifier: MIT
// Triples and vectors of the core as those of the references; and directions at random.
#pragma once

#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/scene.h"
#include "tests/support/scenes.h"

namespace wholehand {

inline Long3 widened(const core_f64::Vec3& p) { return {p.x, p.y, p.z}; }
inline Long3 widened(const Triple& p) { return {p[0], p[1], p[2]}; }

inline core_f64::Vec3 random_unit(Random& random) {
  for (;;) {
    const core_f64::Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (glm::length(v) > 0.1 && glm::length(v) < 1) return glm::normalize(v);
  }
}

}  // namespace wholehand

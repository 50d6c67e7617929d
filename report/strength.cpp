// SPDX-License-Identifier: MIT
#include "report/strength.h"

#include <algorithm>

namespace wholehand {
namespace {

// A scene may give one number for both fingers; else it is a strong adult's pinch.
template <class Force>
double given_strength(const Force& force) {
  if constexpr (requires { force.grip_strength; }) {
    return force.grip_strength;
  } else {
    return 40;
  }
}

}  // namespace

double grip_strength(const Scene& scene) {
  if (scene.strength) return std::min(scene.strength->digits[0], scene.strength->digits[1]);
  return given_strength(scene.force);
}

}  // namespace wholehand

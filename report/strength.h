// SPDX-License-Identifier: MIT
// The strength of the hand that a report compares forces with.
#pragma once

#include "core/scene.h"

namespace wholehand {

// What each of the two fingers of a pinch can press with, N: the weaker of thumb and index finger where the scene has [strength].
double grip_strength(const Scene& scene);

}  // namespace wholehand

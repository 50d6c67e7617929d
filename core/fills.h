// SPDX-License-Identifier: MIT
// The fills of a scene's vessels, replaced while everything else of the scene stays.
#pragma once

#include "core/scene.h"

namespace wholehand {

// Whether both have liquid or neither has, with as many vessels and as many fills in each.
bool have_like_fills(const Scene& a, const Scene& b);

// Gives `scene` the fills of `from`, vessel by vessel. Both have like fills.
void take_fills(Scene& scene, const Scene& from);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Replaces the fills of a scene's vessels and keeps everything else.
#pragma once

#include "core/scene.h"

namespace wholehand {

// Whether both scenes have liquid or neither has, with the same number of vessels and of fills in each.
bool have_like_fills(const Scene& a, const Scene& b);

// Gives `scene` the fills of `from`, vessel by vessel. Both have like fills.
void take_fills(Scene& scene, const Scene& from);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Where the tangent of an outline's element is a supporting line: none of the outline lies beyond it. A finger that comes near such a place need
// mind that plane alone, and takes longer steps.
#pragma once

#include <vector>

#include "core/prepared.h"

namespace wholehand {

// Sets `supports` of every element of a closed outline (core/sdf.h). An element never supports where this cannot be told, which costs steps and
// no truth: at the ends of arcs, and of wide arcs that are not of its own circle.
void mark_supports(std::vector<PreparedElement>& outline);

}  // namespace wholehand

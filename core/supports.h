// SPDX-License-Identifier: MIT
// Where the tangent of an outline's element is a supporting line: none of the outline lies beyond it. A finger that comes near such a
// place need mind that plane alone, and takes longer steps.
#pragma once

#include <vector>

#include "core/prepared.h"

namespace wholehand {

// Sets `supports` of every element of a closed outline (core/sdf.h). Where it is unknown whether an element's tangents support, they
// count as if they did not, which costs steps and nothing else: those of an arc beside another arc of more than 120 degrees on another
// circle. The bits of an arc's own ends are of no use, since no plane is used there (element_convex).
void mark_supports(std::vector<PreparedElement>& outline);

}  // namespace wholehand

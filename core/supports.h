// SPDX-License-Identifier: MIT
// Finds where the tangent of an outline's element is a supporting line, beyond which no part of the outline lies. A finger near such a place only
// needs to respect that plane, and takes longer steps.
#pragma once

#include <vector>

#include "core/prepared.h"

namespace wholehand {

// Sets `supports` of every element of a closed outline (core/sdf.h). If it is unknown whether an element's tangents support, they count as not
// supporting, which only costs steps: this concerns an arc beside another arc of more than 120 degrees on another circle. The bits of an arc's own
// ends are unused, because no plane is used there (element_convex).
void mark_supports(std::vector<PreparedElement>& outline);

}  // namespace wholehand

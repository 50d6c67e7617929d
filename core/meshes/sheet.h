// SPDX-License-Identifier: MIT
// Gives a sheet without thickness walls.
#pragma once

#include <string>

#include "core/meshes/check.h"

namespace wholehand {

// An open mesh whose triangles face outward, as the outside of a body of that thickness (m), which grows inward: a second surface behind the first, and
// a band along each rim, which stays level. `sheet` is in m; `name` is for messages. Throws Error (usage) for a closed mesh, one with more than two
// triangles at an edge, and one where walls of that thickness would cross, as in a narrow neck: with the narrowest place, mm.
CheckedMesh thickened(const CheckedMesh& sheet, double thickness, const std::string& name);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// What meshes from elsewhere have: other units and axes, and faults of their surface.
#pragma once

#include "core/meshes/triangles.h"

namespace wholehand {

// ---- of the whole ----
// In a file whose unit is that many meters.
TriangleMesh in_unit(TriangleMesh mesh, double meters_per_unit);
// +z up, where the scene says up = "z".
TriangleMesh z_up(TriangleMesh mesh);
// On its side: its top faces +x, and rotate_deg = [0, 0, 90] stands it up.
TriangleMesh lying(TriangleMesh mesh);

// ---- of the surface ----
// Every triangle twice, back to back, with the same corners.
TriangleMesh two_sided(TriangleMesh mesh);
TriangleMesh inside_out(TriangleMesh mesh);
// Each triangle with its own corners, as STL has them.
TriangleMesh unjoined(const TriangleMesh& mesh);
// Without the triangles that lie flat on the ground, y = 0: the hole is flat.
TriangleMesh without_base(TriangleMesh mesh);
// Without the triangles whose middle lies within `radius` of `center`: on a curved wall the hole is not flat.
TriangleMesh with_hole(TriangleMesh mesh, const Triple& center, double radius);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The triangles of a mesh file (glTF, STL, OBJ or PLY), as a scene's [[vessel]] names it.
#pragma once

#include <string>

#include "core/meshes/triangles.h"
#include "core/scene.h"

namespace wholehand {

// All triangles of the file; of glTF those of its default scene (the first if it names none), with the transforms of its nodes. Then, in this order:
// turned by -90 degrees about x, with `data.z_is_up` (the file's z becomes y); scaled by `data.scale`; turned by `data.rotate` about the axes x, then
// the turned y, then the twice turned z (R = Rx Ry Rz); with `data.origin_at_base`, moved so that the lowest point has y = 0 and the bounding box is
// centered on the axis in x and z. Corners are shared only as far as the file shares them. A relative `data.file` starts from `base_folder` (empty:
// the working directory). Throws Error (usage), one line with the place and the file, for anything but a body of triangles (docs/mesh.md).
TriangleMesh read_mesh(const MeshData& data, const std::string& base_folder);

}  // namespace wholehand

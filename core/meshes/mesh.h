// SPDX-License-Identifier: MIT
// The triangles of a mesh file (glTF, STL, OBJ, PLY, OFF or Collada), as a scene's [[vessel]] names it.
#pragma once

#include <string>
#include <vector>

#include "core/meshes/file.h"
#include "core/meshes/triangles.h"
#include "core/scene.h"

namespace wholehand {

// The triangles of the file, of `data.parts` if it names some; of glTF and Collada those of its scene (the first if it names none), with the transforms
// of its nodes. Then, in this order: turned by -90 degrees about x, with `data.z_is_up` (the file's z becomes y); scaled by `data.scale`; turned by
// `data.rotate` about the axes x, then the turned y, then the twice turned z (R = Rx Ry Rz); moved so that `data.origin` becomes the origin, or with
// `data.origin_at_base` so that the lowest point has y = 0 and the bounding box is centered on the axis in x and z. Corners are shared only as far as
// the file shares them. A relative `data.file` starts from `base_folder` (empty: the working directory). Throws Error (usage), one line with the place
// and the file, for anything but a body of triangles (docs/mesh.md).
TriangleMesh read_mesh(const MeshData& data, const std::string& base_folder);

// The three steps of read_mesh, which throw as it does. First the file's triangles, in its own frame and unit.
TriangleMesh read_triangles(const MeshFile& file);
// Then leaves the parts with these numbers (from 1) alone.
void take_parts(TriangleMesh& mesh, const std::vector<int>& numbers, const MeshFile& file);
// Last turns, scales and moves the mesh as `data` says; m.
void place_mesh(TriangleMesh& mesh, const MeshData& data, const MeshFile& file);

}  // namespace wholehand

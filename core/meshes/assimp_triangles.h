// SPDX-License-Identifier: MIT
// STL, OBJ and PLY files to triangles.
#pragma once

#include <string>

#include "core/meshes/file.h"
#include "core/meshes/triangles.h"

namespace wholehand {

// All triangles of the file, polygons cut into some, in the file's unit. assimp reads it, out of memory and no other file. Throws Error (usage),
// one line, as read_mesh does.
TriangleMesh assimp_triangles(const MeshFile& file, MeshFormat format, const std::string& bytes);

}  // namespace wholehand

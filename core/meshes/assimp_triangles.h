// SPDX-License-Identifier: MIT
// Reads triangles from STL, OBJ, PLY, OFF and Collada files.
#pragma once

#include <string>

#include "core/meshes/file.h"
#include "core/meshes/triangles.h"

namespace wholehand {

// All triangles of the file, with polygons cut into triangles, in the file's unit (Collada: in meters). assimp reads all but STL, from memory, and
// opens no other file. Throws Error (usage), one line, as read_mesh does.
TriangleMesh assimp_triangles(const MeshFile& file, MeshFormat format, const std::string& bytes);

}  // namespace wholehand

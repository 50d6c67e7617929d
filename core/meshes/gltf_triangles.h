// SPDX-License-Identifier: MIT
// Reads the triangles of a glTF file's scene.
#pragma once

#include <string_view>

#include "core/meshes/file.h"
#include "core/meshes/triangles.h"

namespace wholehand {

// All triangles of the default scene (the first if the file names none), placed by their nodes, in the file's meters. They are counted before any is
// read. Throws Error (usage), one line, as read_mesh does.
TriangleMesh gltf_triangles(const MeshFile& file, std::string_view bytes);

}  // namespace wholehand

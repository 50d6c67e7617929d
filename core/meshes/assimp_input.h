// SPDX-License-Identifier: MIT
// An STL, OBJ or PLY file looked through before assimp sees it: assimp 5.2 crashes on damaged PLY files, or never ends.
#pragma once

#include <string>
#include <string_view>

#include "core/meshes/file.h"

namespace wholehand {

constexpr std::size_t MOST_CORNERS = 1000;  // of a polygon: cutting it into triangles takes time with the square of them

// The shape in `bytes` and nothing else, as a file of the same format that is whole: STL as binary STL, OBJ as vertices and faces with
// positive indices, PLY as little-endian PLY of vertices and faces. Every number is finite and fits single precision, every index is that of a
// vertex, and the triangles are at most MOST_TRIANGLES. Materials, normals, colors, texture coordinates, points and lines are left out.
// Throws Error (usage), one line, where the file is damaged, truncated, too large or not made of polygons.
std::string assimp_input(const MeshFile& file, MeshFormat format, std::string_view bytes);

// The same of one format each.
std::string stl_input(const MeshFile& file, std::string_view bytes);
std::string obj_input(const MeshFile& file, std::string_view bytes);
std::string ply_input(const MeshFile& file, std::string_view bytes);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Checks an STL, OBJ, PLY, OFF or Collada file before assimp reads it: on damaged PLY and Collada files assimp 5.2 crashes or never ends.
#pragma once

#include <string>
#include <string_view>

#include "core/meshes/file.h"

namespace wholehand {

constexpr std::size_t MOST_CORNERS = 1000;  // corners of a polygon: cutting it into triangles takes quadratic time

// Only the shape in `bytes`, as an intact file: STL as binary STL, PLY as little-endian PLY of vertices and faces, the others as OBJ of vertices and
// faces with positive indices. Every number is finite and fits single precision, every index refers to a vertex, and there are at most MOST_TRIANGLES
// triangles. Materials, normals, colors, texture coordinates, points and lines are left out. Throws Error (usage), one line, if the file is damaged,
// truncated, too large or not made of polygons.
std::string assimp_input(const MeshFile& file, MeshFormat format, std::string_view bytes);

// The same for one format each.
std::string stl_input(const MeshFile& file, std::string_view bytes);
std::string obj_input(const MeshFile& file, std::string_view bytes);
std::string ply_input(const MeshFile& file, std::string_view bytes);
std::string off_input(const MeshFile& file, std::string_view bytes);
// All geometries of the visual scene, placed by their nodes, in meters with +y up.
std::string collada_input(const MeshFile& file, std::string_view bytes);

}  // namespace wholehand

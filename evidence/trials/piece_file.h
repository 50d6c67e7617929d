// SPDX-License-Identifier: MIT
// A file of convex pieces beside a mesh file, as CoACD writes it.
#pragma once

#include <optional>
#include <string>

#include "core/scene.h"
#include "evidence/trials/convex_cells.h"

namespace wholehand {

constexpr std::size_t MOST_FILE_PIECES = 1024;

// The file of pieces of a mesh: for cup.glb cup.pieces.obj, or .pieces.glb, .gltf, .stl, .ply, the first that exists. None: no such file.
std::optional<std::string> piece_file_of(const MeshData& data, const std::string& folder);

// The pieces of that file, in the mesh's own frame: the scene's keys and the mesh's own shift to the base apply. Each closed run of triangles is a piece,
// such as an object of an OBJ file. Throws Error (usage), one line with the file and the numbers, for a piece that leaves its triangles by more than
// CONVEX_TOLERANCE with its hull, and for pieces that leave the mesh, or leave the mesh's surface uncovered, by more than MOST_PIECE_ERROR. `error` is
// the larger of both.
ConvexCover read_pieces(const VesselData& vessel, const std::string& file, const std::string& folder, const CheckedMesh& mesh,
                        const MeshDistance& body);

}  // namespace wholehand

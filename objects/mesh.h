// Triangles of a mesh file (glTF, STL, OBJ or PLY), as a scene's [[vessel]] names it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene.h"

namespace wholehand {

// Vessel frame (+y up), m; counter-clockwise seen from outside, as far as the file has it so.
struct TriangleMesh {
  std::vector<Triple> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

constexpr std::size_t MOST_TRIANGLES = 20'000'000;
constexpr std::size_t MOST_MESH_VERTICES = 3 * MOST_TRIANGLES;

// Whether two of a triangle's corners are in one place: it has no side, and where it lies has no say.
bool is_point_or_edge(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle);

// All triangles of the file; of glTF those of its default scene (the first where it names none), with the transforms of its nodes. Then, in
// this order: turned by -90 degrees about x, with `data.z_is_up` (the file's z becomes y); scaled by `data.scale`; turned by `data.rotate`
// about the axes x, then the turned y, then the twice turned z (R = Rx Ry Rz); with `data.origin_at_base`, moved so that the lowest point has
// y = 0 and the bounding box is centred on the axis in x and z. Corners are not shared further than the file shares them.
// `base_folder` is what a relative `data.file` starts from, empty: the working directory. Throws Error (usage), one line with the place
// and the file, for whatever is not a body of triangles (docs/mesh.md).
TriangleMesh read_mesh(const MeshData& data, const std::string& base_folder);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/meshes/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "base/text/readable.h"
#include "core/meshes/assimp_triangles.h"
#include "core/meshes/file.h"
#include "core/meshes/gltf_triangles.h"
#include "core/meshes/parts.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr double FARTHEST = 1e9;             // m: beyond it squares and cubes lose their meaning
constexpr double LARGEST_NUMBER = 1e15;      // in the file: FARTHEST, with the least mesh_scale, 1e-6
constexpr std::size_t FEWEST_TRIANGLES = 4;  // a tetrahedron
constexpr double MOST_ROUNDING = 1e-3;       // of a mesh's extent: a tenth of a millimeter of a cup

// Columns of Rx Ry Rz.
glm::dmat3 turn_of(const Triple& angles) {
  const glm::dquat x = glm::angleAxis(angles[0], glm::dvec3(1, 0, 0)), y = glm::angleAxis(angles[1], glm::dvec3(0, 1, 0)),
                   z = glm::angleAxis(angles[2], glm::dvec3(0, 0, 1));
  return glm::mat3_cast(x * y * z);
}

void refuse_far_vertices(const TriangleMesh& mesh, const MeshFile& file) {
  for (const Triple& vertex : mesh.vertices)
    for (const double x : vertex)
      if (!(std::abs(x) <= LARGEST_NUMBER))
        file.refuse(
            fmt::format("has a vertex at {:.3g}, beyond {:g}, in its own numbers: they are damaged, or their scale is wrong", x,
                        LARGEST_NUMBER));
}

// Numbers that are large for the size of the shape have lost it where they became single precision.
void refuse_lost_shape(const TriangleMesh& mesh, const MeshFile& file) {
  constexpr double FAR = std::numeric_limits<double>::infinity();
  Triple low{FAR, FAR, FAR}, high{-FAR, -FAR, -FAR};
  for (const Corners& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], mesh.vertices[corner][k]);
        high[k] = std::max(high[k], mesh.vertices[corner][k]);
      }
  const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  if (!(mesh.rounding > MOST_ROUNDING * extent)) return;
  file.refuse(fmt::format(
      "lies so far from its origin that single precision moves its points by up to {:.2g}, and it is {:.3g} large, in its own "
      "numbers: move it to the origin where it was made",
      mesh.rounding, extent));
}

}  // namespace

void place_mesh(TriangleMesh& mesh, const MeshData& data, const MeshFile& file) {
  const glm::dmat3 turn = turn_of(data.rotate);
  constexpr double FAR = std::numeric_limits<double>::infinity();
  Triple low{FAR, FAR, FAR}, high{-FAR, -FAR, -FAR};
  for (Triple& vertex : mesh.vertices) {
    const glm::dvec3 upright = data.z_is_up ? glm::dvec3(vertex[0], vertex[2], -vertex[1]) : to_vec3(vertex);
    const glm::dvec3 turned = turn * (data.scale * upright);
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(turned[k]) <= FARTHEST))
        file.refuse("has a vertex more than a million km away: its scale is wrong, or its numbers");
      vertex[k] = turned[k];
    }
  }
  if (data.origin) {
    for (Triple& vertex : mesh.vertices)
      for (int k = 0; k < 3; ++k) vertex[k] -= (*data.origin)[k];
  }
  if (data.origin || !data.origin_at_base) return;
  for (const auto& triangle : mesh.triangles) {  // vertices that none uses have no say
    if (is_point_or_edge(mesh, triangle)) continue;
    for (const std::uint32_t corner : triangle)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], mesh.vertices[corner][k]);
        high[k] = std::max(high[k], mesh.vertices[corner][k]);
      }
  }
  if (!(low[0] <= high[0])) return;  // nothing but points and edges, which check_mesh refuses
  const Triple origin{low[0] / 2 + high[0] / 2, low[1], low[2] / 2 + high[2] / 2};
  for (Triple& vertex : mesh.vertices)
    for (int k = 0; k < 3; ++k) vertex[k] -= origin[k];
}

void take_parts(TriangleMesh& mesh, const std::vector<int>& numbers, const MeshFile& file) {
  const MeshParts parts = find_parts(mesh);
  const int largest = *std::max_element(numbers.begin(), numbers.end());
  if (largest > static_cast<int>(parts.parts.size()))
    file.refuse(
        fmt::format("part = {}: it has {}, numbered from 1, the largest first", largest, counted(parts.parts.size(), "part")));
  mesh = parts_alone(mesh, parts, numbers);
}

TriangleMesh read_triangles(const MeshFile& file) {
  const std::string bytes = mesh_bytes(file);
  const MeshFormat format = mesh_format(file, bytes);
  TriangleMesh mesh = format == MeshFormat::gltf ? gltf_triangles(file, bytes) : assimp_triangles(file, format, bytes);
  if (mesh.triangles.empty()) file.refuse(format == MeshFormat::gltf ? "has no mesh in its scene" : "has no triangle");
  if (mesh.triangles.size() < FEWEST_TRIANGLES)
    file.refuse(fmt::format("has {}, and a body needs at least {}", counted(mesh.triangles.size(), "triangle"), FEWEST_TRIANGLES));
  refuse_far_vertices(mesh, file);
  refuse_lost_shape(mesh, file);
  return mesh;
}

TriangleMesh read_mesh(const MeshData& data, const std::string& base_folder) {
  const MeshFile file{(std::filesystem::path(base_folder) / data.file).string(), data.place};
  TriangleMesh mesh = read_triangles(file);
  if (!data.parts.empty()) take_parts(mesh, data.parts, file);
  place_mesh(mesh, data, file);
  return mesh;
}

}  // namespace wholehand

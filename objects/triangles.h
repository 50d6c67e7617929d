// SPDX-License-Identifier: MIT
// Triangles with shared corners: what every reader of mesh files makes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

}  // namespace wholehand

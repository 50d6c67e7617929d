// SPDX-License-Identifier: MIT
// The bodies of a mesh file, such as a cup and its saucer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

struct MeshPart {
  std::size_t triangles = 0;
  Triple low{}, high{};  // bounding box, in the mesh's unit
};

constexpr std::uint32_t NO_PART = ~0u;

// Parts are numbered from 1, the largest bounding box first: the same numbers in any unit, and before and after a check.
struct MeshParts {
  std::vector<MeshPart> parts;
  std::vector<std::uint32_t> of_triangle;  // each triangle's part, from 0; NO_PART for points and edges, which a check drops
};

// Triangles that share corners, directly or through others, are one part; corners with equal coordinates are the same. A closed surface within what
// another part encloses, such as the gap of a double wall, belongs to that part.
MeshParts find_parts(const TriangleMesh& mesh);

// The triangles of some parts. `numbers`: from 1, each of them there.
TriangleMesh parts_alone(const TriangleMesh& mesh, const MeshParts& parts, std::span<const int> numbers);

// Whether the part with the number `of` reaches into what the part `into` encloses, as a handle into a wall; touching it from above or below is not
// enough. `mesh`: checked.
bool reaches_into(const TriangleMesh& mesh, const MeshParts& parts, int of, int into);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Triangles with normals, as viewers and glTF take them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene.h"

namespace wholehand::sweeps {

struct SurfaceMesh {
  std::vector<Triple> positions;
  std::vector<Triple> normals;           // unit, one per position; positions are repeated if the surface has an edge
  std::vector<std::uint32_t> triangles;  // three positions each
};

}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// Convex pieces that cover a body of triangles.
#pragma once

#include <cstddef>
#include <vector>

#include "core/meshes/distance.h"
#include "evidence/trials/convex_hull.h"

namespace wholehand {

constexpr double CONVEX_TOLERANCE = 0.5e-3;  // m, by which a piece may leave the body without being cut
constexpr double MOST_PIECE_ERROR = 1e-3;    // m; pieces that leave the body by more are no model of it
constexpr std::size_t MOST_PIECES = 256;

struct ConvexCover {
  std::vector<ConvexHull> pieces;
  double error = 0;  // m: no point of a piece is farther outside the body
};

// Pieces whose union holds all of the body. Cuts the body by planes, the worst piece first, until each piece leaves the body by at most
// CONVEX_TOLERANCE or there are MOST_PIECES; then joins pieces whose joint hull leaves it by no more. `error` may exceed both limits. The same body
// gives the same pieces.
ConvexCover cover_by_pieces(const CheckedMesh& mesh, const MeshDistance& body, std::size_t most_pieces = MOST_PIECES);

}  // namespace wholehand

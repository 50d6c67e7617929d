// SPDX-License-Identifier: MIT
#include "core/mirror.h"

#include <utility>

#include "core/lattice.h"

namespace wholehand {

GripInput mirrored(const GripInput& grip, Handedness handedness) {
  if (handedness == Handedness::right) return grip;
  GripInput result = grip;
  // the line's direction mirrored in x has the azimuth pi - a, and the side direction d x y then changes sign
  result.azimuth = PI - grip.azimuth;
  result.offset = -grip.offset;
  return result;
}

PreparedLattice mirrored(const PreparedLattice& lattice, Handedness handedness) {
  if (handedness == Handedness::right) return lattice;
  PreparedLattice result = lattice;
  result.origin[0] = -(lattice.origin[0] + (lattice.nx - 1) * lattice.spacing);
  const std::size_t rows = static_cast<std::size_t>(lattice.ny) * lattice.nz, nx = lattice.nx;
  std::vector<std::uint32_t> words(lattice.words->size());
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < nx; ++i) {
      const std::size_t from = row * nx + i, to = row * nx + nx - 1 - i;
      if (lattice.halves) {
        words[to / 2] |= placed_half(half_at(*lattice.words, from), to);
      } else {
        words[to] = (*lattice.words)[from];
      }
    }
  result.words = std::make_shared<const std::vector<std::uint32_t>>(std::move(words));
  return result;
}

Triple mirrored(const Triple& point, Handedness handedness) {
  return handedness == Handedness::right ? point : Triple{-point[0], point[1], point[2]};
}

glm::dvec3 mirrored(const glm::dvec3& point, Handedness handedness) {
  return handedness == Handedness::right ? point : glm::dvec3(-point.x, point.y, point.z);
}

glm::dmat3 mirrored(const glm::dmat3& rotation, Handedness handedness) {
  if (handedness == Handedness::right) return rotation;
  const glm::dmat3 mirror(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  return mirror * rotation * mirror;
}

}  // namespace wholehand

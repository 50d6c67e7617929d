// SPDX-License-Identifier: MIT
// What kernels need of a scene, as plain doubles; made by core/prepare.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// Like core/sdf.h's Element: from a to b in (r, y), m; side 0: line, +1: arc on the half r >= center r, -1: on the other. For a line, `center` is its
// unit normal to the right of a -> b, which is outward on a hull.
struct PreparedElement {
  std::array<double, 2> a{}, b{}, center{};
  double radius = 0;
  int side = 0;
  int supports = 0;  // SUPPORTS_*; of an outline's elements alone (core/supports.h)
};

struct PreparedVessel {
  std::vector<PreparedElement> hull;     // the outer outline, mouth included (last)
  std::vector<PreparedElement> outline;  // the surface of the signed distance: the hull, or the shell's outline
  int lid = -1;                          // index of the mouth in `outline`; -1 for a shell
  std::vector<PreparedElement> cavity;   // y ascending, empty without a wall
  double floor_height = 0, mouth_height = 0, mouth_radius = 0;
  double bound_height = 0, bound_radius = 0;
  double largest_radius = 0;  // of the hull, or of the mesh about the axis
};

struct PreparedHand {
  struct Finger {
    Triple base{}, forward{}, palmward{};
    std::array<double, 4> length{};
    std::array<double, 5> radius{};
  };
  std::array<Finger, FINGER_COUNT> fingers{};
  Triple thumb_open{}, thumb_swing{}, finger_open{}, finger_swing{};
  double gap_open = 0, gap_closed = 0;
  std::vector<double> gap_table;  // closures at equal steps of the gap
};

// A vessel's signed distance on a regular lattice, as in core/sdf.h's Lattice; every precision and device reads it.
struct PreparedLattice {
  Triple origin{};
  double spacing = 1;
  int nx = 0, ny = 0, nz = 0;
  bool halves = false;
  std::shared_ptr<const std::vector<std::uint32_t>> words;  // core/lattice.h
};

constexpr double LEVEL_TOLERANCE_F64 = 1e-12, LEVEL_TOLERANCE_F32 = 1e-6;  // of the capacity: liquid level
constexpr int QUADRATURE_POINTS = 32;  // a piece of a cavity: 1e-10 of the capacity if the plane passes close to an arc's pole

// Gauss-Legendre of `points` on a cosine map: cosines of the angles and weights times sin(theta) pi / 2.
struct PreparedQuadrature {
  std::vector<double> cosine, weight;
};

}  // namespace wholehand

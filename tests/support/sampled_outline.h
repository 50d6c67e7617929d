// SPDX-License-Identifier: MIT
// Outlines without core/: as curves from the scene's own data and as points, with the distance to them by brute force; and the
// points on which distances are compared.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/sdf.h"
#include "tests/support/scenes.h"

namespace wholehand {

using core_f64::Vec2;
using core_f64::Vec3;

constexpr int OUTLINE_SAMPLES = 100000;
constexpr int FEWER_SAMPLES = 10000;  // for many distances: the search on the curve makes up for it

// One element of an outline as a curve over [0, 1], from the scene's own data.
struct Piece {
  bool is_arc = false;
  double ar = 0, ay = 0, br = 0, by = 0, cr = 0, cy = 0, radius = 0, from = 0, sweep = 0;

  Vec2 at(double t) const {
    if (!is_arc) return {ar + t * (br - ar), ay + t * (by - ay)};
    return {cr + radius * std::cos(from + t * sweep), cy + radius * std::sin(from + t * sweep)};
  }
  // Outward normal: to the right of the way, as the body lies to its left.
  Vec2 normal(double t) const {
    if (!is_arc) {
      const double l = std::hypot(br - ar, by - ay);
      return {(by - ay) / l, -(br - ar) / l};
    }
    const double sign = sweep > 0 ? 1 : -1;
    return {sign * std::cos(from + t * sweep), sign * std::sin(from + t * sweep)};
  }
  double length() const { return is_arc ? radius * std::abs(sweep) : std::hypot(br - ar, by - ay); }
};

std::vector<Piece> pieces_of(const VesselData& vessel);
// Without its last element, the mouth.
std::vector<Piece> open_pieces(const VesselData& vessel);

// The outline as points, and the smallest distance to it: by the nearest sample of each element, then by golden section on the
// curve around it, so that what is left is rounding.
class Sampled {
 public:
  explicit Sampled(std::vector<Piece> pieces, int samples = OUTLINE_SAMPLES);

  double spacing() const { return spacing_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

  double distance(Vec2 q) const;
  // Parity of the polygon of samples along a slanting ray, so that no level of the outline is special to it. The polygon is closed
  // on the far side of the axis. Wrong only nearer to an arc than the sagitta between two samples.
  bool inside(Vec2 q) const;

 private:
  std::vector<Piece> pieces_;
  std::vector<std::vector<double>> r_, y_;
  double spacing_ = 0;
};

Vec3 around(Vec2 q, double azimuth);
// Within half as much again of the vessel's radius and 0.4 of its height.
Vec2 point_in_box(const VesselData& vessel, Random& random);
// Everywhere, the axis, on and beside the surface and its corners, level with the ends of elements, centers of arcs, far away.
std::vector<Vec2> queries(const VesselData& vessel, const std::vector<Piece>& pieces, int count, std::uint64_t seed);

}  // namespace wholehand

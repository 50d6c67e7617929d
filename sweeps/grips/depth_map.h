// SPDX-License-Identifier: MIT
// What is nearest at each place of a view along one direction, on a raster: which lines of a drawing are hidden, and what it covers.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/scene.h"

namespace wholehand {

using Flat = std::array<double, 2>;  // a place in a view or on a sheet: to the right, and up or down as noted there

class DepthMap {
 public:
  static constexpr double NOTHING = -std::numeric_limits<double>::infinity();

  // Triangles of `points`, which are right, up and towards the viewer, m; `pixel` is the raster's step, m: at most 4,096 steps are laid
  // across, wider ones where it is too small.
  DepthMap(const std::vector<Triple>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles, double pixel);

  double pixel() const { return pixel_; }
  // How near to the viewer the nearest triangle is at the middle of the pixel that holds p; NOTHING where there is none.
  double nearest_at(const Flat& p) const { return depth_at(column_of(p[0]), row_of(p[1])); }
  // The least of that over the pixel and its eight neighbors: whether a line at a depth is hidden, though it may lie on what covers it.
  double least_near(const Flat& p) const;
  // Closed lines along pixels round all that is covered, to the left of each; corners only, the first not repeated.
  std::vector<std::vector<Flat>> borders() const;

 private:
  int column_of(double x) const;
  int row_of(double y) const;
  double depth_at(int column, int row) const;
  bool is_covered(int column, int row) const { return depth_at(column, row) > NOTHING; }
  void draw(const Triple& a, const Triple& b, const Triple& c);
  std::vector<Flat> follow_border(int column, int row, std::vector<bool>& seen) const;

  Flat low_{};
  double pixel_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<float> depths_;
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The nearest surface at each pixel of a view along one direction: decides which lines of a drawing are hidden, and what it covers.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/scene.h"

namespace wholehand::sweeps {

using Flat = std::array<double, 2>;  // a point in a view or on a sheet: to the right, and up or down as noted there

class DepthMap {
 public:
  static constexpr double NOTHING = -std::numeric_limits<double>::infinity();

  // Triangles of `points` (right, up and towards the viewer, m); `pixel` is the raster's step, m. There are at most 4,096 steps across; a smaller
  // `pixel` is widened.
  DepthMap(const std::vector<Triple>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles, double pixel);

  double pixel() const { return pixel_; }
  // The depth of the nearest triangle at the middle of the pixel that contains p; NOTHING if there is none.
  double nearest_at(const Flat& p) const { return depth_at(column_of(p[0]), row_of(p[1])); }
  // The least depth over the pixel and its eight neighbors, to decide whether a line is hidden even if it lies on the covering surface.
  double least_near(const Flat& p) const;
  // Closed lines along pixels around the covered area, which lies to their left; corners only, the first not repeated.
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

}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
#include "sweeps/grips/depth_map.h"

#include <algorithm>
#include <cmath>

namespace wholehand::sweeps {
namespace {

constexpr double MOST_STEPS = 4096;  // of a raster, in either direction

constexpr double HAIR = 1e-9;  // pixels

constexpr std::array<std::array<int, 2>, 4> HEADINGS{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};  // each a quarter turn left of the last

}  // namespace

DepthMap::DepthMap(const std::vector<Triple>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles, double pixel) {
  Flat high{-HUGE_VAL, -HUGE_VAL};
  low_ = {HUGE_VAL, HUGE_VAL};
  for (const Triple& p : points) {
    for (int k = 0; k < 2; ++k) {
      low_[k] = std::min(low_[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  if (points.empty()) low_ = high = {0, 0};
  pixel_ = std::max({pixel, (high[0] - low_[0]) / MOST_STEPS, (high[1] - low_[1]) / MOST_STEPS});
  columns_ = static_cast<int>((high[0] - low_[0]) / pixel_) + 1;
  rows_ = static_cast<int>((high[1] - low_[1]) / pixel_) + 1;
  depths_.assign(static_cast<std::size_t>(columns_) * rows_, static_cast<float>(NOTHING));
  for (const auto& [a, b, c] : triangles) draw(points[a], points[b], points[c]);
}

int DepthMap::column_of(double x) const {
  return static_cast<int>(std::floor(std::clamp((x - low_[0]) / pixel_, -9.0, MOST_STEPS + 9)));
}
int DepthMap::row_of(double y) const {
  return static_cast<int>(std::floor(std::clamp((y - low_[1]) / pixel_, -9.0, MOST_STEPS + 9)));
}

double DepthMap::depth_at(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return NOTHING;
  return static_cast<double>(depths_[static_cast<std::size_t>(row) * columns_ + column]);
}

double DepthMap::least_near(const Flat& p) const {
  const int column = column_of(p[0]), row = row_of(p[1]);
  double least = HUGE_VAL;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) least = std::min(least, depth_at(column + dx, row + dy));
  return least;
}

// Pixels whose middle lies in the triangle, including its sides and a tiny margin, so that neighbors leave no gap. Shares of b and c and the depth
// are linear: on a row of pixels the shares of all three corners are at least 0 within one interval.
void DepthMap::draw(const Triple& a, const Triple& b, const Triple& c) {
  const auto place = [&](const Triple& p) { return Flat{(p[0] - low_[0]) / pixel_ - 0.5, (p[1] - low_[1]) / pixel_ - 0.5}; };
  const Flat pa = place(a), pb = place(b), pc = place(c);  // the middle of pixel (0, 0) at the origin
  const Flat ab{pb[0] - pa[0], pb[1] - pa[1]}, ac{pc[0] - pa[0], pc[1] - pa[1]};
  const double doubled = ab[0] * ac[1] - ab[1] * ac[0];
  if (doubled == 0) return;                                            // seen from its side
  const double b_slope = ac[1] / doubled, c_slope = -ab[1] / doubled;  // of the shares along a row
  const auto [left, right] = std::minmax({pa[0], pb[0], pc[0]});
  const auto [bottom, top] = std::minmax({pa[1], pb[1], pc[1]});
  const auto [farthest, nearest] = std::minmax({a[2], b[2], c[2]});
  const int last_row = std::min(rows_ - 1, static_cast<int>(std::floor(top + HAIR)));
  for (int row = std::max(0, static_cast<int>(std::ceil(bottom - HAIR))); row <= last_row; ++row) {
    const double y = row - pa[1], b_start = -y * ac[0] / doubled - pa[0] * b_slope, c_start = y * ab[0] / doubled - pa[0] * c_slope;
    double from = left, to = right;
    for (const auto& [start, slope] :
         {Flat{b_start, b_slope}, Flat{c_start, c_slope}, Flat{1 - b_start - c_start, -b_slope - c_slope}}) {
      if (slope > 0) from = std::max(from, -start / slope);
      if (slope < 0) to = std::min(to, -start / slope);
    }
    if (!(from <= to + 2 * HAIR)) continue;
    const int last_column = std::min(columns_ - 1, static_cast<int>(std::floor(to + HAIR)));
    for (int column = std::max(0, static_cast<int>(std::ceil(from - HAIR))); column <= last_column; ++column) {
      const double at_b = b_start + column * b_slope, at_c = c_start + column * c_slope;
      float& depth = depths_[static_cast<std::size_t>(row) * columns_ + column];
      depth =
          std::max(depth, static_cast<float>(std::clamp(a[2] + at_b * (b[2] - a[2]) + at_c * (c[2] - a[2]), farthest, nearest)));
    }
  }
}

// Starts at the lower side of a covered pixel above an uncovered one, with the covered area on the left. If two covered pixels only meet at a corner,
// the line stays with the one it follows.
std::vector<Flat> DepthMap::follow_border(int column, int row, std::vector<bool>& seen) const {
  std::vector<Flat> border;
  const std::array<int, 2> start{column, row};
  std::array<int, 2> at = start;  // a corner of pixels: the lower left one of (column, row)
  int heading = 0;
  do {
    if (heading == 0) seen[static_cast<std::size_t>(at[1]) * columns_ + at[0]] = true;
    const std::array<int, 2>&ahead = HEADINGS[heading], &aside = HEADINGS[(heading + 1) % 4];
    at = {at[0] + ahead[0], at[1] + ahead[1]};
    // the two pixels ahead of the four at this corner: the middle of one lies half a step ahead and half a step aside
    const auto pixel_ahead = [&](int side) {
      const int x = 2 * at[0] + ahead[0] + side * aside[0], y = 2 * at[1] + ahead[1] + side * aside[1];
      return is_covered((x - 1) / 2, (y - 1) / 2);
    };
    const int turn = !pixel_ahead(1) ? 1 : pixel_ahead(-1) ? 3 : 0;
    if (turn != 0) border.push_back({low_[0] + at[0] * pixel_, low_[1] + at[1] * pixel_});
    heading = (heading + turn) % 4;
  } while (at != start || heading != 0);
  return border;
}

std::vector<std::vector<Flat>> DepthMap::borders() const {
  std::vector<std::vector<Flat>> borders;
  std::vector<bool> seen(depths_.size());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      if (is_covered(column, row) && !is_covered(column, row - 1) && !seen[static_cast<std::size_t>(row) * columns_ + column])
        borders.push_back(follow_border(column, row, seen));
    }
  }
  return borders;
}

}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// A chart: areas, lines and points over two axes, with a legend. Use it only in standalone pictures, because its colors do not follow a page.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/charts/axes.h"

namespace wholehand {

struct PlotAxis {
  std::string label;  // with its unit
  double low = 0, high = 1;
  bool is_logarithmic = false, is_angle = false, has_grid = false, has_numbers = true;
  std::vector<double> ticks{};  // empty: round ones
};

enum class MarkShape { none, disc, square, triangle, diamond };

struct PlotBox {
  double left = 0, bottom = 0, right = 0, top = 0;
};

// One thing that a plot shows, and its name in the legend.
struct PlotLayer {
  std::string label;                            // empty: not in the legend
  std::string color;                            // "#rrggbb"
  bool is_area = false;                         // the legend shows an area; else a line or a mark
  std::vector<PlotBox> boxes{};                 // filled; under all lines and points
  double line = 0;                              // width of the line through the points, units; 0: none
  const char* dashes = "";                      // lengths of dashes and gaps; empty: a solid line
  MarkShape mark = MarkShape::none;             // of each point
  double mark_size = 3;                         // half of its width, units
  std::vector<std::array<double, 2>> points{};  // a value outside the axes leaves a gap in the line
};

// A text beside a point. It avoids other notes and, if there is room, marks.
struct PlotNote {
  double x = 0, y = 0;
  std::string text;
};

struct Plot {
  std::string title;  // bold, above; may be empty
  PlotAxis x, y;
  std::vector<PlotLayer> layers;  // the last is on top
  std::vector<PlotNote> notes{};
  double label_rise = 12;  // of the y axis' label above the plot, units
};

// The rectangle of the axes, units; labels, numbers and title lie outside it.
struct PlotPlace {
  double left = 0, top = 0, right = 0, bottom = 0;
};

void put_plot(MarkupWriter& svg, const Plot& plot, const PlotPlace& place);

// Draws the labeled layers from left to right, in as many rows as needed. `y`: the baseline of the first row. Returns the last row's baseline.
double put_legend(MarkupWriter& svg, const std::vector<PlotLayer>& layers, double left, double y, double right);
constexpr double LEGEND_STEP = 15;  // from row to row, units
// The total height, from above the first row to below the last.
double legend_height(const std::vector<PlotLayer>& layers, double left, double right);

}  // namespace wholehand

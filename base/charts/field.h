// SPDX-License-Identifier: MIT
// A chart: a field of cells that are colored by their values.
#pragma once

#include <string>
#include <vector>

#include "base/charts/axes.h"

namespace wholehand {

// How values become colors.
struct ColorScale {
  std::string label;         // with its unit
  double low = 0, high = 1;  // of the first and the last color
  int digits = 2;            // of the numbers at its ends
  int steps = 0;             // > 0: the number of integers from `low` on, each with its own color
};

enum class CellKind : unsigned char { absent, hollow, filled };

// A field of cells, each of which has a color by its value, or is one of two grays.
struct FieldChart {
  ChartName name;
  std::string x_label, y_label;          // with units
  std::vector<double> x_edges, y_edges;  // ascending, one more than cells
  bool x_is_angle = false;
  std::vector<std::string> rows;  // names of the cells along y, from the first on, in place of a scale; empty: a scale
  double row_height = 13;         // of named rows, units
  double width = CHART_WIDTH;     // of all of it, units
  double plot_height = 236;       // of cells without names, units
  std::vector<double> values;     // y-major
  std::vector<CellKind> kinds;    // of the same size
  std::string absent, hollow;     // what the grays mean; empty: there are none
  ColorScale scale;
  struct Mark {
    double x = 0, y = 0;
    bool is_first = false;  // ringed
  };
  std::vector<Mark> marks;
  std::string mark;  // what a mark means
};
// For a page: an <svg> in it.
void write_chart(MarkupWriter& svg, const FieldChart& chart);
// The text of a picture of its own, `scale` pixels a unit. The name's id is not used.
std::string chart_picture(const FieldChart& chart, double scale);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// A chart: a field of cells colored by value.
#pragma once

#include <string>
#include <vector>

#include "base/charts/axes.h"

namespace wholehand {

// How values become colors.
struct ColorScale {
  std::string label;         // with its unit
  double low = 0, high = 1;  // value of the first and the last color
  int digits = 2;            // labels at the two ends
  int steps = 0;             // > 0: the number of integers from `low` on, each with its own color
};

enum class CellKind : unsigned char { absent, hollow, filled };

// A field of cells. Each cell is colored by its value, or is one of two grays.
struct FieldChart {
  ChartName name;
  std::string x_label, y_label;          // with units
  std::vector<double> x_edges, y_edges;  // ascending, one more than there are cells
  bool x_is_angle = false;
  std::vector<std::string> rows;  // names of the cells along y, from the first on, instead of a scale; empty: a scale
  double row_height = 13;         // of named rows, units
  double width = CHART_WIDTH;     // of the whole field, units
  double plot_height = 236;       // of cells without names, units
  std::vector<double> values;     // y-major
  std::vector<CellKind> kinds;    // of the same size
  std::string absent, hollow;     // meaning of the grays; empty: none
  ColorScale scale;
  struct Mark {
    double x = 0, y = 0;
    bool is_first = false;  // ringed
  };
  std::vector<Mark> marks;
  std::string mark;  // what a mark means
};
// An <svg> to embed in a page.
void write_chart(MarkupWriter& svg, const FieldChart& chart);
// The text of a standalone picture, `scale` pixels per unit. It does not use the name's id.
std::string chart_picture(const FieldChart& chart, double scale);

}  // namespace wholehand

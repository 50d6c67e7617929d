// SPDX-License-Identifier: MIT
// A chart: lines over a common x.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/charts/axes.h"

namespace wholehand {

// Each line has its label beside it.
struct LineChart {
  ChartName name;
  std::string x_label, y_label;
  bool x_is_angle = false;
  std::vector<double> x;  // ascending
  struct Line {
    std::string label;
    std::vector<double> y;           // NaN or infinite: a gap
    double shade = 0;                // 0..1: its color
    std::optional<double> marked_x;  // a dot on the line
    bool is_dashed = false;
    bool marks_ends = false;  // a cross at each point beyond which the line is infinite
  };
  std::vector<Line> lines;
  struct Limit {
    double y = 0;
    std::string label;
  };
  std::optional<Limit> limit;  // a level line, drawn if it lies within the chart
  double highest = 0;          // of the visible y; 0: of all lines
};
void write_chart(MarkupWriter& svg, const LineChart& chart);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// What the charts of a report share: their colours, their axes and their text. Lines and letters take the page's colours, so that they
// follow its light and its dark dress; sizes are those of a phone's column, and grow with the column.
#pragma once

#include <string>
#include <vector>

#include "report/html.h"

namespace wholehand {

constexpr double CHART_WIDTH = 360;                         // units: pixels at the width of a phone's column
constexpr double CHART_LETTER = 11;                         // units, as the page's style sheet has it
constexpr double CHART_LETTER_WIDTH = 0.56 * CHART_LETTER;  // on average

// What a screen reader says instead of the chart, and the id by which the page knows it.
struct ChartName {
  std::string id, title, description;
};

// The rectangle in which values are drawn, units, and what they are there.
struct PlotArea {
  double left = 0, top = 0, right = 0, bottom = 0;
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  double x(double value) const { return left + (value - x_low) / (x_high - x_low) * (right - left); }
  double y(double value) const { return bottom - (value - y_low) / (y_high - y_low) * (bottom - top); }
};

// Viridis at `share` in [0, 1]: equal steps look equal, to colour-blind readers and in grey print too. "#rrggbb".
std::string sequential_color(double share);

// Round values from `low` to `high`, about `count` of them; of angles in degrees by steps that people turn by.
std::vector<double> round_ticks(double low, double high, int count, bool is_angle = false);

// A length of the drawing, to a tenth of a unit.
std::string chart_number(double value);

// Opens the chart's <svg>, to be closed by the caller.
void open_chart(HtmlWriter& html, const ChartName& name, double height);
void put_text(HtmlWriter& html, double x, double y, const std::string& text, const char* style);
void put_line(HtmlWriter& html, double x1, double y1, double x2, double y2, const char* style);
void put_x_axis(HtmlWriter& html, const PlotArea& area, const std::vector<double>& ticks, const std::string& label);
void put_y_axis(HtmlWriter& html, const PlotArea& area, const std::vector<double>& ticks, const std::string& label, bool has_grid);

}  // namespace wholehand

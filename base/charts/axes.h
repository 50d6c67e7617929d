// SPDX-License-Identifier: MIT
// What all charts share: axes and text. Classes of CHART_RULES (base/charts/style.h) style them, so charts in a page follow its light and dark
// themes. Sizes suit a phone's column and scale with the container.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/charts/markup.h"

namespace wholehand {

constexpr double CHART_WIDTH = 360;                         // units: pixels of a chart in a page, at the width of a phone's column
constexpr double CHART_LETTER = 11;                         // units, as in the page's style sheet
constexpr double CHART_LETTER_WIDTH = 0.56 * CHART_LETTER;  // on average

// The chart's alternative text for screen readers, and the id by which the page refers to it.
struct ChartName {
  std::string id, title, description;
};

// The rectangle in which values are drawn, in units, and the range of values it shows. A logarithmic axis starts above 0.
struct PlotArea {
  double left = 0, top = 0, right = 0, bottom = 0;
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  bool x_is_logarithmic = false, y_is_logarithmic = false;
  double x(double value) const { return left + share(value, x_low, x_high, x_is_logarithmic) * (right - left); }
  double y(double value) const { return bottom - share(value, y_low, y_high, y_is_logarithmic) * (bottom - top); }

 private:
  // The point at a share of the way from `low` to `high`.
  static double share(double value, double low, double high, bool is_logarithmic) {
    return is_logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
};

// Round values from `low` to `high`, about `count` of them. Wide steps of angles are 10, 15, 30, 45 or 90 degrees.
std::vector<double> round_ticks(double low, double high, int count, bool is_angle = false);

// Ticks from `low` to `high`, both above 0: every 1, 2 and 5; over more than three decades, about eight powers of ten at most.
std::vector<double> logarithmic_ticks(double low, double high);

// Widens a range above 0 to the next 1, 2 or 5 that is at least a tenth beyond it.
struct TickRange {
  double low = 0, high = 0;
};
TickRange round_logarithmic_range(double least, double most);

// "0.05", "2000", "2\u00b710\u2074": the shortest label for a tick of a logarithmic axis.
std::string power_text(double value);

// The approximate width of a text, units.
double text_width(std::string_view text);

// Formats a length of the drawing, to a tenth of a unit.
std::string chart_number(double value);

// Opens the chart's <svg>; the caller closes it.
void open_chart(MarkupWriter& svg, const ChartName& name, double height, double width = CHART_WIDTH);
void put_text(MarkupWriter& svg, double x, double y, const std::string& text, const char* style);
void put_line(MarkupWriter& svg, double x1, double y1, double x2, double y2, const char* style);
void put_frame(MarkupWriter& svg, const PlotArea& area);
// Axis labels stand beside and above the axes; an empty label is omitted. A logarithmic axis shows powers.
void put_x_axis(MarkupWriter& svg, const PlotArea& area, const std::vector<double>& ticks, const std::string& label);
void put_y_axis(MarkupWriter& svg, const PlotArea& area, const std::vector<double>& ticks, const std::string& label, bool has_grid);

}  // namespace wholehand

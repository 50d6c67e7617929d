// SPDX-License-Identifier: MIT
#include "base/charts/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wholehand {
namespace {

std::string tick_text(double value, double step, bool is_logarithmic) {
  if (is_logarithmic) return power_text(value);
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return shown_number(value, digits);
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count, bool is_angle) {
  if (!(high > low)) return {low};
  const double wanted = (high - low) / count;
  double step = std::pow(10, std::floor(std::log10(wanted)));
  if (is_angle && wanted > 5) {
    for (const double turn : {10.0, 15.0, 30.0, 45.0, 90.0}) {
      step = turn;
      if (turn >= wanted) break;
    }
  } else {
    step *= wanted > 5 * step ? 10 : wanted > 2 * step ? 5 : wanted > step ? 2 : 1;
  }
  std::vector<double> ticks;
  const double first = std::ceil(low / step - 1e-9);
  for (int k = 0; k <= 4 * count && (first + k) * step <= high + 1e-9 * step; ++k) ticks.push_back((first + k) * step);
  return ticks;
}

std::vector<double> logarithmic_ticks(double low, double high) {
  constexpr int MOST_DECADES = 8;
  std::vector<double> ticks;
  if (!(low > 0 && high > low && std::isfinite(high))) return ticks;
  const bool is_wide = high / low > 1000 * 1.001;
  const int first = static_cast<int>(std::floor(std::log10(low))), last = static_cast<int>(std::ceil(std::log10(high)));
  const int apart = std::max(1, (last - first + MOST_DECADES - 1) / MOST_DECADES);
  for (int decade = first; decade <= last; ++decade) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double place = step * std::pow(10, decade);
      const bool is_left_out = is_wide && (step > 1 || decade % apart != 0);
      if (!is_left_out && place >= low * 0.999 && place <= high * 1.001) ticks.push_back(place);
    }
  }
  return ticks;
}

TickRange round_logarithmic_range(double least, double most) {
  TickRange range;
  for (int decade = static_cast<int>(std::floor(std::log10(least))) - 1; range.high == 0; ++decade) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double place = step * std::pow(10, decade);
      if (place <= least / 1.1) range.low = place;
      if (place >= most * 1.1 && range.high == 0) range.high = place;
    }
  }
  return range;
}

std::string power_text(double value) {
  constexpr const char* RAISED[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                    "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  if (!(value > 0) || !std::isfinite(value) || (value >= 0.999e-3 && value < 0.999e4)) return plain_number(value);
  const int power = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  const std::string factor = fmt::format("{:.3g}", value / std::pow(10, power));
  std::string text = factor == "1" ? "10" : factor + "\u00b710";
  if (power < 0) text += "\u207b";
  for (const char digit : std::to_string(std::abs(power))) text += RAISED[digit - '0'];
  return text;
}

double text_width(std::string_view text) {
  const auto letters =
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return CHART_LETTER_WIDTH * static_cast<double>(letters);
}

std::string chart_number(double value) {
  const std::string text = fmt::format("{:.1f}", value);
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

void open_chart(MarkupWriter& svg, const ChartName& name, double height, double width) {
  svg.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                   {"viewBox", fmt::format("0 0 {} {}", chart_number(width), chart_number(height))},
                   {"role", "img"},
                   {"aria-labelledby", name.id + "-title " + name.id + "-text"}});
  svg.element("title", name.title, {{"id", name.id + "-title"}});
  svg.element("desc", name.description, {{"id", name.id + "-text"}});
}

void put_text(MarkupWriter& svg, double x, double y, const std::string& text, const char* style) {
  svg.element("text", text, {{"x", chart_number(x)}, {"y", chart_number(y)}, {"class", style}});
}

void put_line(MarkupWriter& svg, double x1, double y1, double x2, double y2, const char* style) {
  svg.empty("path", {{"class", style},
                     {"d", fmt::format("M{} {}L{} {}", chart_number(x1), chart_number(y1), chart_number(x2), chart_number(y2))}});
}

void put_frame(MarkupWriter& svg, const PlotArea& area) {
  svg.empty("rect", {{"class", "frame"},
                     {"x", chart_number(area.left)},
                     {"y", chart_number(area.top)},
                     {"width", chart_number(area.right - area.left)},
                     {"height", chart_number(area.bottom - area.top)}});
}

void put_x_axis(MarkupWriter& svg, const PlotArea& area, const std::vector<double>& ticks, const std::string& label) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  for (const double tick : ticks) {
    put_line(svg, area.x(tick), area.bottom, area.x(tick), area.bottom + 4, "frame");
    put_text(svg, area.x(tick), area.bottom + 5 + CHART_LETTER, tick_text(tick, step, area.x_is_logarithmic), "mid");
  }
  if (!label.empty()) put_text(svg, 0.5 * (area.left + area.right), area.bottom + 8 + 2.2 * CHART_LETTER, label, "mid");
}

void put_y_axis(MarkupWriter& svg, const PlotArea& area, const std::vector<double>& ticks, const std::string& label,
                bool has_grid) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  for (const double tick : ticks) {
    const double y = area.y(tick);
    if (has_grid) put_line(svg, area.left, y, area.right, y, "grid");
    put_line(svg, area.left - 4, y, area.left, y, "frame");
    put_text(svg, area.left - 6, y + 0.35 * CHART_LETTER, tick_text(tick, step, area.y_is_logarithmic), "end");
  }
  if (!label.empty()) put_text(svg, area.left - 44, area.top - 12, label, "start");
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "report/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace wholehand {
namespace {

std::string tick_text(double value, double step) {
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return html_number(value, digits);
}

}  // namespace

std::string sequential_color(double share) {
  constexpr std::array<std::array<int, 3>, 10> VIRIDIS{{{0x44, 0x01, 0x54},
                                                        {0x48, 0x28, 0x78},
                                                        {0x3e, 0x4a, 0x89},
                                                        {0x31, 0x68, 0x8e},
                                                        {0x26, 0x82, 0x8e},
                                                        {0x1f, 0x9e, 0x89},
                                                        {0x35, 0xb7, 0x79},
                                                        {0x6e, 0xce, 0x58},
                                                        {0xb5, 0xde, 0x2b},
                                                        {0xfd, 0xe7, 0x25}}};
  const double place = std::clamp(share, 0.0, 1.0) * (VIRIDIS.size() - 1);
  const std::size_t i = std::min(VIRIDIS.size() - 2, static_cast<std::size_t>(place));
  const auto part = [&](int k) {
    return static_cast<int>(std::lround(VIRIDIS[i][k] + (place - static_cast<double>(i)) * (VIRIDIS[i + 1][k] - VIRIDIS[i][k])));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

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

std::string chart_number(double value) {
  const std::string text = fmt::format("{:.1f}", value);
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

void open_chart(HtmlWriter& html, const ChartName& name, double height) {
  html.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                    {"viewBox", fmt::format("0 0 {} {}", chart_number(CHART_WIDTH), chart_number(height))},
                    {"role", "img"},
                    {"aria-labelledby", name.id + "-title " + name.id + "-text"}});
  html.element("title", name.title, {{"id", name.id + "-title"}});
  html.element("desc", name.description, {{"id", name.id + "-text"}});
}

void put_text(HtmlWriter& html, double x, double y, const std::string& text, const char* style) {
  html.element("text", text, {{"x", chart_number(x)}, {"y", chart_number(y)}, {"class", style}});
}

void put_line(HtmlWriter& html, double x1, double y1, double x2, double y2, const char* style) {
  html.empty("path", {{"class", style},
                      {"d", fmt::format("M{} {}L{} {}", chart_number(x1), chart_number(y1), chart_number(x2), chart_number(y2))}});
}

void put_x_axis(HtmlWriter& html, const PlotArea& area, const std::vector<double>& ticks, const std::string& label) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  for (const double tick : ticks) {
    put_line(html, area.x(tick), area.bottom, area.x(tick), area.bottom + 4, "frame");
    put_text(html, area.x(tick), area.bottom + 5 + CHART_LETTER, tick_text(tick, step), "mid");
  }
  put_text(html, 0.5 * (area.left + area.right), area.bottom + 8 + 2.2 * CHART_LETTER, label, "mid");
}

void put_y_axis(HtmlWriter& html, const PlotArea& area, const std::vector<double>& ticks, const std::string& label, bool has_grid) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  for (const double tick : ticks) {
    const double y = area.y(tick);
    if (has_grid) put_line(html, area.left, y, area.right, y, "grid");
    put_line(html, area.left - 4, y, area.left, y, "frame");
    put_text(html, area.left - 6, y + 0.35 * CHART_LETTER, tick_text(tick, step), "end");
  }
  put_text(html, 2, area.top - 12, label, "start");
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "base/charts/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/charts/colors.h"
#include "base/charts/picture.h"

namespace wholehand {
namespace {

constexpr int SHADES = 48;  // of a continuous scale: finer differences are not seen

// Ticks of an axis of cells: at its cells, if each has at most one.
std::vector<double> cell_ticks(const std::vector<double>& edges, int count, bool is_angle) {
  if (edges.size() == 2) return {0.5 * (edges[0] + edges[1])};
  return round_ticks(edges.front(), edges.back(), count, is_angle);
}

// The color index of a value on the scale, and that color.
int shade_of(const ColorScale& scale, double value) {
  if (scale.steps > 0) return std::clamp(static_cast<int>(std::lround(value - scale.low)), 0, scale.steps - 1);
  const double share = scale.high > scale.low ? (value - scale.low) / (scale.high - scale.low) : 1;
  return std::clamp(static_cast<int>(share * SHADES), 0, SHADES - 1);
}

std::string shade_color(const ColorScale& scale, int shade) {
  const int last = scale.steps > 0 ? scale.steps - 1 : SHADES - 1;
  return sequential_color(last > 0 ? static_cast<double>(shade) / last : 1);
}

// Cells of one color form one path, and those above one another one rectangle, so that a chart of many cells stays small. Each extends slightly below
// its neighbors, so that a printer leaves no seams.
void put_cells(MarkupWriter& svg, const FieldChart& chart, const PlotArea& area) {
  constexpr double UNDER = 0.3;            // units
  constexpr int HOLLOW = -1, ABSENT = -2;  // the ground shows what is absent
  std::map<int, std::string> paths;        // by shade
  const std::size_t columns = chart.x_edges.size() - 1, rows = chart.y_edges.size() - 1;
  const auto shade_at = [&](std::size_t r, std::size_t c) {
    const CellKind kind = chart.kinds[r * columns + c];
    const double value = chart.values[r * columns + c];
    if (kind == CellKind::hollow) return HOLLOW;
    return kind == CellKind::absent || !std::isfinite(value) ? ABSENT : shade_of(chart.scale, value);
  };
  for (std::size_t c = 0; c < columns; ++c) {
    const std::string left = chart_number(area.x(chart.x_edges[c])), right = chart_number(area.x(chart.x_edges[c + 1]) + UNDER);
    for (std::size_t r = 0, end = 0; r < rows; r = end) {
      const int shade = shade_at(r, c);
      for (end = r + 1; end < rows && shade_at(end, c) == shade;) ++end;
      if (shade != ABSENT)
        paths[shade] += fmt::format("M{} {}H{}V{}H{}z", left, chart_number(area.y(chart.y_edges[r])), right,
                                    chart_number(area.y(chart.y_edges[end]) - UNDER), left);
    }
  }
  for (const auto& [shade, path] : paths) {
    if (shade == HOLLOW) {
      svg.empty("path", {{"class", "cell hollow"}, {"d", path}});
    } else {
      svg.empty("path", {{"class", "cell"}, {"fill", shade_color(chart.scale, shade)}, {"d", path}});
    }
  }
}

// A gray and its meaning, from `x` on. Returns the end.
double put_swatch(MarkupWriter& svg, double x, double y, const char* style, const std::string& label) {
  svg.empty("rect", {{"x", chart_number(x)}, {"y", chart_number(y - 9)}, {"width", "12"}, {"height", "10"}, {"class", style}});
  put_text(svg, x + 16, y, label, "start");
  return x + 22 + CHART_LETTER_WIDTH * static_cast<double>(label.size());
}

void put_scale(MarkupWriter& svg, const FieldChart& chart, const PlotArea& area, double y) {
  const ColorScale& scale = chart.scale;
  double x = area.left;
  put_text(svg, x, y, scale.label, "start");
  const double right = area.right;
  if (scale.steps > 0) {
    const double width = 22;
    x = right - width * scale.steps;
    for (int step = 0; step < scale.steps; ++step, x += width) {
      svg.empty("rect", {{"x", chart_number(x)},
                         {"y", chart_number(y - 9)},
                         {"width", chart_number(width)},
                         {"height", "10"},
                         {"fill", shade_color(scale, step)}});
      put_text(svg, x + 0.5 * width, y + 2 + CHART_LETTER, shown_number(scale.low + step, 0), "mid");
    }
    return;
  }
  const double width = std::max(132.0, 0.45 * (right - area.left)), left = right - width;
  for (int shade = 0; shade < SHADES; shade += 2) {
    const double from = left + width * shade / SHADES;
    svg.empty("rect", {{"x", chart_number(from)},
                       {"y", chart_number(y - 9)},
                       {"width", chart_number(width * 2 / SHADES + (shade + 2 < SHADES ? 0.3 : 0))},
                       {"height", "10"},
                       {"fill", shade_color(scale, shade + 1)}});
  }
  const std::string low = shown_number(scale.low, scale.digits), high = shown_number(scale.high, scale.digits);
  put_text(svg, left, y + 2 + CHART_LETTER, low, "start");
  put_text(svg, right, y + 2 + CHART_LETTER, high, "end");
  if (!(scale.high > scale.low)) return;
  // numbers in between if they do not touch those at the ends
  for (const double tick : round_ticks(scale.low, scale.high, std::max(1, static_cast<int>(width / 30)))) {
    const std::string text = shown_number(tick, scale.digits);
    const double at = left + width * (tick - scale.low) / (scale.high - scale.low), half = 0.5 * text_width(text) + 3;
    if (at - half > left + text_width(low) && at + half < right - text_width(high))
      put_text(svg, at, y + 2 + CHART_LETTER, text, "mid");
  }
}

void put_mark(MarkupWriter& svg, double x, double y, bool is_first) {
  if (is_first) {
    svg.empty("circle", {{"class", "halo"}, {"cx", chart_number(x)}, {"cy", chart_number(y)}, {"r", "6"}});
    svg.empty("circle", {{"class", "ring"}, {"cx", chart_number(x)}, {"cy", chart_number(y)}, {"r", "6"}});
  }
  svg.empty("circle", {{"class", "mark"}, {"cx", chart_number(x)}, {"cy", chart_number(y)}, {"r", "2.2"}});
}

// The positions of the parts of a chart that begins at y = `top`.
struct FieldPlaces {
  PlotArea area;
  double scale = 0, grays = 0, end = 0;  // y
};

FieldPlaces field_places(const FieldChart& chart, double top) {
  const bool has_names = !chart.rows.empty();
  const double tall = has_names ? chart.row_height * static_cast<double>(chart.rows.size()) : chart.plot_height;
  FieldPlaces places;
  places.area = {has_names ? 104.0 : 46.0, top + 26,
                 chart.width - 8,          top + 26 + tall,
                 chart.x_edges.front(),    chart.x_edges.back(),
                 chart.y_edges.front(),    chart.y_edges.back()};
  places.scale = places.area.bottom + 8 + 4 * CHART_LETTER;
  places.grays = places.scale + 2.6 * CHART_LETTER + 2;
  const bool has_grays = !chart.absent.empty() || !chart.hollow.empty() || !chart.marks.empty();
  places.end = places.scale + 2 * CHART_LETTER + (has_grays ? 1.4 * CHART_LETTER : 0);
  return places;
}

void put_field(MarkupWriter& svg, const FieldChart& chart, const FieldPlaces& places) {
  const PlotArea& area = places.area;
  svg.empty("rect", {{"class", "ground"},
                     {"x", chart_number(area.left)},
                     {"y", chart_number(area.top)},
                     {"width", chart_number(area.right - area.left)},
                     {"height", chart_number(area.bottom - area.top)}});
  put_cells(svg, chart, area);
  put_x_axis(svg, area, cell_ticks(chart.x_edges, 6, chart.x_is_angle), chart.x_label);
  if (!chart.rows.empty()) {
    for (std::size_t r = 0; r < chart.rows.size(); ++r)
      put_text(svg, area.left - 6, area.y(0.5 * (chart.y_edges[r] + chart.y_edges[r + 1])) + 0.35 * CHART_LETTER, chart.rows[r],
               "end");
    put_text(svg, 2, area.top - 12, chart.y_label, "start");
  } else {
    put_y_axis(svg, area, cell_ticks(chart.y_edges, std::max(6, static_cast<int>((area.bottom - area.top) / 34)), false),
               chart.y_label, false);
  }
  for (auto mark = chart.marks.rbegin(); mark != chart.marks.rend(); ++mark)
    put_mark(svg, area.x(mark->x), area.y(mark->y), mark->is_first);
  put_scale(svg, chart, area, places.scale);
  double x = 2;
  if (!chart.hollow.empty()) x = put_swatch(svg, x, places.grays, "hollow", chart.hollow);
  if (!chart.absent.empty()) x = put_swatch(svg, x, places.grays, "ground", chart.absent);
  if (!chart.marks.empty()) {
    put_mark(svg, x + 6, places.grays - 4, chart.marks.front().is_first);
    put_text(svg, x + 16, places.grays, chart.mark, "start");
  }
}

}  // namespace

void write_chart(MarkupWriter& svg, const FieldChart& chart) {
  const FieldPlaces places = field_places(chart, 0);
  open_chart(svg, chart.name, places.end);
  put_field(svg, chart, places);
  svg.close();
}

std::string chart_picture(const FieldChart& chart, double scale) {
  MarkupWriter svg;
  const double top = open_picture(svg, {chart.name.title, chart.name.description, chart.width, field_places(chart, 0).end, scale});
  const FieldPlaces places = field_places(chart, top);
  put_field(svg, chart, places);
  put_frame(svg, places.area);
  return svg.close().written();
}

}  // namespace wholehand

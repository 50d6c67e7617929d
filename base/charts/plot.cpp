// SPDX-License-Identifier: MIT
#include "base/charts/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wholehand {
namespace {

constexpr double SAMPLE_WIDTH = 20;  // of a layer in the legend, units

// ---- marks ----

std::string mark_path(MarkShape shape, double x, double y, double size) {
  const auto at = [&](double dx, double dy) { return chart_number(x + dx * size) + " " + chart_number(y + dy * size); };
  switch (shape) {
    case MarkShape::disc:
      return fmt::format("M{}A{s} {s} 0 1 0 {}A{s} {s} 0 1 0 {}z", at(-1, 0), at(1, 0), at(-1, 0),
                         fmt::arg("s", chart_number(size)));
    case MarkShape::square:
      return fmt::format("M{}L{}L{}L{}z", at(-0.9, -0.9), at(0.9, -0.9), at(0.9, 0.9), at(-0.9, 0.9));
    case MarkShape::triangle:
      return fmt::format("M{}L{}L{}z", at(0, -1.15), at(1.1, 0.85), at(-1.1, 0.85));
    case MarkShape::diamond:
      return fmt::format("M{}L{}L{}L{}z", at(0, -1.25), at(1.25, 0), at(0, 1.25), at(-1.25, 0));
    case MarkShape::none:
      break;
  }
  return {};
}

// ---- layers ----

PlotArea plot_area(const Plot& plot, const PlotPlace& place) {
  return {place.left,  place.top,  place.right, place.bottom,          plot.x.low,
          plot.x.high, plot.y.low, plot.y.high, plot.x.is_logarithmic, plot.y.is_logarithmic};
}

// Whether a value can be drawn: it is finite on the page, and not too many plots away.
bool has_place(const PlotArea& area, const std::array<double, 2>& point) {
  constexpr double FAR = 1e5;  // units
  const double x = area.x(point[0]), y = area.y(point[1]);
  return std::abs(x) < FAR && std::abs(y) < FAR;
}

bool is_within(const PlotArea& area, const std::array<double, 2>& point) {
  constexpr double SLACK = 0.05;  // units
  const double x = area.x(point[0]), y = area.y(point[1]);
  return x >= area.left - SLACK && x <= area.right + SLACK && y >= area.top - SLACK && y <= area.bottom + SLACK;
}

// All boxes of a layer are one path. Each extends slightly below its neighbor, so that a printer leaves no seams.
void put_boxes(MarkupWriter& svg, const PlotArea& area, const PlotLayer& layer) {
  constexpr double UNDER = 0.3;  // units
  std::string path;
  for (const PlotBox& box : layer.boxes) {
    const double left = std::clamp(area.x(box.left), area.left, area.right),
                 top = std::clamp(area.y(box.top), area.top, area.bottom);
    const double right = std::clamp(area.x(box.right) + UNDER, area.left, area.right);
    const double bottom = std::clamp(area.y(box.bottom) + UNDER, area.top, area.bottom);
    if (!(right > left && bottom > top)) continue;  // beyond the axes, or no number
    path += fmt::format("M{0} {1}H{2}V{3}H{0}z", chart_number(left), chart_number(top), chart_number(right), chart_number(bottom));
  }
  if (!path.empty()) svg.empty("path", {{"class", "cell"}, {"fill", layer.color}, {"d", path}});
}

// Leaves out the points between the first and the last of a level run.
std::string line_path(const PlotArea& area, const std::vector<std::array<double, 2>>& points) {
  std::string path;
  bool is_drawn = false;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!has_place(area, points[k])) {
      is_drawn = false;
      continue;
    }
    const auto is_level = [&](std::size_t other) {
      return has_place(area, points[other]) && chart_number(area.y(points[other][1])) == chart_number(area.y(points[k][1]));
    };
    const bool is_between = is_drawn && k + 1 < points.size() && is_level(k - 1) && is_level(k + 1);
    if (!is_between)
      path += fmt::format("{}{} {}", is_drawn ? "L" : "M", chart_number(area.x(points[k][0])), chart_number(area.y(points[k][1])));
    is_drawn = true;
  }
  return path;
}

void put_layer_line(MarkupWriter& svg, const PlotArea& area, const PlotLayer& layer) {
  const std::string path = line_path(area, layer.points);
  if (path.empty()) return;
  MarkupWriter::Attributes attributes{
      {"fill", "none"}, {"stroke", layer.color}, {"stroke-width", chart_number(layer.line)}, {"stroke-linejoin", "round"}};
  if (*layer.dashes) attributes.emplace_back("stroke-dasharray", layer.dashes);
  attributes.emplace_back("d", path);
  svg.empty("path", attributes);
}

void put_layer_marks(MarkupWriter& svg, const PlotArea& area, const PlotLayer& layer) {
  std::string path;
  for (const auto& point : layer.points)
    if (is_within(area, point)) path += mark_path(layer.mark, area.x(point[0]), area.y(point[1]), layer.mark_size);
  if (!path.empty()) svg.empty("path", {{"fill", layer.color}, {"d", path}});
}

// Lines may leave the axes; the part outside is clipped.
void put_layer_lines(MarkupWriter& svg, const PlotArea& area, const std::vector<PlotLayer>& layers) {
  const std::string id = fmt::format("axes-{:.0f}-{:.0f}", area.left, area.top);
  svg.open("clipPath", {{"id", id}});
  svg.empty("rect", {{"x", chart_number(area.left)},
                     {"y", chart_number(area.top)},
                     {"width", chart_number(area.right - area.left)},
                     {"height", chart_number(area.bottom - area.top)}});
  svg.close().open("g", {{"clip-path", "url(#" + id + ")"}});
  for (const PlotLayer& layer : layers)
    if (layer.line > 0) put_layer_line(svg, area, layer);
  svg.close();
  for (const PlotLayer& layer : layers)
    if (layer.mark != MarkShape::none) put_layer_marks(svg, area, layer);
}

// ---- notes ----

struct NoteBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};

double overlap_of(const NoteBox& a, const NoteBox& b) {
  const double wide = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double high = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  return wide > 0 && high > 0 ? wide * high : 0;
}

// The place around the point, at eight sides and two distances, that covers the least drawn area and the least outside the axes.
NoteBox note_box(const PlotArea& area, const PlotNote& note, const std::vector<NoteBox>& taken) {
  constexpr double HALF_HEIGHT = 0.42 * CHART_LETTER;
  const double half = 0.5 * text_width(note.text), x = area.x(note.x), y = area.y(note.y);
  NoteBox best;
  double least = std::numeric_limits<double>::infinity();
  for (const double apart : {7.0, 13.0}) {
    for (const auto& [dx, dy] : {std::pair{1, -1}, {-1, -1}, {1, 1}, {-1, 1}, {1, 0}, {-1, 0}, {0, -1}, {0, 1}}) {
      const double way = (dx != 0 && dy != 0 ? 0.7 : 1) * apart;  // as far from the point where it is askew
      const double middle_x = x + dx * (way + half), middle_y = y + dy * (way + HALF_HEIGHT);
      const NoteBox box{middle_x - half, middle_y - HALF_HEIGHT, middle_x + half, middle_y + HALF_HEIGHT};
      const NoteBox all{area.left, area.top, area.right, area.bottom};
      double cost = 0.5 * apart + 10 * (4 * half * HALF_HEIGHT - overlap_of(box, all));
      for (const NoteBox& other : taken) cost += overlap_of(box, other);
      if (cost >= least) continue;
      least = cost;
      best = box;
    }
  }
  return best;
}

void put_notes(MarkupWriter& svg, const PlotArea& area, const Plot& plot) {
  std::vector<NoteBox> taken;
  for (const PlotLayer& layer : plot.layers) {
    if (layer.mark == MarkShape::none) continue;
    const double size = layer.mark_size;
    for (const auto& point : layer.points) {
      const double x = area.x(point[0]), y = area.y(point[1]);
      if (is_within(area, point)) taken.push_back({x - size, y - size, x + size, y + size});
    }
  }
  for (const PlotNote& note : plot.notes) {
    if (!is_within(area, {note.x, note.y})) continue;
    const NoteBox box = taken.emplace_back(note_box(area, note, taken));
    put_text(svg, 0.5 * (box.left + box.right), box.bottom, note.text, "mid halo-text");
  }
}

// ---- axes ----

std::vector<double> axis_ticks(const PlotAxis& axis, int count) {
  if (!axis.ticks.empty()) return axis.ticks;
  return axis.is_logarithmic ? logarithmic_ticks(axis.low, axis.high) : round_ticks(axis.low, axis.high, count, axis.is_angle);
}

void put_axes(MarkupWriter& svg, const PlotArea& area, const Plot& plot) {
  const std::vector<double> xs = axis_ticks(plot.x, static_cast<int>(std::max(3.0, (area.right - area.left) / 60)));
  const std::vector<double> ys = axis_ticks(plot.y, static_cast<int>(std::max(3.0, (area.bottom - area.top) / 26)));
  if (plot.x.has_grid)
    for (const double tick : xs) put_line(svg, area.x(tick), area.top, area.x(tick), area.bottom, "grid");
  put_y_axis(svg, area, ys, "", plot.y.has_grid);
  if (plot.x.has_numbers) {
    put_x_axis(svg, area, xs, plot.x.label);
  } else {
    for (const double tick : xs) put_line(svg, area.x(tick), area.bottom, area.x(tick), area.bottom + 4, "frame");
  }
  put_text(svg, area.left - 44, area.top - plot.label_rise, plot.y.label, "start");
  if (!plot.title.empty()) put_text(svg, area.left - 44, area.top - plot.label_rise - LEGEND_STEP, plot.title, "head");
}

}  // namespace

void put_plot(MarkupWriter& svg, const Plot& plot, const PlotPlace& place) {
  const PlotArea area = plot_area(plot, place);
  for (const PlotLayer& layer : plot.layers) put_boxes(svg, area, layer);
  put_axes(svg, area, plot);
  put_layer_lines(svg, area, plot.layers);
  put_notes(svg, area, plot);
  put_frame(svg, area);
}

double put_legend(MarkupWriter& svg, const std::vector<PlotLayer>& layers, double left, double y, double right) {
  double x = left;
  for (const PlotLayer& layer : layers) {
    if (layer.label.empty()) continue;
    const double width = SAMPLE_WIDTH + 5 + text_width(layer.label);
    if (x > left && x + width > right) {
      x = left;
      y += LEGEND_STEP;
    }
    const double middle = y - 0.35 * CHART_LETTER;
    if (layer.is_area) {
      svg.empty("rect", {{"x", chart_number(x + 4)},
                         {"y", chart_number(middle - 5)},
                         {"width", "14"},
                         {"height", "10"},
                         {"fill", layer.color},
                         {"stroke", "#808080"},
                         {"stroke-width", "0.5"}});
    } else {
      PlotLayer sample = layer;
      sample.points = {{x, middle}, {x + 0.5 * SAMPLE_WIDTH, middle}, {x + SAMPLE_WIDTH, middle}};
      constexpr double WIDE = 1e4;  // beyond any picture: values are units
      const PlotArea units{0, 0, WIDE, WIDE, 0, WIDE, WIDE, 0};
      if (layer.line > 0) put_layer_line(svg, units, sample);
      sample.points = {{x + 0.5 * SAMPLE_WIDTH, middle}};
      if (layer.mark != MarkShape::none) put_layer_marks(svg, units, sample);
    }
    put_text(svg, x + SAMPLE_WIDTH + 5, y, layer.label, "start");
    x += width + 16;
  }
  return y;
}

double legend_height(const std::vector<PlotLayer>& layers, double left, double right) {
  MarkupWriter scratch;
  return put_legend(scratch, layers, left, 0, right) + LEGEND_STEP;
}

}  // namespace wholehand

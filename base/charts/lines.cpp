// SPDX-License-Identifier: MIT
#include "base/charts/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/charts/colors.h"

namespace wholehand {
namespace {

using Point = std::array<double, 2>;  // units

// A label: its box, with the sample of the line's color at its left.
struct LabelBox {
  double left = 0, top = 0, width = 0;
  double right() const { return left + width; }
  double bottom() const { return top + CHART_LETTER; }
};
constexpr double KEY_WIDTH = 14;  // of that sample

bool overlap(const LabelBox& a, const LabelBox& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

// How much of a line runs through a box, estimated at closely spaced points.
double length_within(const LabelBox& box, const std::vector<Point>& line) {
  constexpr double STEP = 3;
  double inside = 0;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Point &a = line[k], &b = line[k + 1];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const int steps = std::max(1, static_cast<int>(length / STEP));
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps, x = a[0] + t * (b[0] - a[0]), y = a[1] + t * (b[1] - a[1]);
      if (x > box.left - 2 && x < box.right() + 2 && y > box.top - 2 && y < box.bottom() + 2) inside += STEP;
    }
  }
  return inside;
}

// From a place to the nearest point of a line.
double way_to(const Point& p, const std::vector<Point>& line) {
  double least = CHART_WIDTH;
  for (const Point& q : line) least = std::min(least, std::hypot(p[0] - q[0], p[1] - q[1]));
  return least;
}

double way_to_others(const Point& p, const std::vector<std::vector<Point>>& lines, std::size_t own) {
  double least = CHART_WIDTH;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (i != own) least = std::min(least, way_to(p, lines[i]));
  return least;
}

// A place for each line's label: beside the line where it is furthest from the others, nearer to it than to them, and not on a line or another label.
std::vector<LabelBox> place_labels(const PlotArea& area, const std::vector<std::vector<Point>>& lines,
                                   const std::vector<std::string>& labels) {
  std::vector<LabelBox> placed;
  for (std::size_t own = 0; own < lines.size(); ++own) {
    LabelBox best;
    double least = 1e300;
    best.width = KEY_WIDTH + CHART_LETTER_WIDTH * static_cast<double>(labels[own].size());
    for (const Point& p : lines[own]) {
      const double apart = way_to_others(p, lines, own);
      for (const double dx : {4.0, -0.5 * best.width, -4.0 - best.width}) {
        for (const double dy : {-4.0 - CHART_LETTER, 4.0, -0.5 * CHART_LETTER}) {
          LabelBox box{p[0] + dx, p[1] + dy, best.width};
          if (box.left < area.left + 2 || box.right() > area.right || box.top < area.top - CHART_LETTER ||
              box.bottom() > area.bottom)
            continue;
          const Point middle{box.left + 0.5 * box.width, box.top + 0.5 * CHART_LETTER};
          const double nearer = way_to_others(middle, lines, own) - way_to(middle, lines[own]);
          double cost = -std::min(apart, 30.0) - 2 * std::min(nearer, 10.0) + (apart < 4 ? 20 : 0);
          for (const auto& line : lines) cost += 4 * length_within(box, line);
          for (const LabelBox& other : placed) cost += overlap(box, other) ? 1000 : 0;
          if (cost >= least) continue;
          least = cost;
          best = box;
        }
      }
    }
    if (least == 1e300) best = {area.left + 4, area.top + CHART_LETTER * static_cast<double>(own), best.width};
    placed.push_back(best);
  }
  return placed;
}

// The height of a line at x, interpolated; NaN in a gap.
double height_at(const LineChart& chart, const LineChart::Line& line, double x) {
  const auto above = std::lower_bound(chart.x.begin(), chart.x.end(), x);
  if (above == chart.x.end()) return std::nan("");
  const auto i = static_cast<std::size_t>(above - chart.x.begin());
  if (i == 0 || *above == x) return *above == x ? line.y[i] : std::nan("");
  const double t = (x - chart.x[i - 1]) / (chart.x[i] - chart.x[i - 1]);
  return line.y[i - 1] + t * (line.y[i] - line.y[i - 1]);
}

PlotArea area_of(const LineChart& chart) {
  double highest = chart.highest, lowest = 0;
  for (const auto& line : chart.lines) {
    for (const double y : line.y) {
      if (!std::isfinite(y)) continue;
      if (chart.highest == 0) highest = std::max(highest, y);
      lowest = std::min(lowest, y);
    }
  }
  if (!(highest > lowest)) highest = lowest + 1;
  const double room = chart.x.size() > 1 ? 0 : 1;
  PlotArea area{46, 30, CHART_WIDTH - 10, 236, chart.x.front() - room, chart.x.back() + room, lowest, highest};
  if (const auto ticks = round_ticks(lowest, highest, 5); chart.highest == 0 && ticks.size() > 1) {  // up to a whole step
    const double step = ticks[1] - ticks[0];
    area.y_high = std::ceil(highest / step - 1e-9) * step;
  }
  return area;
}

// The visible points of a line, the path through them, and those with an infinite neighbor.
struct DrawnLine {
  std::vector<Point> points;
  std::string path;
  std::vector<Point> ends;
};

DrawnLine drawn_line(const PlotArea& area, const LineChart& chart, const LineChart::Line& line) {
  DrawnLine drawn;
  bool is_drawn = false;
  const auto is_infinite = [&line](std::size_t k) { return k < line.y.size() && std::isinf(line.y[k]); };
  for (std::size_t k = 0; k < line.y.size(); ++k) {
    const bool is_there = std::isfinite(line.y[k]) && line.y[k] <= area.y_high;
    if (is_there) {
      const Point& p = drawn.points.emplace_back(Point{area.x(chart.x[k]), area.y(line.y[k])});
      drawn.path += fmt::format("{}{} {}", is_drawn ? "L" : "M", chart_number(p[0]), chart_number(p[1]));
      if ((k > 0 && is_infinite(k - 1)) || is_infinite(k + 1)) drawn.ends.push_back(p);
    }
    is_drawn = is_there;
  }
  return drawn;
}

void put_cross(MarkupWriter& svg, const Point& at) {
  constexpr double HALF = 4;  // of its width, units
  const auto corner = [&at](double x, double y) { return chart_number(at[0] + x * HALF) + " " + chart_number(at[1] + y * HALF); };
  const std::string path = fmt::format("M{}L{}M{}L{}", corner(-1, -1), corner(1, 1), corner(-1, 1), corner(1, -1));
  svg.empty("path", {{"class", "line end-of-line"}, {"d", path}});
}

void put_curve(MarkupWriter& svg, const PlotArea& area, const LineChart& chart, const LineChart::Line& line, const DrawnLine& drawn,
               const std::string& style) {
  svg.open("g", {{"style", style}});
  MarkupWriter::Attributes curve{{"class", "line"}, {"d", drawn.path}};
  if (line.is_dashed) curve.emplace_back("stroke-dasharray", "5 3");
  svg.empty("path", curve);
  if (line.marks_ends) {
    for (const Point& end : drawn.ends) put_cross(svg, end);
  }
  const auto dot = [&](double x, double y) {
    svg.empty("circle", {{"class", "dot"}, {"cx", chart_number(x)}, {"cy", chart_number(y)}, {"r", "3.5"}});
  };
  if (chart.x.size() == 1) dot(drawn.points[0][0], drawn.points[0][1]);
  const double marked = line.marked_x ? height_at(chart, line, *line.marked_x) : std::nan("");
  if (std::isfinite(marked) && marked <= area.y_high) dot(area.x(*line.marked_x), area.y(marked));
  svg.close();
}

void put_label(MarkupWriter& svg, const LabelBox& box, const std::string& label, const std::string& style) {
  const double middle = box.top + 0.5 * CHART_LETTER;
  svg.open("g", {{"style", style}});
  put_line(svg, box.left, middle, box.left + KEY_WIDTH - 4, middle, "key");
  put_text(svg, box.left + KEY_WIDTH, box.top + 0.85 * CHART_LETTER, label, "halo-text");
  svg.close();
}

}  // namespace

void write_chart(MarkupWriter& svg, const LineChart& chart) {
  const PlotArea area = area_of(chart);
  open_chart(svg, chart.name, area.bottom + 10 + 2.6 * CHART_LETTER);
  put_y_axis(svg, area, round_ticks(area.y_low, area.y_high, 5), chart.y_label, true);
  put_x_axis(svg, area, round_ticks(area.x_low, area.x_high, 6, chart.x_is_angle), chart.x_label);
  if (chart.limit && chart.limit->y <= area.y_high) {
    put_line(svg, area.left, area.y(chart.limit->y), area.right, area.y(chart.limit->y), "limit");
    put_text(svg, area.right, area.y(chart.limit->y) - 4, chart.limit->label, "end");
  }
  std::vector<std::vector<Point>> drawn;
  std::vector<std::string> labels, styles;
  for (const auto& line : chart.lines) {
    DrawnLine curve = drawn_line(area, chart, line);
    if (curve.points.empty()) continue;
    labels.push_back(line.label);
    // the palest shades are lost on white, the darkest on black
    styles.push_back(
        fmt::format("--day:{};--night:{}", sequential_color(0.78 * line.shade), sequential_color(0.3 + 0.7 * line.shade)));
    put_curve(svg, area, chart, line, curve, styles.back());
    drawn.push_back(std::move(curve.points));
  }
  const std::vector<LabelBox> boxes = place_labels(area, drawn, labels);
  for (std::size_t i = 0; i < boxes.size(); ++i) put_label(svg, boxes[i], labels[i], styles[i]);
  svg.close();
}

}  // namespace wholehand

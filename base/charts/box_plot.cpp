// SPDX-License-Identifier: MIT
#include "base/charts/box_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/statistics/interval.h"

namespace wholehand {
namespace {

// units
constexpr double WIDEST_BOX = 44, DOT = 2.2, DIAMOND = 4, CAP = 3;
constexpr double TALLEST_LABEL = 90;  // slanted
constexpr double SLANT = 50;          // degrees
const double SLANT_COS = std::cos(SLANT * 3.14159265358979323846 / 180), SLANT_SIN = std::sin(SLANT * 3.14159265358979323846 / 180);

// ---- numbers ----

std::string spoken_group(const BoxChart::Group& group) {
  const Box& box = group.box;
  if (box.count == 0) return fmt::format(" {}: no values.", group.label);
  const auto text = [](double value) { return fmt::format("{:.3g}", value); };
  std::string spoken = fmt::format(" {}: median {}, quartiles {} and {}, whiskers from {} to {}", group.label, text(box.median),
                                   text(box.lower_quartile), text(box.upper_quartile), text(box.low), text(box.high));
  const std::size_t outliers = box.outliers.size() + box.outliers_beside;
  if (outliers > 0) spoken += fmt::format(", {} outlier{}", outliers, outliers == 1 ? "" : "s");
  if (box.outliers_beside > 0) spoken += fmt::format(" of which {} are drawn", box.outliers.size());
  return spoken + ".";
}

bool has_mark(const BoxChart::Group& group) { return group.mark && std::isfinite(group.mark->mean); }

std::string spoken_mark(const BoxChart& chart, const BoxChart::Group& group) {
  if (!has_mark(group)) return "";
  std::string spoken = fmt::format(" {}, {}: {:.3g}", group.label, chart.mark, group.mark->mean);
  if (std::isfinite(group.mark->deviation)) spoken += fmt::format(" \u00b1 {:.3g}", group.mark->deviation);
  return spoken + ".";
}

ChartName spoken_name(const BoxChart& chart) {
  ChartName name = chart.name;
  for (const BoxChart::Group& group : chart.groups) name.description += spoken_group(group) + spoken_mark(chart, group);
  return name;
}

// ---- where things are ----

// The y axis starts at 0 if no value is below it and this wastes little space.
void set_heights(const BoxChart& chart, PlotArea& area) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  const auto widen = [&](double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const BoxChart::Group& group : chart.groups) {
    if (group.box.count > 0) {
      widen(group.box.low);
      widen(group.box.high);
      for (const double outlier : group.box.outliers) widen(outlier);
    }
    if (!has_mark(group)) continue;
    widen(group.mark->mean);
    widen(group.mark->mean - group.mark->deviation);
    widen(group.mark->mean + group.mark->deviation);
  }
  if (!(high >= low)) low = high = 0;
  const bool from_zero = low >= 0 && low < 0.5 * high;
  const double room = high > low ? 0.05 * (high - low) : high == 0 ? 1 : 0.1 * std::abs(high);
  area.y_low = from_zero ? 0 : low - room;
  area.y_high = high + room;
}

bool leaves_some_beside(const BoxChart& chart) {
  return std::any_of(chart.groups.begin(), chart.groups.end(), [](const auto& group) { return group.box.outliers_beside > 0; });
}

// Between the axis' label and the box, where their numbers stand.
double room_of_numbers(const BoxChart& chart) { return leaves_some_beside(chart) ? CHART_LETTER : 0; }

PlotArea area_of(const BoxChart& chart) {
  PlotArea area{46, 30, CHART_WIDTH - 10, 236, 0, static_cast<double>(std::max<std::size_t>(1, chart.groups.size())), 0, 1};
  area.top += room_of_numbers(chart);
  set_heights(chart, area);
  return area;
}

double slot_width(const PlotArea& area) { return area.x(1) - area.x(0); }

// ---- parts ----

void put_disc(std::string& path, double x, double y) {
  path += fmt::format("M{0} {1}a{2} {2} 0 1 0 {3} 0a{2} {2} 0 1 0 -{3} 0z", chart_number(x - DOT), chart_number(y),
                      chart_number(DOT), chart_number(2 * DOT));
}

void put_box(MarkupWriter& svg, const PlotArea& area, const Box& box, double middle, double half) {
  const double top = area.y(box.upper_quartile), bottom = area.y(box.lower_quartile);
  for (const auto& [from, to] : {std::pair{box.lower_quartile, box.low}, {box.upper_quartile, box.high}}) {
    put_line(svg, middle, area.y(from), middle, area.y(to), "whisker");
    put_line(svg, middle - 0.5 * half, area.y(to), middle + 0.5 * half, area.y(to), "whisker");
  }
  svg.empty("rect", {{"class", "box"},
                     {"x", chart_number(middle - half)},
                     {"y", chart_number(top)},
                     {"width", chart_number(2 * half)},
                     {"height", chart_number(bottom - top)}});
  put_line(svg, middle - half, area.y(box.median), middle + half, area.y(box.median), "median");
  std::string discs;
  for (const double outlier : box.outliers) put_disc(discs, middle, area.y(outlier));
  if (!discs.empty()) svg.empty("path", {{"class", "outlier"}, {"d", discs}});
}

void put_diamond(MarkupWriter& svg, double x, double y) {
  svg.empty("path",
            {{"class", "box-mark"},
             {"d", fmt::format("M{0} {1}L{2} {3}L{0} {4}L{5} {3}z", chart_number(x), chart_number(y - DIAMOND),
                               chart_number(x + DIAMOND), chart_number(y), chart_number(y + DIAMOND), chart_number(x - DIAMOND))}});
}

void put_mark(MarkupWriter& svg, const PlotArea& area, const BoxChart::Mark& mark, double x) {
  if (std::isfinite(mark.deviation)) {
    const double top = area.y(mark.mean + mark.deviation), bottom = area.y(mark.mean - mark.deviation);
    put_line(svg, x, top, x, bottom, "box-mark");
    for (const double end : {top, bottom}) put_line(svg, x - CAP, end, x + CAP, end, "box-mark");
  }
  put_diamond(svg, x, area.y(mark.mean));
}

// As much of a text as fits, with an ellipsis if it is cut.
std::string cut(const std::string& text, double room) {
  if (text_width(text) <= room) return text;
  std::string shown = text;
  while (!shown.empty() && text_width(shown) + CHART_LETTER_WIDTH > room) {
    while (!shown.empty() && (static_cast<unsigned char>(shown.back()) & 0xC0) == 0x80) shown.pop_back();
    if (!shown.empty()) shown.pop_back();
  }
  return shown + "\u2026";
}

// Level if all of them fit, else all slanted. Returns the y of the lowest foot.
double put_labels(MarkupWriter& svg, const PlotArea& area, const BoxChart& chart) {
  const bool is_level = std::all_of(chart.groups.begin(), chart.groups.end(),
                                    [&](const auto& group) { return text_width(group.label) <= slot_width(area) - 4; });
  double foot = area.bottom + 5 + CHART_LETTER;
  for (std::size_t k = 0; k < chart.groups.size(); ++k) {
    const double x = area.x(static_cast<double>(k) + 0.5), y = area.bottom + 5 + CHART_LETTER;
    put_line(svg, x, area.bottom, x, area.bottom + 4, "frame");
    if (is_level) {
      put_text(svg, x, y, chart.groups[k].label, "mid");
      continue;
    }
    const std::string shown = cut(chart.groups[k].label, std::min(x / SLANT_COS, TALLEST_LABEL / SLANT_SIN));
    svg.element("text", shown,
                {{"transform", fmt::format("translate({} {})rotate(-{})", chart_number(x + 3), chart_number(y - 2), SLANT)},
                 {"class", "end"}});
    foot = std::max(foot, y + SLANT_SIN * text_width(shown));
  }
  return foot;
}

// The meaning of marks and of the numbers above the boxes. Returns the y of its foot.
double put_key(MarkupWriter& svg, const PlotArea& area, const BoxChart& chart, double foot) {
  if (!chart.mark.empty() && std::any_of(chart.groups.begin(), chart.groups.end(), has_mark)) {
    foot += 1.5 * CHART_LETTER;
    put_diamond(svg, area.left + DIAMOND, foot - 0.35 * CHART_LETTER);
    put_text(svg, area.left + 14, foot, chart.mark, "start");
  }
  if (leaves_some_beside(chart)) {
    foot += 1.5 * CHART_LETTER;
    put_text(svg, area.left, foot, "+n: so many outliers more than are drawn", "start");
  }
  return foot;
}

}  // namespace

Box box_of(std::span<const double> values) {
  std::vector<double> ascending;
  for (const double value : values)
    if (std::isfinite(value)) ascending.push_back(value);
  if (ascending.empty()) return {};
  std::sort(ascending.begin(), ascending.end());
  Box box;
  box.count = ascending.size();
  box.lower_quartile = percentile_of(ascending, 0.25);
  box.median = percentile_of(ascending, 0.5);
  box.upper_quartile = percentile_of(ascending, 0.75);
  const double reach = 1.5 * (box.upper_quartile - box.lower_quartile);
  const auto first = std::lower_bound(ascending.begin(), ascending.end(), box.lower_quartile - reach);
  const auto last = std::upper_bound(ascending.begin(), ascending.end(), box.upper_quartile + reach);
  box.low = std::min(*first, box.lower_quartile);
  box.high = std::max(*(last - 1), box.upper_quartile);
  std::vector<double> beyond(ascending.begin(), first);
  beyond.insert(beyond.end(), last, ascending.end());
  if (beyond.size() > Box::MOST_OUTLIERS) {
    box.outliers_beside = beyond.size() - Box::MOST_OUTLIERS;
    // the first and the last are among them
    for (std::size_t k = 0; k < Box::MOST_OUTLIERS; ++k)
      box.outliers.push_back(beyond[k * (beyond.size() - 1) / (Box::MOST_OUTLIERS - 1)]);
  } else {
    box.outliers = std::move(beyond);
  }
  return box;
}

void write_chart(MarkupWriter& svg, const BoxChart& chart) {
  const PlotArea area = area_of(chart);
  MarkupWriter under;  // the text under the axes decides how high the chart is
  const double foot = put_key(under, area, chart, put_labels(under, area, chart));
  open_chart(svg, spoken_name(chart), foot + 4);
  put_y_axis(svg, area, round_ticks(area.y_low, area.y_high, 5), "", true);
  put_text(svg, area.left - 44, area.top - 12 - room_of_numbers(chart), chart.y_label, "start");
  put_frame(svg, area);
  svg.markup(under.written());
  const double half = std::min(0.5 * WIDEST_BOX, 0.28 * slot_width(area));
  for (std::size_t k = 0; k < chart.groups.size(); ++k) {
    const BoxChart::Group& group = chart.groups[k];
    const double middle = area.x(static_cast<double>(k) + 0.5);
    if (group.box.count > 0) put_box(svg, area, group.box, middle, half);
    if (has_mark(group)) put_mark(svg, area, *group.mark, middle + half + DIAMOND + 3.5);
    if (group.box.outliers_beside > 0) put_text(svg, middle, area.top - 3, fmt::format("+{}", group.box.outliers_beside), "mid");
  }
  svg.close();
}

}  // namespace wholehand

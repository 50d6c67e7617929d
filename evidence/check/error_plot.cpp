// SPDX-License-Identifier: MIT
#include "evidence/check/error_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/charts/colors.h"
#include "base/charts/picture.h"
#include "base/charts/plot.h"

namespace wholehand {
namespace {

constexpr double FRONT_LEFT = 46, FRONT_RIGHT = 440, FRONT_HEIGHT = 330, FRONT_SCALE = 1.35;  // units of the plot; pixels a unit
constexpr double NAMES_LEFT = FRONT_RIGHT + 22, NAMES_STEP = 14;                              // of what is beside it
constexpr double LEAST_ERROR_SHOWN = 1e-9;  // of the axis' unit: where an error of 0 stands

// Colors that color-blind readers distinguish, and a mark of its own for each.
struct FrontGroup {
  const char* name;
  bool on_core;
  Precision precision;
  Rgb color;
  MarkShape mark;
};
constexpr FrontGroup FRONT_GROUPS[] = {{"core double", true, Precision::full, okabe_ito::BLUE, MarkShape::disc},
                                       {"core float", true, Precision::single, okabe_ito::SKY_BLUE, MarkShape::square},
                                       {"Vulkan double", false, Precision::full, okabe_ito::ORANGE, MarkShape::triangle},
                                       {"Vulkan float", false, Precision::single, okabe_ito::VERMILION, MarkShape::diamond}};

bool is_of_group(const ErrorRow& row, const FrontGroup& group) {
  return row.variant.on_core == group.on_core && row.variant.precision == group.precision;
}

std::array<double, 2> front_place(const FrontPicture& picture, const ErrorRow& row) {
  return {std::max((row.*picture.error)() * picture.error_unit, LEAST_ERROR_SHOWN), row.seconds_per_grip * 1e6};
}

bool has_front_place(const FrontPicture& picture, const ErrorRow& row) {
  return std::isfinite((row.*picture.error)()) && row.seconds_per_grip > 0;
}

// About the values of a coordinate, from a 1, 2 or 5 to another.
PlotAxis front_axis(const std::string& label, const std::vector<std::array<double, 2>>& places, std::size_t coordinate) {
  PlotAxis axis;
  axis.label = label;
  axis.is_logarithmic = axis.has_grid = true;
  double least = INFINITY, most = 0;
  for (const auto& place : places) {
    least = std::min(least, place[coordinate]);
    most = std::max(most, place[coordinate]);
  }
  const TickRange range = round_logarithmic_range(least, most);
  axis.low = range.low;
  axis.high = range.high;
  return axis;
}

// Two layers of a group: what is beaten, small, and what is not, large. None where it has no row.
void add_group(Plot& plot, const FrontPicture& picture, const std::vector<ErrorRow>& rows,
               const std::vector<const ErrorRow*>& front, const FrontGroup& group) {
  PlotLayer beaten, best;
  beaten.color = best.color = color_text(group.color);
  beaten.mark = best.mark = group.mark;
  beaten.mark_size = 2.4;
  best.mark_size = 4.6;
  best.label = group.name;
  for (const ErrorRow& row : rows) {
    if (!is_of_group(row, group) || !has_front_place(picture, row)) continue;
    const bool is_best = std::find(front.begin(), front.end(), &row) != front.end();
    (is_best ? best : beaten).points.push_back(front_place(picture, row));
  }
  if (beaten.points.empty() && best.points.empty()) return;
  plot.layers.push_back(beaten);
  plot.layers.push_back(best);
}

Plot front_plot(const FrontPicture& picture, const std::vector<ErrorRow>& rows, const std::vector<const ErrorRow*>& front) {
  Plot plot;
  std::vector<std::array<double, 2>> places;
  for (const ErrorRow& row : rows)
    if (has_front_place(picture, row)) places.push_back(front_place(picture, row));
  plot.x = front_axis(picture.error_axis, places, 0);
  plot.y = front_axis("time of a grip (\u00b5s)", places, 1);
  PlotLayer line;
  line.label = "not beaten: named below";
  line.color = "#a0a0a0";
  line.line = 1.2;
  for (const ErrorRow* row : front) line.points.push_back(front_place(picture, *row));
  plot.layers.push_back(line);
  for (const FrontGroup& group : FRONT_GROUPS) add_group(plot, picture, rows, front, group);
  for (std::size_t k = 0; k < front.size(); ++k) {
    const auto [x, y] = front_place(picture, *front[k]);
    plot.notes.push_back({x, y, std::to_string(k + 1)});
  }
  return plot;
}

// The picture: the plot, and beside it, where they cannot cover each other, the legend and the names.
std::string front_picture(const FrontPicture& picture, const std::vector<ErrorRow>& rows) {
  const std::vector<const ErrorRow*> front = pareto_front(rows, picture.error);
  const Plot plot = front_plot(picture, rows, front);
  const double under_legend = 26 + LEGEND_STEP * (static_cast<double>(std::size(FRONT_GROUPS)) + 3);
  double wide = text_width(plot.layers.front().label) + 25;
  std::string named;
  for (std::size_t k = 0; k < front.size(); ++k) {
    wide = std::max(wide, 22 + text_width(front[k]->variant.name));
    named += fmt::format("{} {}: {}", k == 0 ? "" : ";", k + 1, front[k]->variant.name);
  }
  const double names_end = under_legend + NAMES_STEP * static_cast<double>(front.size());
  MarkupWriter svg;
  const std::string description =
      fmt::format("Time of a grip against the {}, of all variants. No other variant is both faster and more exact than these:{}.",
                  picture.error_axis, named);
  const double top = open_picture(svg, {picture.title, description, NAMES_LEFT + wide + 6,
                                        std::max(26 + FRONT_HEIGHT + 3.6 * CHART_LETTER, names_end), FRONT_SCALE});
  put_plot(svg, plot, {FRONT_LEFT, top + 26, FRONT_RIGHT, top + 26 + FRONT_HEIGHT});
  put_legend(svg, plot.layers, NAMES_LEFT, top + 26 + CHART_LETTER, NAMES_LEFT);
  double y = top + under_legend;
  for (std::size_t k = 0; k < front.size(); ++k, y += NAMES_STEP) {
    put_text(svg, NAMES_LEFT + 14, y, std::to_string(k + 1), "end");
    put_text(svg, NAMES_LEFT + 22, y, front[k]->variant.name, "start");
  }
  return svg.close().written();
}

}  // namespace

std::vector<FrontPicture> front_pictures(const std::string& folder, const std::vector<ErrorRow>& rows,
                                         const ErrorContext& context) {
  const std::string at = (folder.empty() || folder.back() == '/') ? folder : folder + "/";
  const std::string scene = fmt::format("{} on {}", context.scene, context.device);
  std::vector<FrontPicture> pictures;
  const auto has = [&](double (ErrorRow::*error)() const) { return !pareto_front(rows, error).empty(); };
  if (has(&ErrorRow::length_error))
    pictures.push_back({at + "error-time.svg", "Error of lengths against run time: " + scene,
                        "largest 99.9th percentile of a length's error (\u00b5m)", 1, &ErrorRow::length_error});
  if (has(&ErrorRow::force_error))
    pictures.push_back({at + "error-time-force.svg", "Error of forces against run time: " + scene,
                        "largest 99.9th percentile of a force's error (N)", 1, &ErrorRow::force_error});
  return pictures;
}

std::vector<PictureFile> front_files(const std::vector<FrontPicture>& pictures, const std::vector<ErrorRow>& rows) {
  std::vector<PictureFile> files;
  for (const FrontPicture& picture : pictures)
    if (std::any_of(rows.begin(), rows.end(), [&](const ErrorRow& row) { return has_front_place(picture, row); }))
      files.push_back({picture.file, front_picture(picture, rows)});
  return files;
}

}  // namespace wholehand

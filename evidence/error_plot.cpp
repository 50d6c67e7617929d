// SPDX-License-Identifier: MIT
#include "evidence/error_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "system/gnuplot.h"

namespace wholehand {
namespace {

constexpr int FRONT_WIDTH = 980, FRONT_HEIGHT = 560;
constexpr double LEAST_ERROR_SHOWN = 1e-9;  // of the axis' unit: where an error of 0 stands

// Okabe and Ito's colours, which colour-blind readers tell apart, and a mark of its own for each.
struct FrontGroup {
  const char* name;
  bool on_core;
  Precision precision;
  const char* color;
  int mark;
};
constexpr FrontGroup FRONT_GROUPS[] = {{"core double", true, Precision::full, "#0072b2", 7},
                                       {"core float", true, Precision::single, "#56b4e9", 5},
                                       {"Vulkan double", false, Precision::full, "#e69f00", 9},
                                       {"Vulkan float", false, Precision::single, "#d55e00", 13}};

bool is_of_group(const ErrorRow& row, const FrontGroup& group) {
  return row.variant.on_core == group.on_core && row.variant.precision == group.precision;
}

// An axis about the values, from a 1, 2 or 5 to another, with a tic at each of these, or at the decades where there are many.
struct FrontAxis {
  double low = 0, high = 0;
  std::string tics;
};

FrontAxis front_axis(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  FrontAxis axis;
  std::vector<double> places;
  for (int decade = static_cast<int>(std::floor(std::log10(*least))) - 1; std::pow(10, decade) <= 10 * *most; ++decade)
    for (const double step : {1.0, 2.0, 5.0}) places.push_back(step * std::pow(10, decade));
  for (const double place : places) {
    if (place <= *least / 1.1) axis.low = place;
    if (place >= *most * 1.1 && axis.high == 0) axis.high = place;
  }
  const bool decades_only = axis.high / axis.low > 1000;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k] < 0.999 * axis.low || places[k] > 1.001 * axis.high || (decades_only && k % 3 != 0)) continue;
    axis.tics += fmt::format("{}'{:g}' {:g}", axis.tics.empty() ? "" : ", ", places[k], places[k]);
  }
  return axis;
}

void add_front_points(std::string& script, const std::vector<std::pair<double, double>>& points) {
  for (const auto& [x, y] : points) fmt::format_to(std::back_inserter(script), "{:.6g} {:.6g}\n", x, y);
  script += points.empty() ? "NaN NaN\ne\n" : "e\n";
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
                        "largest 99.9th percentile of a length's error / \u00b5m", 1, &ErrorRow::length_error});
  if (has(&ErrorRow::force_error))
    pictures.push_back({at + "error-time-force.svg", "Error of forces against run time: " + scene,
                        "largest 99.9th percentile of a force's error / N", 1, &ErrorRow::force_error});
  return pictures;
}

std::string front_script(const std::vector<FrontPicture>& pictures, const std::vector<ErrorRow>& rows) {
  std::string script = gnuplot_style(FRONT_WIDTH, FRONT_HEIGHT);
  auto out = std::back_inserter(script);
  script +=
      "set logscale xy\nset grid linetype 1 linecolor '#dcdcdc'\nset ylabel 'time of a grip / \u00b5s' textcolor '#202020'\n"
      "set lmargin 9\nset rmargin at screen 0.62\nset bmargin 4\n"
      "set key at screen 0.645, screen 0.92 left top Left reverse samplen 1 textcolor '#202020'\n";
  for (const FrontPicture& picture : pictures) {
    const auto x_of = [&](const ErrorRow& row) { return std::max((row.*picture.error)() * picture.error_unit, LEAST_ERROR_SHOWN); };
    const auto y_of = [](const ErrorRow& row) { return row.seconds_per_grip * 1e6; };
    const auto has_place = [&](const ErrorRow& row) { return std::isfinite((row.*picture.error)()) && row.seconds_per_grip > 0; };
    const auto front = pareto_front(rows, picture.error);
    std::vector<double> xs, ys;
    for (const ErrorRow& row : rows) {
      if (!has_place(row)) continue;
      xs.push_back(x_of(row));
      ys.push_back(y_of(row));
    }
    if (xs.empty()) continue;
    const FrontAxis x_axis = front_axis(xs), y_axis = front_axis(ys);
    fmt::format_to(out, "unset label\n{}set title {} textcolor '#202020'\nset xlabel {} textcolor '#202020'\n",
                   gnuplot_output(picture.file), gnuplot_quoted(picture.title), gnuplot_quoted(picture.error_axis));
    fmt::format_to(out, "set xrange [{:g}:{:g}]\nset yrange [{:g}:{:g}]\nset xtics ({})\nset ytics ({})\n", x_axis.low, x_axis.high,
                   y_axis.low, y_axis.high, x_axis.tics, y_axis.tics);
    // the names stand beside the plot, where they cannot cover each other
    const double apart = std::min(0.034, 0.6 / static_cast<double>(std::max<std::size_t>(front.size(), 1)));
    for (std::size_t k = 0; k < front.size(); ++k) {
      fmt::format_to(out, "set label {} '{}' at {:.6g},{:.6g} offset 0.8,0.7 font ',11' textcolor '#202020' front\n", 2 * k + 1,
                     k + 1, x_of(*front[k]), y_of(*front[k]));
      fmt::format_to(out, "set label {} {} at screen 0.65, screen {:.4f} left font ',11' textcolor '#202020'\n", 2 * k + 2,
                     gnuplot_quoted(fmt::format("{:>2}  {}", k + 1, front[k]->variant.name)),
                     0.66 - apart * static_cast<double>(k));
    }
    std::string plots = "plot '-' using 1:2 with lines linewidth 1.5 linecolor '#a0a0a0' title 'not beaten: named below'";
    std::string data;
    std::vector<std::pair<double, double>> points;
    for (const ErrorRow* row : front) points.push_back({x_of(*row), y_of(*row)});
    add_front_points(data, points);
    for (const FrontGroup& group : FRONT_GROUPS) {
      std::vector<std::pair<double, double>> all, best;
      for (const ErrorRow& row : rows) {
        if (!is_of_group(row, group) || !has_place(row)) continue;
        const bool is_best = std::find(front.begin(), front.end(), &row) != front.end();
        (is_best ? best : all).push_back({x_of(row), y_of(row)});
      }
      if (all.empty() && best.empty()) continue;
      for (const bool large : {false, true}) {
        fmt::format_to(std::back_inserter(plots), ", '-' using 1:2 with points pointtype {} pointsize {} linecolor '{}' {}",
                       group.mark, large ? 1.4 : 0.65, group.color, large ? fmt::format("title '{}'", group.name) : "notitle");
        add_front_points(data, large ? best : all);
      }
    }
    script += plots + "\n" + data + "set output\n";
  }
  return script;
}

std::string draw_fronts(const std::vector<FrontPicture>& pictures, const std::vector<ErrorRow>& rows) {
  std::vector<std::string> files;
  for (const FrontPicture& picture : pictures) files.push_back(picture.file);
  return draw_with_gnuplot(front_script(pictures, rows), files);
}

}  // namespace wholehand

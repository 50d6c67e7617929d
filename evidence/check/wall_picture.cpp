// SPDX-License-Identifier: MIT
#include "evidence/check/wall_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/colors.h"
#include "base/charts/picture.h"
#include "base/charts/plot.h"

namespace wholehand {
namespace {

constexpr const char *LIMIT_COLOR = "#1f4e79", *RULE_COLOR = "#b03a00";

const device::WallSheet& sheet_of(const std::vector<device::WallSheet>& sheets, const std::string& name) {
  return *std::find_if(sheets.begin(), sheets.end(), [&](const device::WallSheet& sheet) { return sheet.name == name; });
}

// One panel: what settles and what does not as areas, the limits as lines.
struct Panel {
  std::string title, axis;
  bool is_logarithmic = true;
  std::vector<const device::WallColumn*> columns;
  std::vector<double> at;  // of each column, on the panel's axis, ascending
};

// The columns of a sheet that are in it.
template <class IsIn, class At>
Panel panel_of(const device::WallSheet& sheet, const std::string& title, const std::string& axis, bool is_logarithmic,
               const IsIn& is_in, const At& at) {
  Panel panel{title, axis, is_logarithmic, {}, {}};
  for (const device::WallColumn& column : sheet.columns) {
    const device::WallDevice& device = column.points.front().device;
    if (!is_in(device)) continue;
    panel.columns.push_back(&column);
    panel.at.push_back(at(column.points.front()));
  }
  return panel;
}

// Half way between neighbors, on the axis as it is drawn; as far beyond the ends.
std::vector<double> edges_of(std::vector<double> at, bool is_logarithmic) {
  const auto drawn = [is_logarithmic](double x) { return is_logarithmic ? std::log(x) : x; };
  for (double& x : at) x = drawn(x);
  const std::size_t n = at.size();
  std::vector<double> edges{n > 1 ? at[0] - 0.5 * (at[1] - at[0]) : at[0] - 0.5};
  for (std::size_t k = 0; k + 1 < n; ++k) edges.push_back(0.5 * (at[k] + at[k + 1]));
  edges.push_back(n > 1 ? at[n - 1] + 0.5 * (at[n - 1] - at[n - 2]) : at[0] + 0.5);
  if (is_logarithmic)
    for (double& x : edges) x = std::exp(x);
  return edges;
}

// Boxes of the points of one column that settle, or that do not: a run of neighbors is one box.
void add_runs(std::vector<PlotBox>& boxes, const device::WallColumn& column, bool settled, double left, double right) {
  std::vector<double> stiffness;
  for (const device::WallPoint& point : column.points) stiffness.push_back(point.stiffness);
  const std::vector<double> edges = edges_of(stiffness, true);
  for (std::size_t k = 0; k < column.points.size();) {
    std::size_t end = k;
    while (end < column.points.size() && column.points[end].settles() == column.points[k].settles()) ++end;
    if (column.points[k].settles() == settled) boxes.push_back({left, edges[k], right, edges[end]});
    k = end;
  }
}

enum class Rule { none, passive, friction };

PlotLayer rule_layer(Rule rule) {
  PlotLayer layer;
  layer.label = rule == Rule::none ? "linear limit" : rule == Rule::passive ? "b = KT/2 + |B|" : "min(2b/T, 2f_c/D)";
  layer.color = rule == Rule::none ? LIMIT_COLOR : rule == Rule::passive ? RULE_COLOR : color_text(okabe_ito::BLACK);
  layer.dashes = rule == Rule::none ? "" : rule == Rule::passive ? "5 3" : "2 3";
  layer.line = 1.7;
  return layer;
}

PlotLayer area_layer(bool settled) {
  PlotLayer layer;
  layer.label = settled ? "settles" : "does not";
  layer.color = settled ? tint(okabe_ito::BLUE, 0.28) : tint(okabe_ito::ORANGE, 0.4);
  layer.is_area = true;
  return layer;
}

// Sets the axis to whole decades about the boxes.
void set_decades(PlotAxis& axis, const std::vector<PlotLayer>& layers) {
  double least = INFINITY, most = 0;
  for (const PlotLayer& layer : layers) {
    for (const PlotBox& box : layer.boxes) {
      least = std::min(least, box.bottom);
      most = std::max(most, box.top);
    }
  }
  if (!(least > 0 && most >= least)) least = most = 1;
  axis.low = std::pow(10, std::floor(std::log10(least) + 1e-6));
  axis.high = std::pow(10, std::ceil(std::log10(most) - 1e-6));
  if (axis.high <= axis.low) axis.high = 10 * axis.low;
}

Plot panel_plot(const Panel& panel, Rule rule) {
  const std::vector<double> edges = edges_of(panel.at, panel.is_logarithmic);
  Plot plot;
  plot.title = panel.title;
  plot.x = {panel.axis, edges.front(), edges.back(), panel.is_logarithmic};
  plot.y.label = "stiffness K (N/m)";
  plot.y.is_logarithmic = true;
  for (const bool settled : {true, false}) {
    PlotLayer& layer = plot.layers.emplace_back(area_layer(settled));
    for (std::size_t c = 0; c < panel.columns.size(); ++c)
      add_runs(layer.boxes, *panel.columns[c], settled, edges[c], edges[c + 1]);
  }
  set_decades(plot.y, plot.layers);
  for (const Rule drawn : {Rule::none, rule}) {
    if (drawn == Rule::none && plot.layers.size() > 2) continue;
    PlotLayer& layer = plot.layers.emplace_back(rule_layer(drawn));
    for (std::size_t c = 0; c < panel.columns.size(); ++c) {
      const device::WallLimits& theory = panel.columns[c]->theory;
      const double limit = drawn == Rule::none ? theory.linear : drawn == Rule::friction ? theory.coulomb : theory.passive;
      if (limit > 0 && std::isfinite(limit)) layer.points.push_back({panel.at[c], limit});
    }
  }
  return plot;
}

// Devices of the first kind that is named.
bool is_named(const device::WallDevice& d) {
  const device::NamedDevice& named = device::wall_devices().front();
  return d.mass == named.mass && d.damping == named.damping;
}

bool is_kilohertz(const device::WallDevice& d) { return std::abs(d.rate - 1000) < 0.5; }

// Rates, damping, delay and encoder.
std::vector<Plot> limit_plots(const std::vector<device::WallSheet>& sheets) {
  const device::WallSheet& map = sheet_of(sheets, "stiffness_damping_rate");
  std::vector<Plot> plots;
  plots.push_back(panel_plot(panel_of(
                                 map, "no wall damping", "rate (Hz)", true,
                                 [](const device::WallDevice& d) { return is_named(d) && std::abs(d.wall_damping) < 1e-9; },
                                 [](const device::WallPoint& p) { return p.device.rate; }),
                             Rule::passive));
  plots.back().x.ticks = {250, 500, 1000, 2000, 4000, 8000};
  plots.push_back(panel_plot(
      panel_of(
          map, "1 kHz", "wall damping B (N s/m)", false, [](const device::WallDevice& d) { return is_named(d) && is_kilohertz(d); },
          [](const device::WallPoint& p) { return p.device.wall_damping; }),
      Rule::passive));
  plots.push_back(panel_plot(panel_of(
                                 sheet_of(sheets, "delay"), "1 kHz, no wall damping", "delay (samples)", false,
                                 [](const device::WallDevice& d) { return is_named(d) && is_kilohertz(d); },
                                 [](const device::WallPoint& p) { return p.device.delay; }),
                             Rule::none));
  plots.push_back(panel_plot(panel_of(
                                 sheet_of(sheets, "encoder"), "1 kHz, friction f_c = 0.2 N", "encoder step D (\u00b5m)", true,
                                 [](const device::WallDevice& d) { return is_named(d) && d.coulomb == 0.2; },
                                 [](const device::WallPoint& p) { return p.device.encoder_step * 1e6; }),
                             Rule::friction));
  return plots;
}

// The largest stiffness over the sub-steps of one integrator; the exact one has no sub-steps, and is a level line.
PlotLayer integrator_layer(const device::WallSheet& sheet, int integrator) {
  PlotLayer layer;
  layer.label = integrator == LOOP_EULER ? "explicit Euler" : integrator == LOOP_SEMI_IMPLICIT ? "semi-implicit Euler" : "exact";
  layer.color = integrator == LOOP_EULER ? RULE_COLOR : integrator == LOOP_SEMI_IMPLICIT ? LIMIT_COLOR : "#404040";
  layer.line = 1.7;
  layer.mark_size = 3.4;
  if (integrator == LOOP_EXACT) {
    layer.dashes = "5 3";
  } else {
    layer.mark = integrator == LOOP_EULER ? MarkShape::disc : MarkShape::square;
  }
  for (const device::WallColumn& column : sheet.columns) {
    const device::WallPoint& first = column.points.front();
    if (first.integrator != integrator || !is_named(first.device)) continue;
    const double limit = device::integrator_limit(first.device, integrator, first.substeps);
    if (integrator == LOOP_EXACT) {
      layer.points = {{1, limit}, {16, limit}};
    } else {
      layer.points.push_back({static_cast<double>(first.substeps), limit});
    }
  }
  return layer;
}

}  // namespace

std::string wall_picture(const std::vector<device::WallSheet>& sheets) {
  constexpr double LEFT = 46, WIDTH = 300, COLUMN = 370, HEIGHT = 190, ROW = 268, ABOVE = 62;  // units
  const std::vector<Plot> plots = limit_plots(sheets);
  const double width = LEFT + COLUMN + WIDTH + 8;
  const std::string description = fmt::format(
      "Four maps of the stiffness of a wall, over {}, {}, {} and {}: where it settles in simulation and where it does not, "
      "with the limits of theory as lines.",
      plots[0].x.label, plots[1].x.label, plots[2].x.label, plots[3].x.label);
  MarkupWriter svg;
  const double top = open_picture(svg, {std::string("A rendered wall on a device of ") + device::wall_devices().front().name,
                                        description, width, ABOVE + 2 * ROW - 34, 1.35});
  std::vector<PlotLayer> legend{area_layer(true), area_layer(false)};
  for (const Rule rule : {Rule::none, Rule::passive, Rule::friction}) legend.push_back(rule_layer(rule));
  put_legend(svg, legend, 2, top + CHART_LETTER, width);
  for (std::size_t k = 0; k < plots.size(); ++k) {
    const double left = LEFT + (k % 2 == 1 ? COLUMN : 0), y = top + ABOVE + (k / 2 == 1 ? ROW : 0);
    put_plot(svg, plots[k], {left, y, left + WIDTH, y + HEIGHT});
  }
  return svg.close().written();
}

std::string integrator_picture(const std::vector<device::WallSheet>& sheets) {
  constexpr double LEFT = 46, RIGHT = 472, HEIGHT = 250, UNDER_LEGEND = 30;  // units
  Plot plot;
  plot.x = {"sub-steps of a sample", 0.8, 20, true};
  plot.x.ticks = {1, 2, 4, 8, 16};
  plot.y = {"settles up to K (N/m)", 500, 1000, true};
  plot.y.has_grid = true;
  double most = 1000;
  for (const int integrator : {LOOP_EULER, LOOP_SEMI_IMPLICIT, LOOP_EXACT}) {
    plot.layers.push_back(integrator_layer(sheet_of(sheets, "integrator"), integrator));
    for (const auto& point : plot.layers.back().points)
      if (std::isfinite(point[1])) most = std::max(most, point[1]);
  }
  plot.y.high = round_logarithmic_range(most, most).high;
  const double above = legend_height(plot.layers, 2, RIGHT) + UNDER_LEGEND;
  MarkupWriter svg;
  const double top =
      open_picture(svg, {fmt::format("What an integrator makes of the limit: {}, 1 kHz", device::wall_devices().front().name),
                         "Largest stiffness of a wall that settles, over the sub-steps that an integrator takes in a "
                         "sample: explicit Euler, semi-implicit Euler, and the exact solution as a level line.",
                         RIGHT + 8, above + HEIGHT + 3.6 * CHART_LETTER, 1.5});
  put_legend(svg, plot.layers, 2, top + CHART_LETTER, RIGHT);
  put_plot(svg, plot, {LEFT, top + above, RIGHT, top + above + HEIGHT});
  return svg.close().written();
}

}  // namespace wholehand

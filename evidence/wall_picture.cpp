// SPDX-License-Identifier: MIT
#include "evidence/wall_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "system/gnuplot.h"

namespace wholehand {
namespace {

const WallSheet& sheet_of(const std::vector<WallSheet>& sheets, const std::string& name) {
  return *std::find_if(sheets.begin(), sheets.end(), [&](const WallSheet& sheet) { return sheet.name == name; });
}

// One panel: what settles and what does not as areas, the limits as lines.
struct Panel {
  std::string title, axis;
  bool is_logarithmic = true;
  std::vector<const WallColumn*> columns;
  std::vector<double> at;  // of each column, on the panel's axis, ascending
};

// The columns of a sheet that are in it.
template <class IsIn, class At>
Panel panel_of(const WallSheet& sheet, const std::string& title, const std::string& axis, bool is_logarithmic, const IsIn& is_in,
               const At& at) {
  Panel panel{title, axis, is_logarithmic, {}, {}};
  for (const WallColumn& column : sheet.columns) {
    const WallDevice& device = column.points.front().device;
    if (!is_in(device)) continue;
    panel.columns.push_back(&column);
    panel.at.push_back(at(column.points.front()));
  }
  return panel;
}

// Half way between neighbours, on the axis as it is drawn; as far beyond the ends.
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

// Boxes of the points of one column that settle, or that do not: a run of neighbours is one box.
void draw_runs(std::back_insert_iterator<std::string> out, const WallColumn& column, bool settled, double left, double right) {
  std::vector<double> stiffness;
  for (const WallPoint& point : column.points) stiffness.push_back(point.stiffness);
  const std::vector<double> edges = edges_of(stiffness, true);
  for (std::size_t k = 0; k < column.points.size();) {
    std::size_t end = k;
    while (end < column.points.size() && column.points[end].settles() == column.points[k].settles()) ++end;
    if (column.points[k].settles() == settled) {
      fmt::format_to(out, "{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n", left, edges[k], left, right, edges[k], edges[end]);
    }
    k = end;
  }
}

enum class Rule { passive, friction, none };

void draw_panel(std::back_insert_iterator<std::string> out, const Panel& panel, Rule rule) {
  const std::vector<double> edges = edges_of(panel.at, panel.is_logarithmic);
  fmt::format_to(out, "set title {} textcolor '#202020'\nset xlabel {} textcolor '#202020'\n{}\nset xrange [{:.6g}:{:.6g}]\n",
                 gnuplot_quoted(panel.title), gnuplot_quoted(panel.axis),
                 panel.is_logarithmic ? "set logscale x" : "unset logscale x", edges.front(), edges.back());
  fmt::format_to(out,
                 "plot '-' using 1:2:3:4:5:6 with boxxyerror fillcolor '#b9d7ea' title 'settles', "
                 "'-' using 1:2:3:4:5:6 with boxxyerror fillcolor '#f6d2a9' title 'does not', "
                 "'-' with lines linewidth 2 linecolor '#1f4e79' title 'linear limit'{}\n",
                 rule == Rule::none ? ""
                                    : fmt::format(", '-' with lines linewidth 2 dashtype 2 linecolor '#b03a00' title '{}'",
                                                  rule == Rule::friction ? "min(2b/T, 2f_c/D)" : "b = KT/2 + |B|"));
  for (const bool settled : {true, false}) {
    for (std::size_t c = 0; c < panel.columns.size(); ++c) draw_runs(out, *panel.columns[c], settled, edges[c], edges[c + 1]);
    fmt::format_to(out, "NaN NaN NaN NaN NaN NaN\ne\n");
  }
  for (const bool linear : {true, false}) {
    if (!linear && rule == Rule::none) continue;
    for (std::size_t c = 0; c < panel.columns.size(); ++c) {
      const WallLimits& theory = panel.columns[c]->theory;
      const double limit = linear ? theory.linear : rule == Rule::friction ? theory.coulomb : theory.passive;
      if (limit > 0 && std::isfinite(limit)) fmt::format_to(out, "{:.6g} {:.6g}\n", panel.at[c], limit);
    }
    fmt::format_to(out, "NaN NaN\ne\n");
  }
}

// Devices of the first kind that is named.
bool is_named(const WallDevice& d) {
  const NamedDevice& named = wall_devices().front();
  return d.mass == named.mass && d.damping == named.damping;
}

bool is_kilohertz(const WallDevice& d) { return std::abs(d.rate - 1000) < 0.5; }

void draw_integrators(std::back_insert_iterator<std::string> out, const WallSheet& sheet) {
  fmt::format_to(
      out,
      "set title 'What an integrator makes of the limit: {}, 1 kHz' textcolor '#202020'\n"
      "set xlabel 'sub-steps a sample' textcolor '#202020'\nset ylabel 'settles up to K / (N/m)' textcolor '#202020'\n"
      "set logscale x 2\nset logscale y 10\nset key top right nobox vertical inside\nset xrange [0.8:20]\nset yrange [500:*]\n"
      "plot '-' with linespoints pointtype 7 linewidth 2 linecolor '#b03a00' title 'explicit Euler', "
      "'-' with linespoints pointtype 5 linewidth 2 linecolor '#1f4e79' title 'semi-implicit Euler', "
      "'-' with lines linewidth 2 dashtype 2 linecolor '#404040' title 'exact'\n",
      wall_devices().front().name);
  for (const int integrator : {LOOP_EULER, LOOP_SEMI_IMPLICIT, LOOP_EXACT}) {
    for (const WallColumn& column : sheet.columns) {
      const WallPoint& first = column.points.front();
      if (first.integrator != integrator || !is_named(first.device)) continue;
      const double limit = integrator_limit(first.device, integrator, first.substeps);
      if (integrator == LOOP_EXACT) {
        fmt::format_to(out, "1 {:.6g}\n16 {:.6g}\n", limit, limit);
      } else {
        fmt::format_to(out, "{} {:.6g}\n", first.substeps, limit);
      }
    }
    fmt::format_to(out, "e\n");
  }
  fmt::format_to(out, "set output\nreset\n");
}

void draw_limits(std::back_insert_iterator<std::string> out, const std::vector<WallSheet>& sheets) {
  const WallSheet& map = sheet_of(sheets, "stiffness_damping_rate");
  fmt::format_to(out,
                 "set multiplot layout 2,2 title 'A rendered wall on a device of {}' textcolor '#202020'\n"
                 "set logscale y\nset ylabel 'stiffness K / (N/m)' textcolor '#202020'\nset format y '10^{{%L}}'\n"
                 "set termoption enhanced\nset key above horizontal samplen 1.2\nset style fill solid 1.0 noborder\n"
                 "set tics front\n",
                 wall_devices().front().name);
  fmt::format_to(out, "set xtics (250, 500, 1000, 2000, 4000, 8000)\n");
  draw_panel(out,
             panel_of(
                 map, "no wall damping", "rate / Hz", true,
                 [](const WallDevice& d) { return is_named(d) && std::abs(d.wall_damping) < 1e-9; },
                 [](const WallPoint& p) { return p.device.rate; }),
             Rule::passive);
  fmt::format_to(out, "set xtics autofreq\n");
  draw_panel(
      out,
      panel_of(
          map, "1 kHz", "wall damping B / (N s/m)", false, [](const WallDevice& d) { return is_named(d) && is_kilohertz(d); },
          [](const WallPoint& p) { return p.device.wall_damping; }),
      Rule::passive);
  draw_panel(
      out,
      panel_of(
          sheet_of(sheets, "delay"), "1 kHz, no wall damping", "delay / samples", false,
          [](const WallDevice& d) { return is_named(d) && is_kilohertz(d); }, [](const WallPoint& p) { return p.device.delay; }),
      Rule::none);
  draw_panel(out,
             panel_of(
                 sheet_of(sheets, "encoder"), "1 kHz, friction f_c = 0.2 N", "encoder step D / um", true,
                 [](const WallDevice& d) { return is_named(d) && d.coulomb == 0.2; },
                 [](const WallPoint& p) { return p.device.encoder_step * 1e6; }),
             Rule::friction);
  fmt::format_to(out, "unset multiplot\nset output\nreset\n");
}

}  // namespace

std::string wall_script(const std::vector<WallSheet>& sheets, const std::string& folder, std::vector<std::string>& files) {
  // wall.svg last: gnuplot writes the last subscript that it set into the titles of later pictures
  std::string script;
  files.push_back(folder + "/wall_integrators.svg");
  script += gnuplot_style(640, 440) + gnuplot_output(files.back());
  draw_integrators(std::back_inserter(script), sheet_of(sheets, "integrator"));
  files.push_back(folder + "/wall.svg");
  script += gnuplot_style(960, 760) + gnuplot_output(files.back());
  draw_limits(std::back_inserter(script), sheets);
  return script;
}

}  // namespace wholehand

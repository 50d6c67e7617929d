// SPDX-License-Identifier: MIT
#include "sweeps/heat_map_plot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "system/gnuplot.h"

namespace wholehand {
namespace {

// Viridis, sampled: equal steps look equal, in grey print and to colour-blind readers too.
constexpr const char* PALETTE =
    "set palette defined (0 '#440154', 1 '#482878', 2 '#3e4a89', 3 '#31688e', 4 '#26828e', 5 '#1f9e89', 6 '#35b779', "
    "7 '#6ece58', 8 '#b5de2b', 9 '#fde725')\n";
constexpr const char* INFEASIBLE_COLOR = "#d4d4d4";
constexpr const char* IMPLAUSIBLE_COLOR = "#8c8c8c";

struct Range {
  double low = 0, high = 1;
};

// A cell whose best grip is implausible has score 0: not a low score but none.
bool has_score(double score) { return score > 0; }

// Of all pictures, widened to whole twentieths.
Range score_range(const std::vector<HeatMapPicture>& pictures) {
  double low = INFINITY, high = -INFINITY;
  for (const HeatMapPicture& picture : pictures) {
    for (const double score : picture.map->scores()) {
      if (!has_score(score)) continue;
      low = std::min(low, score);
      high = std::max(high, score);
    }
  }
  if (low > high) return {};
  low = std::floor(low * 20) / 20;
  high = std::ceil(high * 20) / 20;
  return {low, high > low ? high : low + 0.05};
}

}  // namespace

std::string file_name_part(const std::string& name) {
  std::string part;
  for (const char c : name) {
    const bool plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_' || (c & 0x80);
    part += plain ? c : '_';
  }
  return part.empty() ? "_" : part;
}

std::vector<std::string> file_name_parts(const Scene& scene) {
  std::vector<std::string> parts;
  for (const VesselData& vessel : scene.vessels) {
    const std::string own = file_name_part(vessel.name);
    std::string part = own;
    for (int k = 2; std::find(parts.begin(), parts.end(), part) != parts.end(); ++k) part = fmt::format("{}_{}", own, k);
    parts.push_back(part);
  }
  return parts;
}

std::vector<HeatMapPicture> sweep_pictures(const Scene& scene, const Plan& plan, const std::vector<HeatMap>& maps,
                                           const OutputNames& names) {
  std::vector<std::string> over;  // the axes that vary beside height and roll
  for (const int place : {PLACE_AZIMUTH, PLACE_OBLIQUITY, PLACE_OFFSET, PLACE_HAND_SCALE}) {
    const PlanAxis& axis = plan.axes()[place];
    if (axis.data.values.size() == 1 && !(plan.is_sobol() && axis.data.is_range)) continue;
    over.push_back(axis.name);
    std::replace(over.back().begin(), over.back().end(), '_', ' ');
  }
  const std::string maximised = over.empty() ? "score" : fmt::format("best score over {}", fmt::join(over, ", "));
  const std::vector<std::string> parts = file_name_parts(scene);
  std::vector<HeatMapPicture> pictures;
  for (std::size_t v = 0; v < maps.size(); ++v) {
    const VesselData& vessel = scene.vessels[v];
    HeatMapPicture picture{names.heat_map(parts[v]), fmt::format("{}: {}", vessel.name, maximised), &maps[v]};
    if (scene.grips.height_is_fraction) {
      picture.height_unit = vessel.height - vessel.base;
      picture.height_zero = vessel.base;
    }
    pictures.push_back(picture);
  }
  return pictures;
}

std::string heat_map_script(const std::vector<HeatMapPicture>& pictures) {
  std::string script;
  auto out = std::back_inserter(script);
  const Range range = score_range(pictures);
  script += gnuplot_style(720, 515);
  fmt::format_to(out,
                 "{}set cbrange [{}:{}]\n"
                 "set xlabel 'roll / deg' textcolor '#202020'\nset ylabel 'height / mm' textcolor '#202020'\n"
                 "set cblabel 'best score' textcolor '#202020'\n"
                 "set style fill solid 1.0 noborder\n"
                 "set key at graph 1, screen 0.025 right bottom horizontal textcolor '#202020'\n"
                 "set lmargin 11\nset rmargin 13\nset bmargin 6\n"
                 "set object 1 rectangle from graph 0,0 to graph 1,1 behind fillcolor '{}' fillstyle solid noborder\n",
                 PALETTE, range.low, range.high, INFEASIBLE_COLOR);
  for (const HeatMapPicture& picture : pictures) {
    const HeatMap& map = *picture.map;
    const MapAxis &heights = map.heights(), &rolls = map.rolls();
    const auto y = [&](std::size_t edge) { return (picture.height_zero + heights.edge(edge) * picture.height_unit) * 1e3; };  // mm
    const auto x = [&](std::size_t edge) { return degrees(rolls.edge(edge)); };
    fmt::format_to(out, "{}set title {} textcolor '#202020'\nset xrange [{}:{}]\nset yrange [{}:{}]\n",
                   gnuplot_output(picture.file), gnuplot_quoted(picture.title), x(0), x(rolls.cells()), y(0), y(heights.cells()));
    fmt::format_to(out,
                   "plot '-' using 1:2:3:4:5:6:7 with boxxyerror fillcolor palette notitle, "
                   "'-' using 1:2:3:4:5:6 with boxxyerror fillcolor '{}' notitle, "
                   "NaN with boxes fillcolor '{}' title 'only implausible grips', "
                   "NaN with boxes fillcolor '{}' title 'no feasible grip'\n",
                   IMPLAUSIBLE_COLOR, IMPLAUSIBLE_COLOR, INFEASIBLE_COLOR);
    for (const bool scored : {true, false}) {
      bool any = false;
      for (std::size_t h = 0; h < heights.cells(); ++h) {
        for (std::size_t r = 0; r < rolls.cells(); ++r) {
          const double score = map.score(h, r);
          if (std::isnan(score) || has_score(score) != scored) continue;
          any = true;
          fmt::format_to(out, "{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.4f}\n", 0.5 * (x(r) + x(r + 1)),
                         0.5 * (y(h) + y(h + 1)), x(r), x(r + 1), y(h), y(h + 1), score);
        }
      }
      fmt::format_to(out, "{}e\n", any ? "" : "NaN NaN NaN NaN NaN NaN NaN\n");  // gnuplot refuses an empty block
    }
    fmt::format_to(out, "set output\n");
  }
  return script;
}

std::string draw_heat_maps(const std::vector<HeatMapPicture>& pictures) {
  if (pictures.empty()) return {};
  std::vector<std::string> files;
  for (const HeatMapPicture& picture : pictures) files.push_back(picture.file);
  return draw_with_gnuplot(heat_map_script(pictures), files);
}

}  // namespace wholehand

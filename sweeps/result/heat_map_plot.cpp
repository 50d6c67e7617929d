// SPDX-License-Identifier: MIT
#include "sweeps/result/heat_map_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/text.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {
namespace {

constexpr double MAP_WIDTH = 480, MAP_HEIGHT = 280, MAP_SCALE = 1.5;  // units of the picture and of its cells; pixels a unit

// A cell whose grips are implausible, or do not hold, has score 0: not a low score but none.
bool has_score(double score) { return score > 0 && std::isfinite(score); }

CellKind kind_of(double score) {
  if (std::isnan(score)) return CellKind::absent;
  return has_score(score) ? CellKind::filled : CellKind::hollow;
}

// One scale of colors for all pictures.
ColorScale common_scale(const std::vector<HeatMapPicture>& pictures) {
  double low = INFINITY, high = -INFINITY;
  for (const HeatMapPicture& picture : pictures) {
    for (const double score : picture.map->scores()) {
      if (!has_score(score)) continue;
      low = std::min(low, score);
      high = std::max(high, score);
    }
  }
  return low <= high ? score_scale(low, high) : ColorScale{"best score", 0, 1, 2, 0};
}

// What the map shows, in sentences for those who do not see it.
std::string spoken(const FieldChart& chart) {
  const auto count = [&chart](CellKind kind) { return std::count(chart.kinds.begin(), chart.kinds.end(), kind); };
  const std::size_t columns = chart.x_edges.size() - 1;
  const std::size_t cells = chart.kinds.size();
  std::string text = fmt::format("Heat map of the best score over roll and height, {} cells.", cells);
  std::size_t best = cells;
  double least = INFINITY;
  for (std::size_t i = 0; i < cells; ++i) {
    if (chart.kinds[i] != CellKind::filled) continue;
    least = std::min(least, chart.values[i]);
    if (best == cells || chart.values[i] > chart.values[best]) best = i;
  }
  if (best < cells) {
    const std::size_t row = best / columns, column = best % columns;
    text +=
        fmt::format(" Scores from {} to {}, the highest at a roll of {}\u00b0 and a height of {} mm.", shown_number(least, 3),
                    shown_number(chart.values[best], 3), shown_number(0.5 * (chart.x_edges[column] + chart.x_edges[column + 1]), 1),
                    shown_number(0.5 * (chart.y_edges[row] + chart.y_edges[row + 1]), 1));
  }
  return text + fmt::format(" Cells with {}: {}. Cells without a feasible grip: {}.", chart.hollow, count(CellKind::hollow),
                            count(CellKind::absent));
}

FieldChart map_chart(const HeatMapPicture& picture, const ColorScale& scale) {
  const HeatMap& map = *picture.map;
  FieldChart chart;
  chart.x_label = "roll (\u00b0)";
  chart.y_label = "height (mm)";
  chart.x_is_angle = true;
  chart.width = MAP_WIDTH;
  chart.plot_height = MAP_HEIGHT;
  for (std::size_t r = 0; r <= map.rolls().cells(); ++r) chart.x_edges.push_back(degrees(map.rolls().edge(r)));
  for (std::size_t h = 0; h <= map.heights().cells(); ++h)
    chart.y_edges.push_back((picture.height_zero + map.heights().edge(h) * picture.height_unit) * 1e3);
  chart.values = map.scores();
  for (const double score : chart.values) chart.kinds.push_back(kind_of(score));
  chart.hollow = picture.hollow;
  chart.absent = "no feasible grip";
  chart.scale = scale;
  chart.name = {"", picture.title, spoken(chart)};
  return chart;
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
    if (axis.kind == AxisKind::number) continue;
    over.push_back(axis.name);
    std::replace(over.back().begin(), over.back().end(), '_', ' ');
  }
  const std::string maximised = over.empty() ? "score" : fmt::format("best score over {}", joined(over, ", "));
  const std::vector<std::string> parts = file_name_parts(scene);
  std::vector<HeatMapPicture> pictures;
  for (std::size_t v = 0; v < maps.size(); ++v) {
    const VesselData& vessel = scene.vessels[v];
    HeatMapPicture picture{names.heat_map(parts[v]), fmt::format("{}: {}", vessel.name, maximised), &maps[v]};
    if (has_effort(scene)) picture.hollow = "no grip that holds";
    if (scene.grips.height_is_fraction) {
      picture.height_unit = vessel.height - vessel.base;
      picture.height_zero = vessel.base;
    }
    pictures.push_back(picture);
  }
  return pictures;
}

ColorScale score_scale(double low, double high) {
  low = std::floor(low * 20) / 20;
  return {"best score", low, std::max(std::ceil(high * 20) / 20, low + 0.05), 2, 0};
}

std::vector<PictureFile> heat_map_files(const std::vector<HeatMapPicture>& pictures) {
  const ColorScale scale = common_scale(pictures);
  std::vector<PictureFile> files;
  for (const HeatMapPicture& picture : pictures)
    files.push_back({picture.file, chart_picture(map_chart(picture, scale), MAP_SCALE)});
  return files;
}

}  // namespace wholehand::sweeps

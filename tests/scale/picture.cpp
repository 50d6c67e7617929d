// SPDX-License-Identifier: MIT
#include "tests/scale/picture.h"

#include <algorithm>
#include <cstddef>

#include "base/charts/colors.h"
#include "base/charts/picture.h"
#include "base/charts/plot.h"

namespace wholehand::scale {

std::string scale_picture(const std::vector<Row>& rows) {
  constexpr double LEFT = 46, RIGHT = 472, HEIGHT = 260, UNDER_LEGEND = 30;  // units
  const Rgb colors[] = {okabe_ito::BLUE, okabe_ito::SKY_BLUE, okabe_ito::VERMILION, okabe_ito::ORANGE};
  const MarkShape marks[] = {MarkShape::disc, MarkShape::square, MarkShape::triangle, MarkShape::diamond};
  Plot plot;
  plot.x = {"ranks", 12, 5000, true};
  plot.x.ticks = {16, 64, 256, 1024, 4096};
  plot.y = {"efficiency, %", 0, 100, false};
  plot.y.has_grid = true;
  plot.y.ticks = {0, 20, 40, 60, 80, 90, 95, 100};
  for (const Row& row : rows) {
    if (row.group != "cpu" && row.group != "gpu") continue;
    const std::string label = row.label + (row.group == "cpu" ? ", 10^10 grips" : ", 10^11 grips");
    auto layer = std::find_if(plot.layers.begin(), plot.layers.end(), [&](const PlotLayer& other) { return other.label == label; });
    if (layer == plot.layers.end()) {
      const std::size_t number = plot.layers.size();
      layer = plot.layers.insert(plot.layers.end(), PlotLayer());
      layer->label = label;
      layer->color = color_text(colors[number % std::size(colors)]);
      layer->mark = marks[number % std::size(marks)];
      layer->line = 1.6;
    }
    layer->points.push_back({static_cast<double>(row.job.machine.ranks), 100 * row.outcome.efficiency});
  }
  std::erase_if(plot.layers, [](const PlotLayer& layer) { return layer.points.size() < 2; });
  const double above = legend_height(plot.layers, 2, RIGHT) + UNDER_LEGEND;
  MarkupWriter svg;
  const double top =
      open_picture(svg, {"Efficiency of simulated ranks",
                         "Grips over the rates of all ranks and the time to the result, over the number of ranks, of the same "
                         "sweep on more and more of them.",
                         RIGHT + 8, above + HEIGHT + 3.6 * CHART_LETTER, 1.5});
  put_legend(svg, plot.layers, 2, top + CHART_LETTER, RIGHT);
  put_plot(svg, plot, {LEFT, top + above, RIGHT, top + above + HEIGHT});
  return svg.close().written();
}

}  // namespace wholehand::scale

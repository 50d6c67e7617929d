// SPDX-License-Identifier: MIT
#include "evidence/check/grip_loop_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/charts/colors.h"
#include "base/charts/picture.h"
#include "base/charts/plot.h"
#include "device/loop/grip_loop.h"

namespace wholehand {
namespace {

// Cells: a reaction each 10 ms, and k_open in even steps of its logarithm.
constexpr int REACTIONS = 61, STIFFNESSES = 48;
constexpr double REACTION_STEP = 0.01, SHORTEST_REACTION = 0.002, K_OPEN_LEAST = 50, K_OPEN_RATIO = 400;

double reaction_at(int column) { return std::max(SHORTEST_REACTION, REACTION_STEP * column); }
double k_open_at(double row) { return K_OPEN_LEAST * std::pow(K_OPEN_RATIO, row / (STIFFNESSES - 1)); }

// By GripOutcome.
std::vector<PlotLayer> outcome_layers() {
  const std::array<std::string, device::GRIP_OUTCOMES> colors{tint(okabe_ito::SKY_BLUE, 0.5), tint(okabe_ito::BLUE, 0.65),
                                                              tint(okabe_ito::ORANGE, 0.85), tint(okabe_ito::BLACK, 0.26),
                                                              "#7a1f1f"};
  std::vector<PlotLayer> layers(device::GRIP_OUTCOMES);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    layers[k].label = device::GRIP_OUTCOME_NAMES[k];
    layers[k].color = colors[k];
    layers[k].is_area = true;
  }
  for (int column = 0; column < REACTIONS; ++column) {
    device::GripLoop loop;
    loop.reaction = reaction_at(column);
    const double left = std::max(0.0, (column - 0.5) * REACTION_STEP), right = (column + 0.5) * REACTION_STEP;
    for (int k = 0; k < STIFFNESSES; ++k) {
      loop.k_open = k_open_at(k);
      std::vector<PlotBox>& boxes = layers[static_cast<std::size_t>(device::hold_and_tilt(loop).outcome)].boxes;
      const double bottom = k_open_at(k - 0.5), top = k_open_at(k + 0.5);
      const bool goes_on = !boxes.empty() && boxes.back().left == left && boxes.back().top == bottom;
      if (goes_on) {
        boxes.back().top = top;
      } else {
        boxes.push_back({left, bottom, right, top});
      }
    }
  }
  std::erase_if(layers, [](const PlotLayer& layer) { return layer.boxes.empty(); });
  return layers;
}

PlotLayer theory_layer(const char* label, const char* color, const char* dashes) {
  PlotLayer layer;
  layer.label = label;
  layer.color = color;
  layer.dashes = dashes;
  layer.line = 1.7;
  return layer;
}

}  // namespace

std::string grip_loop_picture() {
  constexpr double LEFT = 46, RIGHT = 552, HEIGHT = 300, UNDER_LEGEND = 30;  // units
  Plot plot;
  plot.x = {"reaction time of the user (s)", 0, REACTION_STEP * (REACTIONS - 0.5)};
  plot.y = {"k_open (N/m)", 40, 30000, true};
  plot.y.ticks = logarithmic_ticks(plot.y.low, plot.y.high);
  plot.layers = outcome_layers();
  PlotLayer& user = plot.layers.emplace_back(theory_layer("user, by theory", "#1f4e79", ""));
  for (int column = 0; column < REACTIONS; ++column) {
    device::GripLoop loop;
    loop.reaction = reaction_at(column);
    const double limit = device::reaction_k_open(loop);
    if (std::isfinite(limit)) user.points.push_back({loop.reaction, limit});
  }
  PlotLayer& sampling = plot.layers.emplace_back(theory_layer("sampling, by theory", "#404040", "5 3"));
  const double sampled = device::sampled_k_open(device::GripLoop{});
  sampling.points = {{plot.x.low, sampled}, {plot.x.high, sampled}};
  const double above = legend_height(plot.layers, 2, RIGHT) + UNDER_LEGEND;
  MarkupWriter svg;
  const double top = open_picture(
      svg, {"Holding and tilting at 1 kHz: who holds, and who shakes",
            fmt::format("Map of what becomes of a held vessel over the reaction time of the user and k_open: it settles, creeps, "
                        "oscillates, saturates or is lost. By theory, sampling limits k_open to {:.3g} N/m.",
                        sampled),
            RIGHT + 8, above + HEIGHT + 3.6 * CHART_LETTER, 1.4});
  put_legend(svg, plot.layers, 2, top + CHART_LETTER, RIGHT);
  put_plot(svg, plot, {LEFT, top + above, RIGHT, top + above + HEIGHT});
  return svg.close().written();
}

}  // namespace wholehand

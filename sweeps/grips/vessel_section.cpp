// SPDX-License-Identifier: MIT
#include "sweeps/grips/vessel_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/axes.h"
#include "base/charts/colors.h"
#include "base/charts/markup.h"
#include "base/charts/picture.h"
#include "core/meshes/section.h"
#include "sweeps/grips/view.h"

namespace wholehand::sweeps {
namespace {

constexpr double EDGE = 8;               // units beside the section
constexpr double LEAST_WIDTH = 330;      // units: the legend fits
constexpr double LEGEND = 16;            // units beneath it
constexpr double DRAWN_UNITS = 360;      // of the longer side
constexpr double ARC_SAGITTA = 0.02e-3;  // m, of drawn arcs

using Points = std::vector<std::array<double, 2>>;

// Where points of the section lie in the picture.
struct Sheet {
  double left = 0, top = 0, scale = 0, low_x = 0, high_y = 0;
  Flat at(const std::array<double, 2>& p) const { return {left + scale * (p[0] - low_x), top + scale * (high_y - p[1])}; }
  std::string path(const Points& points) const {
    std::string text;
    for (const auto& p : points) text += (text.empty() ? "M" : "L") + point_text(at(p));
    return text + (points.front() == points.back() ? "Z" : "");
  }
};

// The cavity's right half from the floor to the brim, and then the left one down.
Points both_sides(const Points& right) {
  Points all = right;
  for (auto p = right.rbegin(); p != right.rend(); ++p) all.push_back({-(*p)[0], (*p)[1]});
  all.push_back(right.front());
  return all;
}

// The lowest part of a half outline, whose volume is `wanted`, with a level surface.
Points filled(const Points& outline, double wanted) {
  Points liquid{outline.front()};
  double volume = 0;
  for (std::size_t k = 1; k < outline.size(); ++k) {
    const auto &a = outline[k - 1], &b = outline[k];
    if (volume + frustum_volume(a, b) < wanted) {
      volume += frustum_volume(a, b);
      liquid.push_back(b);
      continue;
    }
    double low = 0, high = 1;  // share of the way, by bisection: the volume is a cubic of it
    for (int step = 0; step < 60; ++step) {
      const double t = (low + high) / 2;
      const std::array<double, 2> p{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
      (volume + frustum_volume(a, p) < wanted ? low : high) = t;
    }
    liquid.push_back({a[0] + low * (b[0] - a[0]), a[1] + low * (b[1] - a[1])});
    break;
  }
  return liquid;
}

}  // namespace

std::string vessel_section(const MeshSurvey& survey, const std::string& title) {
  const double azimuth = farthest_azimuth(survey.mesh.mesh);
  const std::vector<Points> lines = mesh_section(survey.mesh.mesh, azimuth);
  double low_x = 0, high_x = 0;
  const double low_y = survey.mesh.facts.low[1], high_y = survey.mesh.facts.high[1];
  for (const Points& line : lines)
    for (const auto& p : line) low_x = std::min(low_x, p[0]), high_x = std::max(high_x, p[0]);
  const double scale = DRAWN_UNITS / std::max({high_x - low_x, high_y - low_y, 1e-9});
  const double width = std::max(scale * (high_x - low_x), LEAST_WIDTH) + 2 * EDGE;
  std::string legend = fmt::format("{:.4g} mm high, {:.4g} mm wide", 1e3 * (high_y - low_y), 1e3 * (high_x - low_x));
  if (survey.cavity.cavity) legend += fmt::format("; holds {:.4g} mL, half full", 1e6 * survey.cavity.cavity->outline.volume);
  MarkupWriter svg;
  const double top = open_picture(
      svg,
      {title,
       std::string(survey.cavity.cavity ? "Section through the axis: walls, inner outline, and liquid at half of what it holds. "
                                        : "Section through the middle: walls. ") +
           legend,
       width, scale * (high_y - low_y) + 2 * EDGE + LEGEND, 1});
  const Sheet sheet{(width - scale * (high_x - low_x)) / 2, top + EDGE, scale, low_x, high_y};
  std::string walls;
  for (const Points& line : lines) walls += sheet.path(line);
  svg.empty("path", {{"d", walls},
                     {"fill", tint(okabe_ito::BLACK, 0.15)},
                     {"fill-rule", "nonzero"},
                     {"stroke", color_text(okabe_ito::BLACK)},
                     {"stroke-width", "0.8"}});
  if (survey.cavity.cavity) {
    const FoundCavity& cavity = *survey.cavity.cavity;
    const Points inner = points_on(cavity.outline, ARC_SAGITTA);
    svg.empty("path",
              {{"d", sheet.path(both_sides(filled(inner, cavity.outline.volume / 2)))}, {"fill", tint(okabe_ito::SKY_BLUE, 0.7)}});
    svg.empty("path", {{"d", sheet.path(both_sides(inner))},
                       {"fill", "none"},
                       {"stroke", color_text(okabe_ito::VERMILION)},
                       {"stroke-width", "1"}});
  }
  put_text(svg, EDGE, top + scale * (high_y - low_y) + EDGE + LEGEND, legend, "");
  svg.close();
  return svg.written();
}

}  // namespace wholehand::sweeps

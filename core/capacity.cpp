// SPDX-License-Identifier: MIT
#include "core/capacity.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/load.h"
#include "core/prepare.h"

namespace wholehand {
namespace {

constexpr double WIDER = 0.1e-3;  // m: the margin by which a cavity is wider above and beneath a narrow place
constexpr double SAME = 1e-9;     // m: radii that differ by rounding

// The volume of the cavity below a height.
double volume_below(const std::vector<PreparedElement>& cavity, double height) {
  const core_f64::Quadrature rule = core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS));
  double volume = 0;
  for (const PreparedElement& piece : cavity) {
    if (piece.a[1] >= height) break;
    core_f64::Element part = core_f64::load_element(piece);
    if (part.b.y > height) part.b = {core_f64::element_radius(part, height), height};
    volume += core_f64::revolved_element(rule, part).volume;
  }
  return volume;
}

// Points (r, y) of a cavity between which its radius rises or falls.
std::vector<std::array<double, 2>> turning_points(const std::vector<PreparedElement>& cavity) {
  std::vector<std::array<double, 2>> points;
  for (const PreparedElement& piece : cavity) {
    points.push_back(piece.a);
    const double middle = piece.center[1];
    if (piece.side != 0 && middle > piece.a[1] && middle < piece.b[1])
      points.push_back({piece.center[0] + piece.side * piece.radius, middle});
    points.push_back(piece.b);
  }
  return points;
}

}  // namespace

double capacity_of(const VesselData& vessel) {
  return vessel.has_cavity() ? volume_below(prepare_cavity(vessel), std::numeric_limits<double>::infinity()) : 0;
}

std::optional<Narrow> narrow_place(const VesselData& vessel, double limit) {
  if (!vessel.has_cavity()) return std::nullopt;
  const std::vector<PreparedElement> cavity = prepare_cavity(vessel);
  const auto points = turning_points(cavity);
  std::vector<double> above(points.size() + 1, 0);  // largest radius from a point up
  for (std::size_t i = points.size(); i-- > 0;) above[i] = std::max(above[i + 1], points[i][0]);
  std::optional<Narrow> narrow;
  double beneath = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [radius, height] = points[i];
    const bool is_narrow = radius < limit && std::min(beneath, above[i + 1]) > radius + WIDER;
    // a stem of constant width counts at its upper end
    if (is_narrow && (!narrow || radius <= narrow->radius + SAME)) narrow = Narrow{height, radius, 0};
    beneath = std::max(beneath, radius);
  }
  if (narrow) narrow->beneath = volume_below(cavity, narrow->height);
  return narrow;
}

}  // namespace wholehand

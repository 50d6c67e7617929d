// SPDX-License-Identifier: MIT
#include "sweeps/plan/edge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/text.h"

namespace wholehand::sweeps {
namespace {

constexpr double ROUNDING = 1e-9;  // rad, or of a vessel's height

bool is_searched(const Plan& plan, int place) {
  if (place == PLACE_HAND_SCALE || (place == PLACE_AZIMUTH && plan.is_symmetric())) return false;
  return plan.axes()[place].kind != AxisKind::number;
}

// The distance from an end of the axis within which a grip counts as at it.
double margin_of(const Plan& plan, const PlanAxis& axis) {
  if (axis.kind != AxisKind::range) return 0;
  int searched = 0;
  for (int place = 0; place < static_cast<int>(plan.axes().size()); ++place) searched += is_searched(plan, place);
  // half a step of the grid that has as many grips; of fewer than three values all would lie at an end
  const double values = std::max(3.0, std::pow(static_cast<double>(plan.grips()), 1.0 / searched));
  return 0.5 * (axis.high - axis.low) / (values - 1);
}

// Whether the values of an angle go all the way round: the step from the last to the first is no longer than between two others.
bool is_round(const PlanAxis& axis) {
  const double rest = 2 * PI - (axis.high - axis.low);
  if (axis.kind == AxisKind::range) return rest <= ROUNDING;
  std::vector<double> values = axis.values;
  std::sort(values.begin(), values.end());
  double longest = 0;
  for (std::size_t i = 1; i < values.size(); ++i) longest = std::max(longest, values[i] - values[i - 1]);
  return rest <= longest + ROUNDING;
}

// Whether the axis cannot continue beyond an end, by `place`; heights as on the axis.
bool is_limit(const Scene& scene, const Plan& plan, std::size_t vessel, int place, double end) {
  if (place == PLACE_OBLIQUITY) return std::abs(end) >= PI / 2 - ROUNDING;
  if (place != PLACE_HEIGHT) return false;
  const VesselData& data = scene.vessels[vessel];
  const bool is_fraction = plan.axes()[place].units == "1";
  const double low = is_fraction ? 0 : data.base, high = is_fraction ? 1 : data.height;
  const double rounding = ROUNDING * (high - low);
  return end <= low + rounding || end >= high - rounding;
}

bool is_at_end(const Scene& scene, const Plan& plan, std::size_t vessel, int place, std::uint64_t grip) {
  const PlanAxis& axis = plan.axes()[place];
  const double margin = margin_of(plan, axis);
  double value = 0;
  plan.coordinates(place, grip, 1, &value);
  const bool is_low = value <= axis.low + margin && !is_limit(scene, plan, vessel, place, axis.low);
  const bool is_high = value >= axis.high - margin && !is_limit(scene, plan, vessel, place, axis.high);
  return is_low || is_high;
}

}  // namespace

std::string axis_key(const PlanAxis& axis) { return axis.name + (axis.units == "m" ? "_mm" : axis.units == "rad" ? "_deg" : ""); }

std::vector<std::string> edge_axes(const Scene& scene, const Plan& plan, std::size_t vessel, const std::vector<Candidate>& best) {
  const auto equals_end =
      std::find_if(best.begin(), best.end(), [&](const Candidate& candidate) { return candidate.score != best[0].score; });
  std::vector<std::string> axes;
  if (best.empty()) return axes;
  for (const int place : {PLACE_HEIGHT, PLACE_AZIMUTH, PLACE_OBLIQUITY, PLACE_ROLL, PLACE_OFFSET}) {
    const PlanAxis& axis = plan.axes()[place];
    if (!is_searched(plan, place)) continue;
    if ((place == PLACE_AZIMUTH || place == PLACE_ROLL) && is_round(axis)) continue;
    const auto at_end = [&](const Candidate& candidate) { return is_at_end(scene, plan, vessel, place, candidate.index); };
    if (std::all_of(best.begin(), equals_end, at_end)) axes.push_back(axis_key(axis));
  }
  return axes;
}

std::string edge_line(const std::vector<std::string>& axes) {
  if (axes.empty()) return "";
  return fmt::format("the best grip lies on the edge of {}; widen {}?", joined(axes, " and "), axes.size() == 1 ? "it" : "them");
}

}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
#include "sweeps/grips/states.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/markup.h"
#include "base/numbers/nearest.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/effort.h"
#include "core/planes.h"

namespace wholehand::sweeps {

const std::array<PointStyle, 3> POINT_STYLES{
    {{"touching", okabe_ito::VERMILION}, {"projected", okabe_ito::BLUE}, {"free", {255, 255, 255}}}};

PointState point_state(const GripResult& result, int joint) {
  const std::uint32_t projected = result.tip_mask | result.finger_mask | result.inner_mask;
  if ((projected >> joint & 1) != 0) return PointState::projected;
  return (result.touch_mask >> joint & 1) != 0 ? PointState::touching : PointState::free;
}

void check_drawable(const GripReport& report, const std::string& option) {
  const Reason reason = report.answer.result.reason;
  if (reason == Reason::none) return;
  throw usage_error(fmt::format("{}: the grip of {} is not feasible ({}), so there is no hand to draw; choose another grip", option,
                                report.vessel, REASON_NAMES[static_cast<std::size_t>(reason)]));
}

const GripState* drawn_liquid(const GripReport& report) {
  const auto& states = report.answer.states;
  const auto found = std::find_if(states.begin(), states.end(), [](const GripState& s) { return s.liquid.volume > 0; });
  return found == states.end() ? nullptr : &*found;
}

std::optional<std::size_t> hardest_state(const GripReport& report) {
  std::optional<std::size_t> hardest;
  for (std::size_t k = 0; k < report.holds.size(); ++k) {
    // against NaN every comparison is false: one in the first place would stay there
    const double effort = report.holds[k].effort;
    if (!std::isnan(effort) && (!hardest || effort > report.holds[*hardest].effort)) hardest = k;
  }
  if (!hardest || !report.hold) return hardest;
  const auto& states = report.answer.states;
  for (std::size_t k = 0; k < std::min(states.size(), report.holds.size()); ++k) {
    const bool is_worst = states[k].fill == report.hold->worst_fill && states[k].tilt == report.hold->worst_tilt;
    if (is_worst && report.holds[k].effort >= report.holds[*hardest].effort * (1 - core_f64::EFFORT_TOLERANCE)) return k;
  }
  return hardest;
}

std::string fill_number(const GripReport& report, double fill) {
  return report.capacity > 0 ? plain_text(1e6 * report.capacity * fill, 4) : plain_text(fill, 3);
}

std::string fill_words(const GripReport& report, double fill) {
  if (fill == 0) return "empty";
  if (report.capacity > 0) return fill_number(report, fill) + " mL";
  return "fill " + fill_number(report, fill);
}

std::string fill_text(const Scene& scene, std::size_t vessel, double fill) {
  if (!scene.liquid || scene.liquid->volumes.empty()) return share_text(scene, fill);
  const std::size_t place = nearest_place(vessel_fills(scene, scene.vessels[vessel]), fill);
  return plain_number(scene.vessels[vessel].has_cavity() ? 1e6 * scene.liquid->volumes[place] : 0) + "\u00a0mL";
}

std::string share_text(const Scene& scene, double fill) {
  return scene.liquid ? shown_number(100 * fill, std::abs(100 * fill - std::round(100 * fill)) < 0.05 ? 0 : 1) + "\u00a0%"
                      : "empty";
}

}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
#include "grips/states.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace wholehand {

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
  const auto& holds = report.holds;
  if (holds.empty()) return std::nullopt;
  const auto takes_less = [](const StateHold& a, const StateHold& b) { return a.effort < b.effort; };
  return static_cast<std::size_t>(std::max_element(holds.begin(), holds.end(), takes_less) - holds.begin());
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "sweeps/rank/unheld.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/gather.h"
#include "shaders/status.h"
#include "sweeps/grips/report.h"
#include "sweeps/grips/states.h"

namespace wholehand::sweeps {
namespace {

// Rounded up at the third decimal, so that the stated value suffices.
std::string enough(double value) { return fixed_text(std::ceil(value * 1e3 - 1e-9) / 1e3, 3); }

// "height 40.0 mm, roll -60.0 deg": the coordinates that vary between grips.
std::string place_of(const Plan& plan, const GripInput& grip) {
  std::vector<std::string> parts;
  const auto add = [&](int place, const char* name, double value, const char* unit) {
    if (plan.varies(place)) parts.push_back(fmt::format("{} {} {}", name, fixed_text(value, 1), unit));
  };
  add(PLACE_HEIGHT, "height", grip.height * 1e3, "mm");
  add(PLACE_AZIMUTH, "azimuth", degrees(grip.azimuth), "deg");
  add(PLACE_OBLIQUITY, "obliquity", degrees(grip.obliquity), "deg");
  add(PLACE_ROLL, "roll", degrees(grip.roll), "deg");
  add(PLACE_OFFSET, "offset", grip.offset * 1e3, "mm");
  if (plan.varies(PLACE_HAND_SCALE)) parts.push_back(fmt::format("hand scale {}", fixed_text(grip.hand_scale, 3)));
  return parts.empty() ? "" : " (" + joined(parts, ", ") + ")";
}

std::string fills_up_to(const Scene& scene, std::size_t vessel, double fill) {
  if (fill == 0) return "an empty vessel";
  const std::string text = fill_text(scene, vessel, fill);  // number and unit kept together, as for a page
  const std::string_view space = "\u00a0";
  const std::size_t at = text.find(space);
  return "fills up to " + (at == std::string::npos ? text : text.substr(0, at) + " " + text.substr(at + space.size()));
}

}  // namespace

Unheld what_would_hold(const Evaluator& core, const Scene& scene, std::size_t vessel, const GripInput& grip) {
  const FieldSet fields = make_field_set({FIELD_WORST_EFFORT, FIELD_FRICTION_NEEDED, FIELD_EFFORT, FIELD_STATUS}, scene);
  const GatheredPlanes planes = gather(core, fields, vessel, {grip});
  const auto real = [&](int field, std::size_t k = 0) { return planes.real(fields.plane[field] + static_cast<int>(k), 0); };
  Unheld found{real(FIELD_WORST_EFFORT), real(FIELD_FRICTION_NEEDED), {}, {}};
  const std::size_t fills = scene_fills(scene), tilts = scene.tilts.size();
  // a state that is left out has no effort, and asks for none
  const auto fails = [&](std::size_t fill, std::size_t tilt) { return real(FIELD_EFFORT, fill * tilts + tilt) > 1; };
  std::size_t held_fills = 0, held_tilts = 0;
  const auto holds_fill = [&](std::size_t fill) {
    for (std::size_t tilt = 0; tilt < tilts; ++tilt)
      if (fails(fill, tilt)) return false;
    return true;
  };
  const auto holds_tilt = [&](std::size_t tilt) {
    for (std::size_t fill = 0; fill < fills; ++fill)
      if (fails(fill, tilt)) return false;
    return true;
  };
  while (held_fills < fills && holds_fill(held_fills)) ++held_fills;
  while (held_tilts < tilts && holds_tilt(held_tilts)) ++held_tilts;
  // all of them: the worst effort is above 1 by less than its tolerance
  if (scene.liquid && held_fills > 0 && held_fills < fills) found.fill = vessel_fills(scene, scene.vessels[vessel])[held_fills - 1];
  if (held_tilts > 0 && held_tilts < tilts) found.tilt = scene.tilts[held_tilts - 1];
  return found;
}

LeastBad with_least_friction(const Evaluator& core, const Scene& scene, const Plan& plan, std::size_t vessel,
                             const LeastBad& nearest) {
  constexpr std::uint64_t FRICTION_GRIPS = 8192;
  if (std::isfinite(nearest.effort) || std::isfinite(nearest.friction)) return nearest;
  const std::uint64_t step = std::max<std::uint64_t>(1, plan.grips() / FRICTION_GRIPS);
  std::vector<GripInput> grips;
  for (std::uint64_t i = 0; i < plan.grips(); i += step) grips.push_back(plan.grip(vessel, i));
  const FieldSet fields = make_field_set({FIELD_FRICTION_NEEDED, FIELD_STATUS}, scene);
  const GatheredPlanes planes = gather(core, fields, vessel, grips);
  LeastBad least = nearest;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    if (!is_plausible(planes.uint(FIELD_STATUS, i))) continue;
    const double friction = planes.real(fields.plane[FIELD_FRICTION_NEEDED], i);
    if (friction < least.friction) least = {nearest.effort, friction, i * step};
  }
  return least;
}

std::string unheld_line(const Evaluator& core, const Scene& scene, const Plan& plan, std::size_t vessel, const LeastBad& nearest) {
  const GripInput grip = plan.grip(vessel, nearest.grip);
  const Unheld found = what_would_hold(core, scene, vessel, grip);
  const bool is_resisted = std::isfinite(found.effort), has_friction = std::isfinite(found.friction_needed);
  const char* fails = "the strength of the hand fails first";
  if (friction_fails_first(scene, found.effort, found.friction_needed))
    fails = has_friction ? "friction fails first" : "no friction up to 10 is enough for how the hand touches it";
  std::string line =
      fmt::format("no grip holds it: {}. Nearest to holding is grip {}{}, ", fails, nearest.grip, place_of(plan, grip));
  line += is_resisted ? fmt::format("whose worst effort is {}", fixed_text(found.effort, 3))
                      : "which no force holds in its worst state";
  std::vector<std::string> ways;
  if (is_resisted) ways.push_back(fmt::format("{} times the strength", enough(found.effort)));
  if (has_friction)
    ways.push_back(fmt::format("a friction of {} (now {})", enough(found.friction_needed), plain_text(scene.force.friction)));
  if (found.fill) ways.push_back(fills_up_to(scene, vessel, *found.fill));
  if (found.tilt)
    ways.push_back(*found.tilt == 0 ? std::string("keeping it upright")
                                    : fmt::format("tilts up to {} deg", plain_text(degrees(*found.tilt))));
  if (ways.empty()) return line;
  const std::string last = ways.back();
  ways.pop_back();
  return line + fmt::format(". {}{}{} would hold it", joined(ways, ", "), ways.empty() ? "" : " or ", last);
}

}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
#include "evidence/trials/cases.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/error.h"
#include "core/counted_tilts.h"
#include "core/planes.h"

namespace wholehand {
namespace {

constexpr std::size_t USUAL_TILTS = 4, QUICK_GRIPS = 60, QUICK_BEST = 4, QUICK_PUSHED_GRIPS = 12, QUICK_PUSHED_BEST = 2,
                      QUICK_LOOKED = 2000;

bool holds_liquid(const Scene& scene, const Evaluator& core, std::size_t vessel) {
  return scene.liquid && core.capacity(vessel) > 0;
}

// `count` of the values, the first and the last among them.
std::vector<double> spread_values(const std::vector<double>& values, std::size_t count) {
  if (values.size() <= count) return values;
  std::vector<double> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(values[(k * (values.size() - 1) + (count - 1) / 2) / (count - 1)]);
  return chosen;
}

}  // namespace

const std::array<const char*, FORCE_DIRECTIONS> FORCE_DIRECTION_NAMES{"+x", "-x", "+y", "-y", "+z", "-z"};

void make_quick(TrialOptions& options) {
  options.quick = true;
  // all pushes of a grip take four times as long as its tilts at one fill
  options.grips = options.six_forces ? QUICK_PUSHED_GRIPS : QUICK_GRIPS;
  options.best = options.six_forces ? QUICK_PUSHED_BEST : QUICK_BEST;
  options.most_looked = QUICK_LOOKED;
}

std::vector<double> usual_fills(const Scene& scene, const Evaluator& core, std::size_t vessel) {
  if (!holds_liquid(scene, core, vessel)) return {0};
  std::vector<double> filled;
  for (const double fill : vessel_fills(scene, scene.vessels[vessel]))
    if (fill > 0) filled.push_back(fill);
  if (filled.empty()) return {0};
  return spread_values(filled, 3);
}

std::vector<double> usual_tilts(const Scene& scene) { return spread_values(scene.tilts, USUAL_TILTS); }

std::vector<TrialCase> trial_cases(const Scene& scene, const Evaluator& core, std::size_t vessel, const TrialOptions& options) {
  if (!options.fills.empty() && !holds_liquid(scene, core, vessel))
    throw usage_error(fmt::format("--fill: vessel '{}' holds no liquid; leave --fill out, or name another vessel with --vessel",
                                  scene.vessels[vessel].name));
  std::vector<double> fills = options.fills.empty() ? usual_fills(scene, core, vessel) : options.fills;
  if (options.quick && options.fills.empty()) fills = {fills.back()};
  const std::vector<double> tilts = options.tilts.empty() ? usual_tilts(scene) : options.tilts;
  const std::vector<std::size_t> counted = counted_tilts(scene, vessel, fills);
  std::vector<TrialCase> cases;
  for (std::size_t f = 0; options.fill_tilt && f < fills.size(); ++f)
    for (const double tilt : tilts) {
      if (options.tilts.empty() && tilt > scene.tilts[std::max<std::size_t>(counted[f], 1) - 1]) break;
      TrialCase one;
      one.fill = fills[f];
      one.tilt = tilt;
      cases.push_back(one);
    }
  const std::size_t materials = options.six_forces ? options.settings.materials.size() : 0;
  for (std::size_t material = 0; material < materials; ++material)
    for (int direction = 0; direction < FORCE_DIRECTIONS; ++direction) {
      TrialCase one;
      one.protocol = TrialProtocol::six_forces;
      one.fill = fills.back();
      one.direction = direction;
      one.material = static_cast<int>(material);
      cases.push_back(one);
    }
  return cases;
}

}  // namespace wholehand

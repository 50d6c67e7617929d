// SPDX-License-Identifier: MIT
// For a vessel that no grip holds: what fails, how far the nearest grip is from holding, and what would make it hold.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/evaluator.h"
#include "sweeps/plan/plan.h"
#include "sweeps/result/mark.h"

namespace wholehand::sweeps {

// What an unheld grip would need, by the core in double precision. A fill is in the order of the scene's, a tilt in rad.
struct Unheld {
  double effort = 0;           // the worst; infinite if no force holds
  double friction_needed = 0;  // infinite: no friction up to 10 holds all states
  std::optional<double> fill;  // every counted tilt holds up to this fill,
  std::optional<double> tilt;  // and every fill up to this tilt; absent: not even at the first
};

// `scene` has [strength] and tilts; the grip is plausible.
Unheld what_would_hold(const Evaluator& core, const Scene& scene, std::size_t vessel, const GripInput& grip);

// If no force holds the nearest grip, its effort is one of many infinite ones, and the choice is arbitrary. Then returns the plausible grip that
// needs the least friction, by the core: among all grips, or 8,192 to 16,384 evenly spaced ones. Returns `nearest` if its effort is finite or its
// friction is known, or if no friction is enough.
LeastBad with_least_friction(const Evaluator& core, const Scene& scene, const Plan& plan, std::size_t vessel,
                             const LeastBad& nearest);

// "no grip holds it: the strength of the hand fails first. Nearest to holding is grip 12 (height 40.0 mm, roll -60.0 deg), whose worst effort is
// 1.73.
// 1.74 times the strength, a friction of 0.912 (now 0.6) or tilts up to 30 deg would hold it". One line, without the vessel's name.
std::string unheld_line(const Evaluator& core, const Scene& scene, const Plan& plan, std::size_t vessel, const LeastBad& nearest);

}  // namespace wholehand::sweeps

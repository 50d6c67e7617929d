// SPDX-License-Identifier: MIT
// Where no grip of a vessel holds: what fails, how far the grip that is nearest to it is from holding, and what would make it hold.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/evaluator.h"
#include "sweeps/plan/plan.h"
#include "sweeps/result/mark.h"

namespace wholehand {

// What a grip that does not hold would take, by the core in double precision. A fill is in the order of the scene's, a tilt in rad.
struct Unheld {
  double effort = 0;           // the worst; infinite where no force holds
  double friction_needed = 0;  // infinite: no friction up to 10 holds all states
  std::optional<double> fill;  // up to this one every tilt that counts holds,
  std::optional<double> tilt;  // and up to this one every fill; absent: not even at the first
};

// `scene` has [strength] and tilts; the grip is plausible.
Unheld what_would_hold(const Evaluator& core, const Scene& scene, std::size_t vessel, const GripInput& grip);

// A nearest grip that no force holds has the least effort of many, all infinite. Then the plausible grip that needs the least friction, by the core:
// among all grips, or 8,192 to 16,384 evenly spaced ones. `nearest` where its effort is finite or its friction is known, and where no friction is
// enough.
LeastBad with_least_friction(const Evaluator& core, const Scene& scene, const Plan& plan, std::size_t vessel,
                             const LeastBad& nearest);

// "no grip holds it: the strength of the hand fails first. Nearest to holding is grip 12 (height 40.0 mm, roll -60.0 deg), whose worst effort is
// 1.73.
// 1.74 times the strength, a friction of 0.912 (now 0.6) or tilts up to 30 deg would hold it". One line, without the vessel's name.
std::string unheld_line(const Evaluator& core, const Scene& scene, const Plan& plan, std::size_t vessel, const LeastBad& nearest);

}  // namespace wholehand

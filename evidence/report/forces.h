// SPDX-License-Identifier: MIT
// Forces of a vessel's best grip over the tilt in a report, and the tilt at which the vessel starts to pour.
#pragma once

#include <string>
#include <vector>

#include "evidence/report/source.h"

namespace wholehand {

// Feedback and hold force of one fill, N; hold is infinite if no force holds.
struct FillForces {
  double fill = 0;
  double strength = 0;                 // what each of two tips can press with, N
  std::vector<double> feedback, hold;  // over the scene's tilts; NaN at those that are left out
};
// By the core. Empty if the grip is not feasible or the scene has no tilts.
std::vector<FillForces> forces_of(const ReportSource& source, std::size_t vessel, const GripInput& grip);

// Charts and a table of them; a sentence instead if there are none.
void write_forces(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const GripInput& grip, const std::string& id);

// The tilts at which pouring starts.
void write_pouring(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id);

// The fills that a chart draws: as many as there are distinguishable lines, with the first and the last.
std::vector<std::size_t> shown_fills(std::size_t count);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Efforts of the whole hand in a report: digit by digit in the hardest state, and over the tilt.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "evidence/report/margins.h"
#include "evidence/report/source.h"

namespace wholehand {

// Whether the report has efforts: the scene has [strength] and tilts.
bool reports_efforts(const Scene& scene);

// The grip by the core over the scene's own states; also what holding demands if the scene has [strength]. Needs the core.
sweeps::GripReport grip_with_holding(const ReportSource& source, std::size_t vessel, const GripInput& grip);

// A digit's load in a state: the sum of the normal forces of its contacts, N, and its share of the digit's strength.
struct DigitLoad {
  double force = 0, share = 0;
};
// By digit, the palm last; NaN if no force of the hand holds the state.
std::array<DigitLoad, FINGER_COUNT + 1> digit_loads(const sweeps::StateHold& hold);

// A table of them for some grips, each in its hardest state; nothing if no grip has holds. `name`: of the list of grips.
void write_digits(MarkupWriter& html, const Scene& scene, const std::vector<RankedReport>& grips, const std::string& name);

// Efforts of the fullest fill over the scene's tilts: of the whole hand, and of the tips of thumb and index finger alone. Infinite if no force holds
// the vessel, NaN at tilts that are left out.
struct TiltEfforts {
  std::vector<double> whole, tips;
};
// By the core. Empty if the grip is not feasible, or without reports_efforts.
TiltEfforts efforts_over_tilt(const ReportSource& source, std::size_t vessel, const GripInput& grip);

// A chart and a table of them, or a sentence instead. Nothing without reports_efforts.
void write_efforts(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const GripInput& grip,
                   const std::string& id);

// Success rates elsewhere, as context.
void write_protocols(MarkupWriter& html);

}  // namespace wholehand

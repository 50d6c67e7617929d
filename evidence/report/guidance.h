// SPDX-License-Identifier: MIT
// Touching against the distance from a guidance point in a report, like the paper's Table 1 and Fig. 7 for people.
#pragma once

#include <string>
#include <vector>

#include "evidence/report/guidance_statistics.h"
#include "evidence/report/source.h"

namespace wholehand {

constexpr std::size_t GUIDED_GRIPS = 1 << 16;  // of a vessel, at most

struct GuidedSample {
  std::vector<GuidedGrip> grips;  // feasible and plausible
  std::size_t looked_at = 0;      // grips of the sweep
  bool is_by_core = false;        // touching comes from the core, because the file lacks it
};

// The vessel's grips at sample_places. Feasibility, plausibility and touching come from the file if it has them; the contacts come from the core.
// Needs the core and a vessel with guidance points.
GuidedSample guided_grips(const ReportSource& source, std::size_t vessel);

void write_guidance(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id);

}  // namespace wholehand

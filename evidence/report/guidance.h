// SPDX-License-Identifier: MIT
// Touching and the distance from a guidance point in a report, as the paper's Table 1 and Fig. 7 show them for people.
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
  bool is_by_core = false;        // what touches is the core's, since the file does not have it
};

// The vessel's grips at sample_places. What is feasible, plausible and touches is the file's where it has that; the contacts are the core's.
// Needs the core and a vessel with guidance points.
GuidedSample guided_grips(const ReportSource& source, std::size_t vessel);

void write_guidance(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Checks on a sample of grips whether the numbers of a result file are the core's.
#pragma once

#include <string>
#include <vector>

#include "evidence/check/compare.h"
#include "evidence/report/source.h"

namespace wholehand {

constexpr std::size_t SAMPLED_GRIPS = 256;  // of a vessel, besides the listed ones

struct Agreement {
  std::vector<Comparison> rows;         // of the file's values; `grip` is an index among the compared grips
  std::vector<std::string> outcomes;    // compared discrete ones: "reason", "touch_mask", ..
  std::vector<std::string> uncompared;  // variables of the file that were not compared
  std::uint64_t grips = 0, feasible = 0;
  std::uint64_t grazing = 0;   // left out: grazing by the core, or within its tolerance
  std::uint64_t excluded = 0;  // a discrete outcome differs within the margin
  std::uint64_t allowed = 0;   // .. at most this many
  std::uint64_t flipped = 0;   // .. beyond it
  std::uint64_t outside = 0;   // numbers beyond their tolerance
  bool holds() const { return flipped == 0 && outside == 0 && excluded <= allowed; }
};

// Recomputes the vessel's grips at sample_places and in its lists by the core in double, and compares them by the tolerances of `wholehand check` for
// the precision of the file. Needs the core.
Agreement compare_with_core(const ReportSource& source, std::size_t vessel);

void write_agreement(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id);

}  // namespace wholehand

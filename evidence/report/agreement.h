// SPDX-License-Identifier: MIT
// Whether the numbers of a result file are the core's, on a sample of its grips.
#pragma once

#include <string>
#include <vector>

#include "evidence/check/compare.h"
#include "evidence/report/source.h"

namespace wholehand {

constexpr std::size_t SAMPLED_GRIPS = 256;  // of a vessel, and those that are listed

struct Agreement {
  std::vector<Comparison> rows;         // of what the file holds; `grip` is a place among the compared grips
  std::vector<std::string> outcomes;    // discrete ones that were compared: "reason", "touch_mask", ..
  std::vector<std::string> uncompared;  // variables that the file holds and that were not
  std::uint64_t grips = 0, feasible = 0;
  std::uint64_t grazing = 0;   // left out: by the core, or within the tolerance of that
  std::uint64_t excluded = 0;  // a discrete outcome differs within the margin
  std::uint64_t allowed = 0;   // .. in so many at most
  std::uint64_t flipped = 0;   // .. beyond it
  std::uint64_t outside = 0;   // numbers beyond their tolerance
  bool holds() const { return flipped == 0 && outside == 0 && excluded <= allowed; }
};

// The vessel's grips at sample_places and in its lists, computed anew by the core in double and compared by the tolerances of `wholehand check` for
// the
// precision of the file. Needs the core.
Agreement compare_with_core(const ReportSource& source, std::size_t vessel);

void write_agreement(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id);

}  // namespace wholehand

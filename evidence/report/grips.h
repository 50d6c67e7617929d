// SPDX-License-Identifier: MIT
// The best grips of a vessel in a report: a table of them, and drawings of the first.
#pragma once

#include <string>
#include <vector>

#include "evidence/report/source.h"
#include "sweeps/grips/report.h"
#include "sweeps/lists/best.h"

namespace wholehand {

constexpr std::size_t DRAWN_GRIPS = 3, TABLED_GRIPS = 50;

// The first TABLED_GRIPS of a list of grips (GripLists). Their ranks, scores and places come from the list; everything else from the core in double
// precision, if there is one (is_whole).
struct ReportedGrips {
  std::vector<sweeps::BestGrip> grips;  // the best first
  std::size_t listed = 0;               // in all
  bool is_whole = false;
};
ReportedGrips read_grips(const ReportSource& source, std::size_t list);

// The table, and a figure with the drawings of the first DRAWN_GRIPS. A sentence replaces what cannot be drawn. `id`: of the list, in the page.
void write_grips(MarkupWriter& html, const ReportSource& source, std::size_t list, const ReportedGrips& best,
                 const std::string& id);

// The front and the side view of a drawing by grip_svg, with larger letters, for display beside others. The whole drawing if its views are not found.
std::string front_and_side(const std::string& drawing);

}  // namespace wholehand

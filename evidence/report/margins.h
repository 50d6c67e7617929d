// SPDX-License-Identifier: MIT
// How far a grip is from each of its limits, and the sentence that says so.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/charts/markup.h"
#include "sweeps/grips/report.h"

namespace wholehand {

// What a grip can fail by: the strength of the hand, the friction of the vessel, the table below it, the force of the gripper.
enum class Limit { effort, friction, table, force };

// How many times over the grip keeps to a limit: more than 1 within it, less than 1 beyond it; infinite where nothing comes near.
struct Margin {
  Limit limit = Limit::effort;
  double value = 0;
};

constexpr double TABLE_MARGIN_STEP = 10e-3;  // m of room above the table that add 1 to its margin, as the score's depth term has it

// The margins that the grip has, in the order of the limits: 1 / worst effort, mu / friction needed, 1 + room / TABLE_MARGIN_STEP,
// F_max / largest normal force. The table is absent without [table], and friction where none is enough. There are none for a grip
// without holds: the scene has no [strength] or no tilts, or the grip is not feasible. `report` has the scene's own states.
std::vector<Margin> grip_margins(const Scene& scene, const GripReport& report);

// The smallest, the first of equal ones; nothing where there is none or all are infinite.
std::optional<Margin> smallest_margin(const std::vector<Margin>& margins);

// A grip of a list, with its place there.
struct RankedReport {
  std::size_t rank = 1;
  GripReport report;
};

// "This grip is good because ..; friction would fail first, because .. (margin 1.9)." The reasons are at most two terms of the score, or the
// share of the deviations that hold, in which the grip is better than the median of its list, first where it is better than most grips. Where
// there is one or none, the term that adds most to the score follows. The term that the smallest margin is about is no reason. Where a limit is
// not kept: "Although .., friction fails, because ..". Empty for a grip without holds.
std::string verdict(const Scene& scene, const GripReport& report, const std::vector<RankedReport>& list);

// A table of margins, and of the efforts that they come from; nothing where no grip has holds. `name`: of the list.
void write_margins(MarkupWriter& html, const Scene& scene, const std::vector<RankedReport>& grips, const std::string& name);

}  // namespace wholehand

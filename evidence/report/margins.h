// SPDX-License-Identifier: MIT
// A grip's margin to each of its limits, and the sentence that states it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/charts/markup.h"
#include "sweeps/grips/report.h"

namespace wholehand {

// What can fail a grip: the strength of the hand, the friction of the vessel, the table below it, the force of the gripper.
enum class Limit { effort, friction, table, force };

// The factor by which the grip keeps a limit: above 1 within it, below 1 beyond it; infinite if nothing comes near.
struct Margin {
  Limit limit = Limit::effort;
  double value = 0;
};

constexpr double TABLE_MARGIN_STEP = 10e-3;  // m of room above the table that add 1 to its margin, as in the score's depth term

// The margins of the grip, in the order of the limits: 1 / worst effort, mu / friction needed, 1 + room / TABLE_MARGIN_STEP, F_max / largest normal
// force. The table is absent without [table], and friction if none is enough. A grip without holds has none: the scene has no [strength] or no tilts,
// or the grip is not feasible. `report` has the scene's own states.
std::vector<Margin> grip_margins(const Scene& scene, const sweeps::GripReport& report);

// The smallest, the first in a tie; nothing if there is none or all are infinite.
std::optional<Margin> smallest_margin(const std::vector<Margin>& margins);

// A grip of a list, with its place there.
struct RankedReport {
  std::size_t rank = 1;
  sweeps::GripReport report;
};

// "This grip is good because ..; friction would fail first, because .. (margin 1.9)." The reasons are at most two of the score's terms and the share
// of the deviations that hold, if the grip is better there than the median of its list; first come those in which it is better than most grips. If
// there is one reason or none, the term that adds most to the score follows. The term that the smallest margin is about is no reason. If a limit is
// exceeded: "Although .., friction fails, because ..". Empty for a grip without holds.
std::string verdict(const Scene& scene, const sweeps::GripReport& report, const std::vector<RankedReport>& list);

// A table of margins, and of the efforts behind them; nothing if no grip has holds. `name`: of the list.
void write_margins(MarkupWriter& html, const Scene& scene, const std::vector<RankedReport>& grips, const std::string& name);

}  // namespace wholehand

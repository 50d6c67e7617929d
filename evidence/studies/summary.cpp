// SPDX-License-Identifier: MIT
#include "evidence/studies/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "evidence/studies/advice_statistics.h"
#include "evidence/studies/force_page.h"
#include "evidence/studies/sensitivity.h"
#include "evidence/studies/statistic_tables.h"

namespace wholehand {
namespace {

constexpr std::array<const char*, 5> SUMMARIZED{"held_share", "mean_fingers", "pearson_fingers_height", "pearson_fingers_distance",
                                                "projected_share"};

std::string shown(double value) { return std::isnan(value) ? "-" : fmt::format("{:.2f}", value); }

// A line for each pose and vessel.
std::string contact_summary(std::span<const StudyRow> rows) {
  std::string text = fmt::format("\n{:<12} {:<16} {:>6} {:>8} {:>17} {:>19} {:>10}\n", "pose", "vessel", "held", "fingers",
                                 "r fingers, height", "r fingers, distance", "projected");
  std::array<std::string, SUMMARIZED.size()> cells;
  for (const StudyRow& row : rows) {
    if (!row.subject.empty()) continue;
    for (std::size_t k = 0; k < SUMMARIZED.size(); ++k)
      if (row.statistic == SUMMARIZED[k]) cells[k] = shown(row.value);
    // the last of a vessel's
    if (row.statistic == "grasps_projected_inner_share")
      text += fmt::format("{:<12} {:<16} {:>6} {:>8} {:>17} {:>19} {:>10}\n", row.pose, row.vessel, cells[0], cells[1], cells[2],
                          cells[3], cells[4]);
  }
  return text;
}

}  // namespace

std::string study_summary(std::span<const StudyRow> rows) {
  std::string text;
  const auto is_sensitivity = [](const StudyRow& row) { return row.statistic.starts_with(FIRST_ORDER_OF); };
  // the rows of an experiment are neighbors, and those of sensitivity come last
  rows = rows.first(static_cast<std::size_t>(std::find_if(rows.begin(), rows.end(), is_sensitivity) - rows.begin()));
  for (std::size_t first = 0, end = 0; first < rows.size(); first = end) {
    while (end < rows.size() && rows[end].experiment == rows[first].experiment) ++end;
    const auto of_one = rows.subspan(first, end - first);
    const std::string& experiment = of_one.front().experiment;
    if (experiment == "contacts") {
      text += contact_summary(of_one);
    } else {
      text += "\n" + (experiment == "forces"   ? force_summary(of_one)
                      : experiment == "advice" ? advice_summary(of_one)
                                               : statistic_table(of_one));
    }
  }
  return text;
}

}  // namespace wholehand

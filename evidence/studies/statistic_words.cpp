// SPDX-License-Identifier: MIT
#include "evidence/studies/statistic_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace wholehand {
namespace {

struct StatisticWords {
  const char *statistic, *words;
};

constexpr std::array<StatisticWords, 16> WHOLE_WORDS{{
    {"correlation_before_change", "r of grip before and its change"},
    {"correlation_increase_change", "r of normal increase and grip change"},
    {"anova_f", "normal increase between vessels, F"},
    {"anova_p", "normal increase between vessels, p"},
    {"anova_share", "normal increase, share between vessels"},
    {"ordered_as_paper", "vessels in the paper's order (1: yes)"},
    {"maintained_over_8N_share", "maintained with over 8 N at first"},
    {"maintained_under_1N_share", "maintained with under 1 N at first"},
    {"rising_share", "grip rises over the tilt"},
    {"falling_share", "grip does not rise over the tilt"},
    {"tilted_share", "tilted by 30 degrees or more"},
    {"analyzed_share", "of these, with a type"},
    {"saturated_share", "of these, at F_max"},
    {"people_with_grasps_share", "people who grasped"},
    {"whole_sessions_share", "sessions that ended by themselves"},
    {"lost_share", "lost grips"},
}};

// What a mean's or deviation's name begins with, and its unit.
struct MeasureUnit {
  const char *start, *unit;
};
constexpr std::array<MeasureUnit, 7> UNITS{{{"response_time", "s"},
                                            {"tilt_time", "s"},
                                            {"maintained_time", "s"},
                                            {"time_", "s"},
                                            {"grip_", "N"},
                                            {"normal_increase", "N"},
                                            {"largest_opening", "m"}}};

bool is_share(const std::string& statistic) { return statistic.ends_with("_share"); }

std::string without_underscores(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

std::string statistic_words(const std::string& statistic) {
  for (const StatisticWords& known : WHOLE_WORDS)
    if (statistic == known.statistic) return known.words;
  const std::string unit = statistic_unit(statistic);
  for (const char* end : {"_mean", "_deviation"}) {
    if (unit == "1" || !statistic.ends_with(end)) continue;
    const std::string measure = statistic.substr(0, statistic.size() - std::string(end).size());
    return fmt::format("{}, {} ({})", without_underscores(measure), end + 1, unit);
  }
  // the share of a type of the paper: "G1"
  if (statistic.size() == 8 && statistic[0] == 'g' && is_share(statistic)) return fmt::format("type G{}", statistic[1]);
  return without_underscores(statistic);
}

std::string statistic_unit(const std::string& statistic) {
  if (statistic.starts_with("coefficient_")) return "N-1";
  if (!statistic.ends_with("_mean") && !statistic.ends_with("_deviation")) return "1";
  const auto found = std::find_if(UNITS.begin(), UNITS.end(), [&](const MeasureUnit& u) { return statistic.starts_with(u.start); });
  return found == UNITS.end() ? "1" : found->unit;
}

std::string statistic_value(const std::string& statistic, double value) {
  if (!std::isfinite(value)) return "-";
  if (is_share(statistic)) return fmt::format("{:.1f} %", 100 * value);
  // a probability may be tiny, and the F of identical people has no limit
  if (value != 0 && (std::abs(value) < 1e-3 || std::abs(value) >= 1e5)) return fmt::format("{:.1e}", value);
  return fmt::format("{:.3f}", value);
}

std::string interval_words(const StudyRow& row) {
  if (!(row.interval.low <= row.interval.high)) return "-";
  return statistic_value(row.statistic, row.interval.low) + " to " + statistic_value(row.statistic, row.interval.high);
}

std::string inside_words(const StudyRow& row) {
  const std::optional<bool> inside = row.inside();
  return inside ? (*inside ? "yes" : "no") : "-";
}

std::string inside_sentence(std::span<const StudyRow> rows) {
  const InsideCount count = count_inside(rows);
  if (count.of == 0) return "No statistic has both an interval and a value of the paper.";
  return fmt::format("{} of {} statistics of the paper are inside their intervals.", count.inside, count.of);
}

}  // namespace wholehand

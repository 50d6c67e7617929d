// SPDX-License-Identifier: MIT
#include "trials/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wholehand {
namespace {

std::string plain_interval(double value, const Interval& interval) {
  if (std::isnan(value)) return "not measured";
  return std::isnan(interval.low) ? fmt::format("{:.2f}", value)
                                  : fmt::format("{:.2f} ({:.2f} to {:.2f})", value, interval.low, interval.high);
}

}  // namespace

std::string trials_summary(const Scene& scene, const TrialOptions& options, const TrialAnalysis& analysis) {
  std::string text = "\ngrips that hold in every trial:\n";
  std::size_t widest = 0;
  for (const VesselData& vessel : scene.vessels) widest = std::max(widest, vessel.name.size());
  for (const WholeGrips& row : analysis.grips) {
    text += fmt::format("  {:{}}  {}: {} of {}", scene.vessels[row.vessel].name, widest, group_text(row.group, options.settings),
                        row.held.yes, row.held.of);
    if (row.discarded > 0) text += fmt::format(", {} more discarded", row.discarded);
    text += '\n';
  }
  for (const TrialGroup& group : analysis.groups) {
    const bool is_measured = std::any_of(analysis.predictors.begin(), analysis.predictors.end(),
                                         [&](const PredictorRow& row) { return row.group == group && !std::isnan(row.auc.auc); });
    if (!is_measured) continue;  // all grips held, or none
    text += fmt::format("AUC against success, {}:\n", group_text(group, options.settings));
    for (const PredictorRow& row : analysis.predictors)
      if (row.group == group)
        text += fmt::format("  {:<26} {}\n", TRIAL_PREDICTOR_NAMES[row.predictor], plain_interval(row.auc.auc, row.auc.interval));
  }
  for (const TrialBar& bar : analysis.bars)
    text += fmt::format("{}: {}, at least {:.2f} wanted: {}\n", bar.what, plain_interval(bar.found, bar.interval), bar.wanted,
                        std::isnan(bar.found) ? "not measured"
                        : bar.is_met()        ? "met"
                                              : "missed");
  return text;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "evidence/trials/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/readable.h"

namespace wholehand {
namespace {

std::string plain_interval(double value, const Interval& interval) {
  if (std::isnan(value)) return "not measured";
  return std::isnan(interval.low) ? fmt::format("{:.2f}", value)
                                  : fmt::format("{:.2f} ({:.2f} to {:.2f})", value, interval.low, interval.high);
}

// The same grips at each mass and friction, beside each other.
std::string pushed_lines(const Scene& scene, const TrialOptions& options, const TrialAnalysis& analysis, std::size_t widest) {
  if (analysis.pushed.empty()) return "";
  std::string text = "\ngrips that hold in all six directions, at the largest fill";
  const char* before = ": ";
  for (const TrialMaterial& material : options.settings.materials) {
    text += before + material_text(material);
    before = " | ";
  }
  text += '\n';
  for (const PushedGrips& row : analysis.pushed) {
    text += fmt::format("  {:{}}  {}:", scene.vessels[row.vessel].name, widest, sample_text(row.sample));
    before = " ";
    for (const WholeGrips& one : row.by_material) {
      text += fmt::format("{}{} of {}", before, one.held.yes, one.held.of);
      if (one.discarded > 0) text += fmt::format(" ({} more discarded)", one.discarded);
      before = " | ";
    }
    text += '\n';
  }
  return text;
}

// What became of the deviations, and what predicts it.
std::string scatter_lines(const Scene& scene, const TrialOptions& options, const ScatterAnalysis& scatter, std::size_t widest) {
  std::string text = fmt::format("grips at {} of [robust] each, held in every trial:\n", counted(options.scatter, "deviation"));
  for (const ScatterRow& row : scatter.rows) {
    const std::string failures = failures_text(row.count);
    text += fmt::format("  {:{}}  {}: {} of {}{}\n", scene.vessels[row.vessel].name, widest, scatter_row_text(row), row.held.yes,
                        readable_number(row.held.of), failures.empty() ? "" : "; " + failures);
  }
  for (const ScatterPredictors& row : scatter.predictors) {
    if (std::isnan(row.aucs[0].auc)) continue;  // all held, or none
    text += fmt::format("AUC against being held at a deviation, {}:\n", sample_text(row.sample));
    for (std::size_t k = 0; k < SCATTER_PREDICTORS; ++k)
      text += fmt::format("  {:<30} {}\n", SCATTER_PREDICTOR_NAMES[k], plain_interval(row.aucs[k].auc, row.aucs[k].interval));
    text += fmt::format("  {:<30} {}\n", "robust rank less score",
                        plain_interval(row.robust_gain.difference, row.robust_gain.interval));
  }
  return text;
}

std::string weights_lines(const std::optional<WeightTrial>& weights, const char* by) {
  if (!weights || !weights->fit.is_fitted) return "";
  const AucDifference &more = weights->all.difference, &tried = weights->tried.difference;
  std::string text = fmt::format(
      "weights fitted to {}half of the grips change the AUC on the other half, where discarded ones are failures, by {}: {}\n", by,
      plain_interval(more.difference, more.interval),
      weights->is_better() ? "better than the scene's weights" : "not better than the scene's weights");
  if (!std::isnan(tried.difference))
    text += fmt::format("  without the discarded ones they change it by {}\n", plain_interval(tried.difference, tried.interval));
  return text;
}

}  // namespace

std::string trials_summary(const Scene& scene, const TrialOptions& options, const TrialAnalysis& analysis) {
  std::string text = options.fill_tilt ? "\ngrips that hold in every trial of fill-tilt:\n" : "";
  std::size_t widest = 0;
  for (const VesselData& vessel : scene.vessels) widest = std::max(widest, vessel.name.size());
  for (const WholeGrips& row : analysis.grips) {
    if (row.group.protocol != TrialProtocol::fill_tilt) continue;
    text += fmt::format("  {:{}}  {}: {} of {}", scene.vessels[row.vessel].name, widest, group_text(row.group, options.settings),
                        row.held.yes, row.held.of);
    if (row.discarded > 0) text += fmt::format(", {} more discarded", row.discarded);
    if (row.slipped.yes > 0) text += fmt::format("; {} of {} held trials slipped", row.slipped.yes, row.slipped.of);
    text += '\n';
  }
  text += pushed_lines(scene, options, analysis, widest);
  for (const TrialGroup& group : analysis.groups) {
    const bool is_measured = std::any_of(analysis.predictors.begin(), analysis.predictors.end(),
                                         [&](const PredictorRow& row) { return row.group == group && !std::isnan(row.auc.auc); });
    if (!is_measured) continue;  // all grips held, or none
    text += fmt::format("AUC against success, {}:\n", group_text(group, options.settings));
    for (const PredictorRow& row : analysis.predictors)
      if (row.group == group)
        text += fmt::format("  {:<26} {}\n", TRIAL_PREDICTOR_NAMES[row.predictor], plain_interval(row.auc.auc, row.auc.interval));
  }
  text += weights_lines(analysis.weights, "");
  if (analysis.scatter) {
    text += scatter_lines(scene, options, *analysis.scatter, widest);
    text += weights_lines(analysis.scatter->weights, "the deviations of ");
  }
  for (const TrialBar& bar : analysis.bars) {
    const std::string found =
        std::isnan(bar.found)
            ? bar.verdict()
            : fmt::format("{}, at least {:.2f} wanted: {}", plain_interval(bar.found, bar.interval), bar.wanted, bar.verdict());
    text += fmt::format("{}: {} ({})\n", bar.what, found, bar.how);
  }
  return text;
}

}  // namespace wholehand

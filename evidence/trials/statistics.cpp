// SPDX-License-Identifier: MIT
#include "evidence/trials/statistics.h"

#include <algorithm>
#include <cmath>

#include "base/statistics/resample.h"

namespace wholehand {
namespace {

constexpr double EFFORT_EDGES[] = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.75, 1, 1.5, 2, 4};

// Predictions in the order of their values, so that a resample is one pass with a weight for each grip.
class RankedPredictions {
 public:
  explicit RankedPredictions(std::span<const Prediction> predictions) : ranked_(predictions.begin(), predictions.end()) {
    std::stable_sort(ranked_.begin(), ranked_.end(), [](const Prediction& a, const Prediction& b) { return a.value < b.value; });
  }

  // NaN where there is no success or no failure. A grip beyond `weights` does not occur.
  double auc(const std::vector<double>& weights) const {
    double pairs = 0, failures = 0, successes = 0;
    for (std::size_t k = 0; k < ranked_.size();) {
      double won = 0, lost = 0;
      const double value = ranked_[k].value;
      for (; k < ranked_.size() && ranked_[k].value == value; ++k) (ranked_[k].success ? won : lost) += weights[ranked_[k].grip];
      pairs += won * (failures + 0.5 * lost);
      failures += lost;
      successes += won;
    }
    return pairs / (failures * successes);
  }

 private:
  std::vector<Prediction> ranked_;
};

std::size_t grips_in(std::span<const Prediction> predictions) {
  std::size_t grips = 0;
  for (const Prediction& one : predictions) grips = std::max(grips, one.grip + 1);
  return grips;
}

// The numbers that occur: a resample draws from these alone.
std::vector<std::size_t> occurring_grips(std::span<const Prediction> predictions) {
  std::vector<std::size_t> grips;
  for (const Prediction& one : predictions) grips.push_back(one.grip);
  std::sort(grips.begin(), grips.end());
  grips.erase(std::unique(grips.begin(), grips.end()), grips.end());
  return grips;
}

// `measure` of the weights that each resample gives the grips; NaN leaves a resample out.
template <class Measure>
Interval bootstrap_interval(const std::vector<std::size_t>& occurring, std::size_t grips, std::uint64_t seed,
                            const Measure& measure) {
  const auto of_resample = [&, weights = std::vector<double>(grips)](std::span<const std::size_t> members) mutable {
    std::fill(weights.begin(), weights.end(), 0.0);
    for (const std::size_t member : members) weights[occurring[member]] += 1;
    return measure(weights);
  };
  const std::vector<double> found = resampled_values(occurring.size(), occurring.size(), RESAMPLES, seed, of_resample);
  return 2 * found.size() < RESAMPLES ? Interval{} : percentile_interval(found);
}

}  // namespace

double auc_of(std::span<const Prediction> predictions) {
  return RankedPredictions(predictions).auc(std::vector<double>(grips_in(predictions), 1.0));
}

std::vector<RocPoint> roc_curve(std::span<const Prediction> predictions) {
  std::vector<Prediction> falling(predictions.begin(), predictions.end());
  std::stable_sort(falling.begin(), falling.end(), [](const Prediction& a, const Prediction& b) { return a.value > b.value; });
  const auto successes =
      static_cast<double>(std::count_if(falling.begin(), falling.end(), [](const Prediction& one) { return one.success; }));
  const double failures = static_cast<double>(falling.size()) - successes;
  if (successes == 0 || failures == 0) return {};
  std::vector<RocPoint> curve{{0, 0}};
  double won = 0, lost = 0;
  for (std::size_t k = 0; k < falling.size();) {
    const double value = falling[k].value;
    for (; k < falling.size() && falling[k].value == value; ++k) (falling[k].success ? won : lost) += 1;
    curve.push_back({lost / failures, won / successes});
  }
  return curve;
}

Auc auc_with_interval(std::span<const Prediction> predictions, std::uint64_t seed) {
  Auc answer;
  for (const Prediction& one : predictions) ++(one.success ? answer.successes : answer.failures);
  if (answer.successes == 0 || answer.failures == 0) return answer;
  const RankedPredictions ranked(predictions);
  const std::size_t grips = grips_in(predictions);
  answer.auc = ranked.auc(std::vector<double>(grips, 1.0));
  answer.interval = bootstrap_interval(occurring_grips(predictions), grips, seed,
                                       [&](const std::vector<double>& weights) { return ranked.auc(weights); });
  return answer;
}

AucDifference auc_difference(std::span<const Prediction> a, std::span<const Prediction> b, std::uint64_t seed) {
  if (a.empty()) return {};
  const RankedPredictions first(a), second(b);
  const std::size_t grips = grips_in(a);
  const auto difference = [&](const std::vector<double>& weights) { return first.auc(weights) - second.auc(weights); };
  AucDifference answer;
  answer.difference = difference(std::vector<double>(grips, 1.0));
  if (!std::isnan(answer.difference)) answer.interval = bootstrap_interval(occurring_grips(a), grips, seed, difference);
  return answer;
}

std::vector<CalibrationBin> calibration_bins(std::span<const EffortTrial> trials) {
  std::vector<CalibrationBin> bins;
  for (std::size_t k = 0; k < std::size(EFFORT_EDGES); ++k) {
    const bool is_last = k + 1 == std::size(EFFORT_EDGES);
    CalibrationBin bin{EFFORT_EDGES[k], is_last ? HUGE_VAL : EFFORT_EDGES[k + 1], std::numeric_limits<double>::quiet_NaN(), {}};
    double sum = 0;
    std::size_t held = 0, all = 0, finite = 0;
    for (const EffortTrial& trial : trials) {
      if (!(trial.effort >= bin.from) || (!is_last && !(trial.effort < bin.to))) continue;
      ++all;
      held += trial.held ? 1 : 0;
      if (!std::isfinite(trial.effort)) continue;
      ++finite;
      sum += trial.effort;
    }
    if (finite > 0) bin.mean = sum / static_cast<double>(finite);
    bin.held = share_of(held, all);
    bins.push_back(bin);
  }
  return bins;
}

Confusion confusion_of(std::span<const EffortTrial> trials) {
  Confusion counts;
  for (const EffortTrial& trial : trials) {
    const bool said = trial.effort <= 1;
    ++(trial.held ? (said ? counts.held_as_said : counts.held_though_not) : (said ? counts.lost_though_said : counts.lost_as_said));
  }
  return counts;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// How well a number predicts whether a grip holds: shares, ROC curves, calibration, and their intervals of 95 %.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/statistics/interval.h"

namespace wholehand {

// What was predicted of one thing, and what came of it. A larger value is a prediction that it rather succeeds; infinite values are
// allowed, NaN is not. `grip`: things of one grip share their number, from 0, and are resampled together.
struct Prediction {
  double value = 0;
  bool success = false;
  std::size_t grip = 0;
};

// The area under the ROC curve: how often a success has a larger value than a failure, where equal values count half (Mann and
// Whitney's U over the number of pairs). NaN where there is no success or no failure.
double auc_of(std::span<const Prediction> predictions);

// Both shares of what has at least some value: of the failures, and of the successes. From (0, 0) to (1, 1), a point for each value
// that occurs. Empty where there is no success or no failure.
struct RocPoint {
  double failures = 0, successes = 0;
};
std::vector<RocPoint> roc_curve(std::span<const Prediction> predictions);

constexpr int RESAMPLES = 1000;  // of a bootstrap

// A bootstrap by grips: a resample draws as many grips as there are, with replacement, and takes all that belongs to each. A trial
// of a grip says little that another one of it has not said, so trials are not drawn by themselves. The interval is from the 2.5th
// to the 97.5th percentile. Resamples without a success or without a failure are left out; NaN where more than half of them are.
// The same on any machine.
struct Auc {
  double auc = std::numeric_limits<double>::quiet_NaN();
  Interval interval;
  std::size_t successes = 0, failures = 0;
};
Auc auc_with_interval(std::span<const Prediction> predictions, std::uint64_t seed);

// AUC of `a` less AUC of `b`, of the same things in the same order: both by the same resamples.
struct AucDifference {
  double difference = std::numeric_limits<double>::quiet_NaN();
  Interval interval;
};
AucDifference auc_difference(std::span<const Prediction> a, std::span<const Prediction> b, std::uint64_t seed);

// ---- efforts ----

// One trial: what effort was predicted, and whether it held.
struct EffortTrial {
  double effort = 0;  // may be infinite
  bool held = false;
};

// Trials with an effort in [from, to); the last bin has all from `from` on, the infinite ones too.
struct CalibrationBin {
  double from = 0, to = 0;
  double mean = 0;  // effort of the finite ones; NaN without any
  Share held;
};
std::vector<CalibrationBin> calibration_bins(std::span<const EffortTrial> trials);

// Outcomes of trials against the prediction that effort <= 1 holds.
struct Confusion {
  std::size_t held_as_said = 0, lost_though_said = 0;  // effort <= 1
  std::size_t held_though_not = 0, lost_as_said = 0;   // effort > 1
  std::size_t all() const { return held_as_said + lost_though_said + held_though_not + lost_as_said; }
  Share right() const { return share_of(held_as_said + lost_as_said, all()); }
};
Confusion confusion_of(std::span<const EffortTrial> trials);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// How well a number predicts whether a grip holds: shares, ROC curves, calibration, and their 95 % intervals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/statistics/interval.h"

namespace wholehand {

// The prediction for one thing, and its outcome. A larger value predicts success; infinite values are allowed, NaN is not. `grip`: things of one grip
// share their number, from 0, and are resampled together.
struct Prediction {
  double value = 0;
  bool success = false;
  std::size_t grip = 0;
};

// The area under the ROC curve: how often a success has a larger value than a failure, with ties counting half (Mann and Whitney's U over the number
// of pairs). NaN without a success or a failure.
double auc_of(std::span<const Prediction> predictions);

// The shares of failures and of successes with at least some value: from (0, 0) to (1, 1), a point for each value that occurs. Empty without a
// success or a failure.
struct RocPoint {
  double failures = 0, successes = 0;
};
std::vector<RocPoint> roc_curve(std::span<const Prediction> predictions);

constexpr int RESAMPLES = 1000;  // of a bootstrap

// A bootstrap by grips: a resample draws as many grips as there are, with replacement, and takes everything that belongs to each, because trials of
// one grip are not independent. The interval is from the 2.5th to the 97.5th percentile. Resamples without a success or a failure are left out; NaN
// if these are more than half. The same on any machine.
struct Auc {
  double auc = std::numeric_limits<double>::quiet_NaN();
  Interval interval;
  std::size_t successes = 0, failures = 0;
};
Auc auc_with_interval(std::span<const Prediction> predictions, std::uint64_t seed);

// AUC of `a` minus AUC of `b`, for the same things in the same order, with the same resamples.
struct AucDifference {
  double difference = std::numeric_limits<double>::quiet_NaN();
  Interval interval;
};
AucDifference auc_difference(std::span<const Prediction> a, std::span<const Prediction> b, std::uint64_t seed);

// ---- efforts ----

// One trial: its predicted effort, and whether it held.
struct EffortTrial {
  double effort = 0;  // may be infinite
  bool held = false;
};

// Trials with an effort in [from, to); the last bin has everything from `from` on, including infinite ones.
struct CalibrationBin {
  double from = 0, to = 0;
  double mean = 0;  // effort of the finite ones; NaN if there are none
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

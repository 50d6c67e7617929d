// SPDX-License-Identifier: MIT
// Weights of the score that trials would choose: a logistic regression of success on the score's terms.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evidence/trials/statistics.h"

namespace wholehand {

constexpr std::size_t SCORE_TERM_COUNT = 6;

// Each weight is at least this share of their sum. A scene without tilts has no terms of force and hold; a fit that gave everything to these two
// would leave nothing to rank its grips by.
constexpr double LEAST_WEIGHT = 0.02;

// A grip with the terms of its score, each in [0, 1], and its outcome.
struct TermedGrip {
  std::array<double, SCORE_TERM_COUNT> terms{};
  bool success = false;    // it was tried, and held
  bool discarded = false;  // it could not be tried, which is no success
};

// log(p / (1 - p)) = intercept + sum of coefficient x term, at the largest likelihood for which each coefficient is at least LEAST_WEIGHT of their
// sum (so none is negative: no term of a score may lower it). A term that does not vary gets the least. `has_ridge`: as in a LogisticModel
// (base/statistics/logistic.h), for the amounts by which the coefficients exceed the least.
struct LogisticFit {
  std::array<double, SCORE_TERM_COUNT> coefficients{};
  std::array<bool, SCORE_TERM_COUNT> is_least{};  // at the least share
  double intercept = 0;
  bool is_fitted = false;  // as of a LogisticModel
  bool has_ridge = false;
};
LogisticFit fit_logistic(std::span<const TermedGrip> grips);

// The coefficients as weights of a score, with the sum 1. All 0 if no term separates successes from failures.
std::array<double, SCORE_TERM_COUNT> weights_of(const LogisticFit& fit);

// AUCs of the fitted and of the given weights, and the first minus the second.
struct WeightContest {
  Auc fitted, given;
  AucDifference difference;
};

// Fitted on one half of the grips, and judged on the other half.
struct WeightTrial {
  LogisticFit fit;
  std::array<double, SCORE_TERM_COUNT> weights{};
  std::size_t fitted_on = 0, judged_on = 0;  // grips, including the discarded ones
  WeightContest all;                         // discarded grips count as failures: a list of the best should have none
  WeightContest tried;                       // without the discarded ones
  bool is_better() const { return all.difference.interval.low > 0; }
};
// The seed draws the halves among successes, failures and discarded grips alike. `each` consecutive outcomes of a grip come into the same half,
// decided by the first one, and into the same resamples.
WeightTrial try_weights(std::span<const TermedGrip> grips, const std::array<double, SCORE_TERM_COUNT>& given, std::uint64_t seed,
                        std::size_t each = 1);

}  // namespace wholehand

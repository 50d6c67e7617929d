// SPDX-License-Identifier: MIT
// Weights of the score that trials would choose: a logistic regression of success on the score's terms.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "trials/statistics.h"

namespace wholehand {

constexpr std::size_t SCORE_TERM_COUNT = 6;

// A grip with the terms of its score, each in [0, 1], and whether it held.
struct TermedGrip {
  std::array<double, SCORE_TERM_COUNT> terms{};
  bool success = false;
};

// log(p / (1 - p)) = intercept + sum of coefficient x term, by Newton's steps (iteratively reweighted least squares). A term that
// does not vary has the coefficient 0. Where successes and failures can be separated, or the terms depend on one another, the
// largest likelihood has no finite place: then half a square of each coefficient, in units of its term's deviation, is taken off
// the log-likelihood (a ridge), and `has_ridge` says so.
struct LogisticFit {
  std::array<double, SCORE_TERM_COUNT> coefficients{};
  double intercept = 0;
  bool is_fitted = false;  // false: there is no success, or no failure
  bool has_ridge = false;
};
LogisticFit fit_logistic(std::span<const TermedGrip> grips);

// The coefficients as weights of a score: negative ones are 0, for no term of a score may lower it, and the sum is 1. All 0 where
// none is positive.
std::array<double, SCORE_TERM_COUNT> weights_of(const LogisticFit& fit);

// Fitted on one half of the grips, and judged on the other half.
struct WeightTrial {
  LogisticFit fit;
  std::array<double, SCORE_TERM_COUNT> weights{};
  std::array<bool, SCORE_TERM_COUNT> is_clamped{};  // its coefficient was negative
  std::size_t fitted_on = 0, judged_on = 0;         // grips
  Auc fitted, given;                                // on the other half: of these weights, and of the given ones
  AucDifference difference;                         // of fitted less given
  bool is_better() const { return difference.interval.low > 0; }
};
// The halves are drawn by the seed, among successes and failures alike.
WeightTrial try_weights(std::span<const TermedGrip> grips, const std::array<double, SCORE_TERM_COUNT>& given, std::uint64_t seed);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// How terms change the odds of success.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/statistics/interval.h"

namespace wholehand {

// log(p / (1 - p)) = intercept + sum of coefficient x term, by Newton's steps (iteratively reweighted least squares). A term that does not vary has
// the coefficient 0. If successes and failures can be separated, or terms depend on one another, the likelihood has no finite maximum. Then the fit
// subtracts half the square of each coefficient, in units of its term's deviation, from the log-likelihood (a ridge), and sets `has_ridge`.
struct LogisticModel {
  std::vector<double> coefficients;
  std::vector<double> errors;  // standard errors from the curvature; NaN with a ridge or bounds, or for a term that does not vary
  double intercept = 0;
  // False: there is no success or no failure, or Newton's steps did not converge even with the ridge; the coefficients are 0.
  bool is_fitted = false;
  bool has_ridge = false;  // also true if the fit did not converge with it

  Interval interval(std::size_t term) const {
    return {coefficients[term] - NORMAL_95 * errors[term], coefficients[term] + NORMAL_95 * errors[term]};
  }
};

// With bounds of 0, Newton's steps move only coefficients above them (an active set). The likelihood is concave, so its maximum within the bounds is
// the only one.
enum class Coefficients { any, not_negative };

// `terms`: `count` numbers for each entry of `success`, one row after the other.
LogisticModel fit_logistic_model(std::span<const double> terms, std::size_t count, std::span<const char> success,
                                 Coefficients allowed = Coefficients::any);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// How terms change the odds of a success.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/statistics/interval.h"

namespace wholehand {

// log(p / (1 - p)) = intercept + sum of coefficient x term, by Newton's steps (iteratively reweighted least squares). A term that
// does not vary has the coefficient 0. Where successes and failures can be separated, or the terms depend on one another, the
// largest likelihood has no finite place: then half a square of each coefficient, in units of its term's deviation, is subtracted from
// the log-likelihood (a ridge), and `has_ridge` says so.
struct LogisticModel {
  std::vector<double> coefficients;
  std::vector<double> errors;  // standard errors, by the curvature; NaN with a ridge, with bounds, and of a term that does not vary
  double intercept = 0;
  // False: there is no success, or no failure, or Newton's steps did not settle even with the ridge; the coefficients are 0.
  bool is_fitted = false;
  bool has_ridge = false;  // also of a fit that did not settle with it

  Interval interval(std::size_t term) const {
    return {coefficients[term] - NORMAL_95 * errors[term], coefficients[term] + NORMAL_95 * errors[term]};
  }
};

// With bounds of 0 Newton's steps are of those coefficients that are above them (an active set); the likelihood is concave, so its largest
// place within the bounds is one.
enum class Coefficients { any, not_negative };

// `terms`: `count` numbers for each entry of `success`, one row after the other.
LogisticModel fit_logistic_model(std::span<const double> terms, std::size_t count, std::span<const char> success,
                                 Coefficients allowed = Coefficients::any);

}  // namespace wholehand

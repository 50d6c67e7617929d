// SPDX-License-Identifier: MIT
#include "base/statistics/logistic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics/moments.h"

namespace wholehand {
namespace {

constexpr int MOST_STEPS = 200, MOST_HALVINGS = 40;
constexpr double SETTLED = 1e-9;           // of the longest step of an unknown
constexpr double ROUNDING = 1e-12;         // of the log-likelihood
constexpr double WANTED_SLOPE = 1e-6;      // of the log-likelihood: a smaller one is rounding
constexpr double SEPARATED = 20;           // without a ridge, a coefficient beyond this, per deviation of its term, grows forever
constexpr double DEPENDENT_PIVOT = 1e-10;  // share of a diagonal entry; a smaller pivot means dependent unknowns

using Unknowns = std::vector<double>;  // of the terms, and the intercept last
using Normal = std::vector<Unknowns>;

// Solves a symmetric positive system, given its lower half, by Cholesky's method: `b` becomes the answer. False if the system is not, or barely,
// positive.
bool solve_positive(Normal a, Unknowns& b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double whole = a[i][i];
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i == j && !(sum > DEPENDENT_PIVOT * whole)) return false;
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

// A term's mean and scale over the rows; scale 0: it does not vary.
struct TermScale {
  double mean = 0, scale = 0;
};

// Terms in units of their deviations, and a 1 for the intercept.
struct Rows {
  std::vector<TermScale> scales;
  std::vector<Unknowns> values;
  std::span<const char> success;

  std::size_t terms() const { return scales.size(); }
};

TermScale scale_of(std::span<const double> column) {
  TermScale scale;
  scale.mean = mean_of(column);
  double square = 0;
  for (const double value : column) square += (value - scale.mean) * (value - scale.mean) / static_cast<double>(column.size());
  // by the values themselves: the deviation of a constant is the rounding of its mean
  if (varies(column)) scale.scale = 1 / std::sqrt(square);
  return scale;
}

Rows rows_of(std::span<const double> terms, std::size_t count, std::span<const char> success) {
  Rows rows{{}, {}, success};
  std::vector<double> column(success.size());
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < success.size(); ++i) column[i] = terms[i * count + k];
    rows.scales.push_back(scale_of(column));
  }
  for (std::size_t i = 0; i < success.size(); ++i) {
    Unknowns x(count + 1, 1.0);
    for (std::size_t k = 0; k < count; ++k) x[k] = (terms[i * count + k] - rows.scales[k].mean) * rows.scales[k].scale;
    rows.values.push_back(std::move(x));
  }
  return rows;
}

// The log-likelihood minus its ridge, its slope, and its negated curvature (the lower half), in units of the terms' deviations.
struct Likelihood {
  double value = 0;
  Unknowns slope;
  Normal curvature;
};

Likelihood likelihood_at(const Rows& rows, const Unknowns& beta, double ridge) {
  const std::size_t n = beta.size();
  Likelihood found{0, Unknowns(n, 0.0), Normal(n, Unknowns(n, 0.0))};
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    const Unknowns& x = rows.values[i];
    double odds = 0;  // their logarithm
    for (std::size_t k = 0; k < n; ++k) odds += beta[k] * x[k];
    const double p = 1 / (1 + std::exp(-odds));
    found.value -=
        std::max(0.0, rows.success[i] != 0 ? -odds : odds) + std::log1p(std::exp(-std::abs(odds)));  // without an overflow
    for (std::size_t k = 0; k < n; ++k) {
      found.slope[k] += ((rows.success[i] != 0 ? 1 : 0) - p) * x[k];
      for (std::size_t j = 0; j <= k; ++j) found.curvature[k][j] += p * (1 - p) * x[k] * x[j];
    }
  }
  for (std::size_t k = 0; k < rows.terms(); ++k) {
    found.value -= ridge * beta[k] * beta[k] / 2;
    found.slope[k] -= ridge * beta[k];
    found.curvature[k][k] += rows.scales[k].scale == 0 ? 1 : ridge;  // a term that does not vary stays at 0
  }
  return found;
}

// Which unknowns may move.
using Free = std::vector<char>;

// Newton's step of the free unknowns; 0 for the others. False if they depend on one another.
bool newton_step(Likelihood here, const Free& is_free, Unknowns& step) {
  for (std::size_t k = 0; k < is_free.size(); ++k) {
    if (!is_free[k]) here.slope[k] = 0;
    for (std::size_t j = 0; j <= k; ++j)
      if (!is_free[k] || !is_free[j]) here.curvature[k][j] = k == j ? 1 : 0;
  }
  step = here.slope;
  return solve_positive(here.curvature, step);
}

// Takes the step, halved until the likelihood does not fall. With bounds, the step ends at the first coefficient that reaches 0, which stays there
// and is no longer free. Returns whether there is one.
bool take_step(const Rows& rows, double ridge, bool is_bounded, const Unknowns& step, double value, Unknowns& beta, Free& is_free) {
  double share = 1;
  std::size_t bound = beta.size();
  for (std::size_t k = 0; is_bounded && k < rows.terms(); ++k)
    if (beta[k] + share * step[k] < 0) share = -beta[k] / step[k], bound = k;
  for (int halvings = 0; halvings < MOST_HALVINGS; ++halvings, share /= 2, bound = beta.size()) {
    Unknowns next = beta;
    for (std::size_t k = 0; k < beta.size(); ++k) next[k] += share * step[k];
    if (likelihood_at(rows, next, ridge).value < value - ROUNDING * std::abs(value)) continue;
    beta = next;
    if (bound == beta.size()) return false;
    beta[bound] = 0;
    is_free[bound] = false;
    return true;
  }
  return false;
}

// Frees the coefficient at 0 whose growth raises the likelihood most. False: none.
bool free_one(const Rows& rows, const Likelihood& here, Free& is_free) {
  std::size_t most = rows.terms();
  for (std::size_t k = 0; k < rows.terms(); ++k) {
    if (is_free[k] || rows.scales[k].scale == 0 || here.slope[k] < WANTED_SLOPE) continue;
    if (most == rows.terms() || here.slope[k] > here.slope[most]) most = k;
  }
  if (most < rows.terms()) is_free[most] = true;
  return most < rows.terms();
}

// Finds the largest likelihood. False if the steps do not converge.
bool climb(const Rows& rows, double ridge, bool is_bounded, Unknowns& beta) {
  beta.assign(rows.terms() + 1, 0.0);
  Free is_free(beta.size(), true);
  Unknowns step;
  // bounds would hide that terms depend on one another: the first of two equal ones would get everything
  if (!newton_step(likelihood_at(rows, beta, ridge), is_free, step)) return false;
  if (is_bounded) std::fill(is_free.begin(), is_free.end() - 1, false);
  for (int tries = 0; tries < MOST_STEPS; ++tries) {
    const Likelihood here = likelihood_at(rows, beta, ridge);
    if (!newton_step(here, is_free, step)) return false;
    const Unknowns before = beta;
    const bool is_at_bound = take_step(rows, ridge, is_bounded, step, here.value, beta, is_free);
    double longest = 0;
    for (std::size_t k = 0; k < beta.size(); ++k) {
      longest = std::max(longest, std::abs(beta[k] - before[k]));
      if (ridge == 0 && k < rows.terms() && std::abs(beta[k]) > SEPARATED) return false;
    }
    if (longest < SETTLED && !is_at_bound && !(is_bounded && free_one(rows, likelihood_at(rows, beta, ridge), is_free)))
      return true;
  }
  return false;
}

// The root of a diagonal place of the curvature's inverse.
double error_of(const Normal& normal, std::size_t term) {
  Unknowns unit(normal.size(), 0.0);
  unit[term] = 1;
  return solve_positive(normal, unit) ? std::sqrt(unit[term]) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

LogisticModel fit_logistic_model(std::span<const double> terms, std::size_t count, std::span<const char> success,
                                 Coefficients allowed) {
  LogisticModel model;
  model.coefficients.assign(count, 0.0);
  model.errors.assign(count, std::numeric_limits<double>::quiet_NaN());
  const auto successes = static_cast<std::size_t>(std::count_if(success.begin(), success.end(), [](char one) { return one != 0; }));
  if (successes == 0 || successes == success.size()) return model;
  const Rows rows = rows_of(terms, count, success);
  const bool is_bounded = allowed == Coefficients::not_negative;
  Unknowns beta;
  if (!climb(rows, 0, is_bounded, beta)) {
    model.has_ridge = true;
    if (!climb(rows, 1, is_bounded, beta)) return model;
  }
  model.is_fitted = true;
  model.intercept = beta[count];
  const Normal normal = likelihood_at(rows, beta, 0).curvature;
  for (std::size_t k = 0; k < count; ++k) {
    const TermScale& scale = rows.scales[k];
    model.coefficients[k] = beta[k] * scale.scale;
    model.intercept -= model.coefficients[k] * scale.mean;
    if (!model.has_ridge && !is_bounded && scale.scale > 0) model.errors[k] = error_of(normal, k) * scale.scale;
  }
  return model;
}

}  // namespace wholehand

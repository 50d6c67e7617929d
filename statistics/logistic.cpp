// SPDX-License-Identifier: MIT
#include "statistics/logistic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/cholesky.h"
#include "statistics/moments.h"

namespace wholehand {
namespace {

constexpr int MOST_STEPS = 100;
constexpr double SETTLED = 1e-9;  // of the longest step of an unknown
constexpr double SEPARATED = 20;  // without a ridge, a coefficient of so many, per deviation of its term, only grows on

using Unknowns = std::vector<double>;  // of the terms, and the intercept last
using Normal = std::vector<Unknowns>;

// Of a term over the rows; scale 0: it does not vary.
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

// The slope of the log-likelihood at `beta`, and its curvature (the lower half).
void look_around(const Rows& rows, const Unknowns& beta, double ridge, Unknowns& slope, Normal& normal) {
  const std::size_t n = beta.size();
  slope.assign(n, 0.0);
  normal.assign(n, Unknowns(n, 0.0));
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    const Unknowns& x = rows.values[i];
    double at = 0;
    for (std::size_t k = 0; k < n; ++k) at += beta[k] * x[k];
    const double p = 1 / (1 + std::exp(-at));
    for (std::size_t k = 0; k < n; ++k) {
      slope[k] += ((rows.success[i] != 0 ? 1 : 0) - p) * x[k];
      for (std::size_t j = 0; j <= k; ++j) normal[k][j] += p * (1 - p) * x[k] * x[j];
    }
  }
  for (std::size_t k = 0; k < rows.terms(); ++k) {
    normal[k][k] += rows.scales[k].scale == 0 ? 1 : ridge;  // a term that does not vary stays at 0
    slope[k] -= ridge * beta[k];
  }
}

// Newton's steps in units of the terms' deviations. False where they do not settle.
bool climb(const Rows& rows, double ridge, Unknowns& beta) {
  beta.assign(rows.terms() + 1, 0.0);
  Unknowns slope;
  Normal normal;
  for (int step = 0; step < MOST_STEPS; ++step) {
    look_around(rows, beta, ridge, slope, normal);
    if (!solve_positive(normal, slope)) return false;
    double longest = 0;
    for (std::size_t k = 0; k < beta.size(); ++k) {
      beta[k] += slope[k];
      longest = std::max(longest, std::abs(slope[k]));
      if (ridge == 0 && k < rows.terms() && std::abs(beta[k]) > SEPARATED) return false;
    }
    if (longest < SETTLED) return true;
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

LogisticModel fit_logistic_model(std::span<const double> terms, std::size_t count, std::span<const char> success) {
  LogisticModel model;
  model.coefficients.assign(count, 0.0);
  model.errors.assign(count, std::numeric_limits<double>::quiet_NaN());
  const auto successes = static_cast<std::size_t>(std::count_if(success.begin(), success.end(), [](char one) { return one != 0; }));
  if (successes == 0 || successes == success.size()) return model;
  const Rows rows = rows_of(terms, count, success);
  Unknowns beta;
  if (!climb(rows, 0, beta)) {
    model.has_ridge = true;
    if (!climb(rows, 1, beta)) return model;
  }
  model.is_fitted = true;
  model.intercept = beta[count];
  Unknowns slope;
  Normal normal;
  look_around(rows, beta, 0, slope, normal);
  for (std::size_t k = 0; k < count; ++k) {
    const TermScale& scale = rows.scales[k];
    model.coefficients[k] = beta[k] * scale.scale;
    model.intercept -= model.coefficients[k] * scale.mean;
    if (!model.has_ridge && scale.scale > 0) model.errors[k] = error_of(normal, k) * scale.scale;
  }
  return model;
}

}  // namespace wholehand

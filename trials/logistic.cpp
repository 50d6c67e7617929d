// SPDX-License-Identifier: MIT
#include "trials/logistic.h"

#include <algorithm>
#include <cmath>

#include "core/random_bits.h"

namespace wholehand {
namespace {

constexpr std::size_t UNKNOWNS = SCORE_TERM_COUNT + 1;  // the last is the intercept
constexpr int MOST_STEPS = 100;
constexpr double SETTLED = 1e-9;         // of the longest step of an unknown
constexpr double SEPARATED = 20;         // a coefficient of so many, per deviation of its term, only grows on
constexpr double DEPENDENT = 1e-10;      // a pivot of less than this share: the terms depend on one another
constexpr double CONSTANT_TERM = 1e-12;  // a smaller deviation is rounding

using Unknowns = std::array<double, UNKNOWNS>;
using Normal = std::array<Unknowns, UNKNOWNS>;

// Of a term over the grips; scale 0: it does not vary.
struct TermScale {
  double mean = 0, scale = 0;
};

std::array<TermScale, SCORE_TERM_COUNT> scales_of(std::span<const TermedGrip> grips) {
  std::array<TermScale, SCORE_TERM_COUNT> scales;
  const auto n = static_cast<double>(grips.size());
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    for (const TermedGrip& grip : grips) scales[k].mean += grip.terms[k] / n;
    double square = 0;
    for (const TermedGrip& grip : grips) square += (grip.terms[k] - scales[k].mean) * (grip.terms[k] - scales[k].mean) / n;
    if (std::sqrt(square) > CONSTANT_TERM) scales[k].scale = 1 / std::sqrt(square);
  }
  return scales;
}

Unknowns regressors_of(const TermedGrip& grip, const std::array<TermScale, SCORE_TERM_COUNT>& scales) {
  Unknowns x{};
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) x[k] = (grip.terms[k] - scales[k].mean) * scales[k].scale;
  x[SCORE_TERM_COUNT] = 1;
  return x;
}

// Solves a symmetric positive system by Cholesky's method. False where it is not positive, or hardly.
bool solve_normal(Normal a, Unknowns& b) {
  for (std::size_t i = 0; i < UNKNOWNS; ++i) {
    const double whole = a[i][i];
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i == j && !(sum > DEPENDENT * whole)) return false;
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
  }
  for (std::size_t i = 0; i < UNKNOWNS; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = UNKNOWNS; i-- > 0;) {
    for (std::size_t k = i + 1; k < UNKNOWNS; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

// Newton's steps in units of the terms' deviations. False where they do not settle.
bool climb(const std::vector<Unknowns>& rows, std::span<const TermedGrip> grips,
           const std::array<TermScale, SCORE_TERM_COUNT>& scales, double ridge, Unknowns& beta) {
  beta = {};
  for (int step = 0; step < MOST_STEPS; ++step) {
    Normal normal{};
    Unknowns slope{};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      double at = 0;
      for (std::size_t k = 0; k < UNKNOWNS; ++k) at += beta[k] * rows[i][k];
      const double p = 1 / (1 + std::exp(-at));
      for (std::size_t k = 0; k < UNKNOWNS; ++k) {
        slope[k] += ((grips[i].success ? 1 : 0) - p) * rows[i][k];
        for (std::size_t j = 0; j <= k; ++j) normal[k][j] += p * (1 - p) * rows[i][k] * rows[i][j];
      }
    }
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
      normal[k][k] += scales[k].scale == 0 ? 1 : ridge;  // a term that does not vary stays at 0
      slope[k] -= ridge * beta[k];
    }
    if (!solve_normal(normal, slope)) return false;
    double longest = 0;
    for (std::size_t k = 0; k < UNKNOWNS; ++k) {
      beta[k] += slope[k];
      longest = std::max(longest, std::abs(slope[k]));
      if (k < SCORE_TERM_COUNT && std::abs(beta[k]) > SEPARATED) return false;
    }
    if (longest < SETTLED) return true;
  }
  return false;
}

double weighted_score(const TermedGrip& grip, const std::array<double, SCORE_TERM_COUNT>& weights) {
  double score = 0;
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) score += weights[k] * grip.terms[k];
  return score;
}

// Every second one of the successes, and of the failures, in an order that the seed draws.
std::vector<char> drawn_half(std::span<const TermedGrip> grips, std::uint64_t seed) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < grips.size(); ++i) order.emplace_back(mixed_bits(seed + SPLIT_MIX_STEP * (i + 1)), i);
  std::sort(order.begin(), order.end());
  std::vector<char> is_first(grips.size());
  std::array<bool, 2> next{true, true};
  for (const auto& [key, i] : order) {
    bool& turn = next[grips[i].success ? 1 : 0];
    is_first[i] = turn;
    turn = !turn;
  }
  return is_first;
}

}  // namespace

LogisticFit fit_logistic(std::span<const TermedGrip> grips) {
  LogisticFit fit;
  const auto successes = std::count_if(grips.begin(), grips.end(), [](const TermedGrip& grip) { return grip.success; });
  if (successes == 0 || static_cast<std::size_t>(successes) == grips.size()) return fit;
  const auto scales = scales_of(grips);
  std::vector<Unknowns> rows;
  for (const TermedGrip& grip : grips) rows.push_back(regressors_of(grip, scales));
  Unknowns beta{};
  if (!climb(rows, grips, scales, 0, beta)) {
    fit.has_ridge = true;
    climb(rows, grips, scales, 1, beta);
  }
  fit.is_fitted = true;
  fit.intercept = beta[SCORE_TERM_COUNT];
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    fit.coefficients[k] = beta[k] * scales[k].scale;
    fit.intercept -= fit.coefficients[k] * scales[k].mean;
  }
  return fit;
}

std::array<double, SCORE_TERM_COUNT> weights_of(const LogisticFit& fit) {
  std::array<double, SCORE_TERM_COUNT> weights{};
  double sum = 0;
  for (const double coefficient : fit.coefficients) sum += std::max(0.0, coefficient);
  if (sum > 0)
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) weights[k] = std::max(0.0, fit.coefficients[k]) / sum;
  return weights;
}

WeightTrial try_weights(std::span<const TermedGrip> grips, const std::array<double, SCORE_TERM_COUNT>& given, std::uint64_t seed) {
  const std::vector<char> is_first = drawn_half(grips, seed);
  std::vector<TermedGrip> first, second;
  for (std::size_t i = 0; i < grips.size(); ++i) (is_first[i] ? first : second).push_back(grips[i]);
  WeightTrial trial;
  trial.fitted_on = first.size();
  trial.judged_on = second.size();
  trial.fit = fit_logistic(first);
  if (!trial.fit.is_fitted) return trial;
  trial.weights = weights_of(trial.fit);
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) trial.is_clamped[k] = trial.fit.coefficients[k] < 0;
  std::vector<Prediction> by_fitted, by_given;
  for (std::size_t i = 0; i < second.size(); ++i) {
    by_fitted.push_back({weighted_score(second[i], trial.weights), second[i].success, i});
    by_given.push_back({weighted_score(second[i], given), second[i].success, i});
  }
  trial.fitted = auc_with_interval(by_fitted, seed);
  trial.given = auc_with_interval(by_given, seed);
  trial.difference = auc_difference(by_fitted, by_given, seed);
  return trial;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "trials/logistic.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/random_bits.h"
#include "statistics/cholesky.h"

namespace wholehand {
namespace {

constexpr std::size_t UNKNOWNS = SCORE_TERM_COUNT + 1;  // the last is the intercept
constexpr int MOST_STEPS = 200, MOST_HALVINGS = 40;
constexpr double SETTLED = 1e-9;         // of the longest step of an unknown
constexpr double WANTED_SLOPE = 1e-6;    // of the log-likelihood: a smaller one is rounding
constexpr double SEPARATED = 20;         // a coefficient of so many, per deviation of its term, only grows on
constexpr double CONSTANT_TERM = 1e-12;  // a smaller deviation is rounding

using Unknowns = std::array<double, UNKNOWNS>;
using Normal = std::array<Unknowns, UNKNOWNS>;

// What the fit adds up: coefficient k is (1 - terms x LEAST_WEIGHT) amount k + LEAST_WEIGHT x the sum of all amounts. With amounts of
// at least 0 each coefficient is at least LEAST_WEIGHT of their sum, and that sum is the amounts' own.
constexpr double OWN_SHARE = 1 - static_cast<double>(SCORE_TERM_COUNT) * LEAST_WEIGHT;

// What amount k multiplies.
double regressor(const TermedGrip& grip, std::size_t k) {
  double all = 0;
  for (const double term : grip.terms) all += term;
  return OWN_SHARE * grip.terms[k] + LEAST_WEIGHT * all;
}

double deviation(std::span<const TermedGrip> grips, double mean, const std::function<double(const TermedGrip&)>& value) {
  double square = 0;
  for (const TermedGrip& grip : grips) square += (value(grip) - mean) * (value(grip) - mean);
  return std::sqrt(square / static_cast<double>(grips.size()));
}

double mean_of(std::span<const TermedGrip> grips, const std::function<double(const TermedGrip&)>& value) {
  double sum = 0;
  for (const TermedGrip& grip : grips) sum += value(grip);
  return sum / static_cast<double>(grips.size());
}

// Of a regressor over the grips; scale 0: its term does not vary.
struct TermScale {
  double mean = 0, scale = 0;
};

std::array<TermScale, SCORE_TERM_COUNT> scales_of(std::span<const TermedGrip> grips) {
  std::array<TermScale, SCORE_TERM_COUNT> scales;
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    const auto term = [k](const TermedGrip& grip) { return grip.terms[k]; };
    if (!(deviation(grips, mean_of(grips, term), term) > CONSTANT_TERM)) continue;
    const auto value = [k](const TermedGrip& grip) { return regressor(grip, k); };
    scales[k].mean = mean_of(grips, value);
    const double spread = deviation(grips, scales[k].mean, value);
    if (spread > CONSTANT_TERM) scales[k].scale = 1 / spread;
  }
  return scales;
}

Unknowns regressors_of(const TermedGrip& grip, const std::array<TermScale, SCORE_TERM_COUNT>& scales) {
  Unknowns x{};
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) x[k] = (regressor(grip, k) - scales[k].mean) * scales[k].scale;
  x[SCORE_TERM_COUNT] = 1;
  return x;
}

// The log-likelihood less its ridge, with its slope and its curvature (negated), in units of the regressors' deviations.
struct Likelihood {
  double value = 0;
  Unknowns slope{};
  Normal curvature{};
};

// What is fitted: a row of regressors and an outcome for each grip.
struct LogisticProblem {
  std::vector<Unknowns> rows;
  std::vector<char> is_success;
  std::array<TermScale, SCORE_TERM_COUNT> scales;

  Likelihood at(const Unknowns& beta, double ridge) const;
};

LogisticProblem problem_of(std::span<const TermedGrip> grips) {
  LogisticProblem problem{{}, {}, scales_of(grips)};
  for (const TermedGrip& grip : grips) {
    problem.rows.push_back(regressors_of(grip, problem.scales));
    problem.is_success.push_back(grip.success ? 1 : 0);
  }
  return problem;
}

Likelihood LogisticProblem::at(const Unknowns& beta, double ridge) const {
  Likelihood found;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double odds = 0;  // their logarithm
    for (std::size_t k = 0; k < UNKNOWNS; ++k) odds += beta[k] * rows[i][k];
    const double p = 1 / (1 + std::exp(-odds));
    found.value -= std::max(0.0, is_success[i] ? -odds : odds) + std::log1p(std::exp(-std::abs(odds)));  // without an overflow
    for (std::size_t k = 0; k < UNKNOWNS; ++k) {
      found.slope[k] += (is_success[i] - p) * rows[i][k];
      for (std::size_t j = 0; j <= k; ++j) found.curvature[k][j] += p * (1 - p) * rows[i][k] * rows[i][j];
    }
  }
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    found.value -= ridge * beta[k] * beta[k] / 2;
    found.slope[k] -= ridge * beta[k];
    found.curvature[k][k] += ridge;
  }
  return found;
}

using FreeAmounts = std::array<bool, UNKNOWNS>;

// Newton's step of the unknowns that are free; none of the others. False where they depend on one another.
bool newton_step(const Likelihood& here, const FreeAmounts& is_free, Unknowns& step) {
  Normal curvature = here.curvature;
  step = here.slope;
  for (std::size_t k = 0; k < UNKNOWNS; ++k) {
    if (!is_free[k]) step[k] = 0;
    for (std::size_t j = 0; j <= k; ++j)
      if (!is_free[k] || !is_free[j]) curvature[k][j] = k == j ? 1 : 0;
  }
  return solve_positive(curvature, step);
}

// Whether the regressors that vary depend on one another. The bounds would hide it: the first of two like ones would get all.
bool are_dependent(const LogisticProblem& problem, double ridge) {
  FreeAmounts varies{};
  varies[SCORE_TERM_COUNT] = true;
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) varies[k] = problem.scales[k].scale > 0;
  Unknowns unused{};
  return !newton_step(problem.at({}, ridge), varies, unused);
}

// The share of a step at which the first amount comes to 0, and which one it is; 1 and UNKNOWNS where none does.
std::pair<double, std::size_t> share_to_bound(const Unknowns& beta, const Unknowns& step) {
  std::pair<double, std::size_t> first{1, UNKNOWNS};
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k)
    if (beta[k] + first.first * step[k] < 0) first = {-beta[k] / step[k], k};
  return first;
}

// Goes along the step as far as the bounds allow, and half as far until the likelihood is no smaller. What comes to 0 is free no more.
bool take_step(const LogisticProblem& problem, double ridge, const Unknowns& step, Unknowns& beta, FreeAmounts& is_free) {
  const double value = problem.at(beta, ridge).value;
  auto [share, bound] = share_to_bound(beta, step);
  for (int halvings = 0; halvings < MOST_HALVINGS; ++halvings, share /= 2, bound = UNKNOWNS) {
    Unknowns next{};
    for (std::size_t k = 0; k < UNKNOWNS; ++k) next[k] = beta[k] + share * step[k];
    if (problem.at(next, ridge).value < value) continue;
    beta = next;
    if (bound == UNKNOWNS) return false;
    beta[bound] = 0;
    is_free[bound] = false;
    return true;
  }
  return false;
}

// Frees the amount at 0 that the likelihood wants most to grow. False: none.
bool free_one(const LogisticProblem& problem, const Likelihood& here, FreeAmounts& is_free) {
  std::size_t most = UNKNOWNS;
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    if (is_free[k] || problem.scales[k].scale == 0 || here.slope[k] < WANTED_SLOPE) continue;
    if (most == UNKNOWNS || here.slope[k] > here.slope[most]) most = k;
  }
  if (most != UNKNOWNS) is_free[most] = true;
  return most != UNKNOWNS;
}

// Finds amounts of at least 0. False where they do not settle.
bool climb(const LogisticProblem& problem, double ridge, Unknowns& beta) {
  beta = {};
  if (are_dependent(problem, ridge)) return false;
  FreeAmounts is_free{};
  is_free[SCORE_TERM_COUNT] = true;
  for (int tries = 0; tries < MOST_STEPS; ++tries) {
    const Unknowns before = beta;
    Unknowns step{};
    if (!newton_step(problem.at(beta, ridge), is_free, step)) return false;
    const bool is_at_bound = take_step(problem, ridge, step, beta, is_free);
    double longest = 0;
    for (std::size_t k = 0; k < UNKNOWNS; ++k) longest = std::max(longest, std::abs(beta[k] - before[k]));
    if (*std::max_element(beta.begin(), beta.end() - 1) > SEPARATED) return false;
    if (!is_at_bound && longest < SETTLED && !free_one(problem, problem.at(beta, ridge), is_free)) return true;
  }
  return false;
}

double weighted_score(const TermedGrip& grip, const std::array<double, SCORE_TERM_COUNT>& weights) {
  double score = 0;
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) score += weights[k] * grip.terms[k];
  return score;
}

// Every second one of the successes, of the failures and of the discarded, in an order that the seed draws: of grips with `each` outcomes.
std::vector<char> drawn_half(std::span<const TermedGrip> grips, std::uint64_t seed, std::size_t each) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < grips.size() / each; ++i) order.emplace_back(mixed_bits(seed + SPLIT_MIX_STEP * (i + 1)), i);
  std::sort(order.begin(), order.end());
  std::vector<char> is_first(order.size());
  std::array<bool, 3> next{true, true, true};
  for (const auto& [key, i] : order) {
    bool& turn = next[grips[i * each].discarded ? 2 : grips[i * each].success ? 1 : 0];
    is_first[i] = turn;
    turn = !turn;
  }
  return is_first;
}

// An outcome and the number of its grip.
using NumberedOutcome = std::pair<TermedGrip, std::size_t>;

WeightContest contest_of(const std::vector<NumberedOutcome>& outcomes, const std::array<double, SCORE_TERM_COUNT>& fitted,
                         const std::array<double, SCORE_TERM_COUNT>& given, std::uint64_t seed) {
  std::vector<Prediction> by_fitted, by_given;
  for (const auto& [one, grip] : outcomes) {
    by_fitted.push_back({weighted_score(one, fitted), one.success, grip});
    by_given.push_back({weighted_score(one, given), one.success, grip});
  }
  return {auc_with_interval(by_fitted, seed), auc_with_interval(by_given, seed), auc_difference(by_fitted, by_given, seed)};
}

}  // namespace

LogisticFit fit_logistic(std::span<const TermedGrip> grips) {
  LogisticFit fit;
  const auto successes = std::count_if(grips.begin(), grips.end(), [](const TermedGrip& grip) { return grip.success; });
  if (successes == 0 || static_cast<std::size_t>(successes) == grips.size()) return fit;
  const LogisticProblem problem = problem_of(grips);
  const auto& scales = problem.scales;
  Unknowns beta{};
  if (!climb(problem, 0, beta)) {
    fit.has_ridge = true;
    climb(problem, 1, beta);
  }
  fit.is_fitted = true;
  fit.intercept = beta[SCORE_TERM_COUNT];
  double sum = 0;
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    fit.intercept -= beta[k] * scales[k].scale * scales[k].mean;
    sum += beta[k] * scales[k].scale;
  }
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    fit.coefficients[k] = OWN_SHARE * beta[k] * scales[k].scale + LEAST_WEIGHT * sum;
    fit.is_least[k] = beta[k] == 0;
  }
  return fit;
}

std::array<double, SCORE_TERM_COUNT> weights_of(const LogisticFit& fit) {
  std::array<double, SCORE_TERM_COUNT> weights{};
  double sum = 0;
  for (const double coefficient : fit.coefficients) sum += coefficient;
  if (sum > 0)
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) weights[k] = fit.coefficients[k] / sum;
  return weights;
}

WeightTrial try_weights(std::span<const TermedGrip> grips, const std::array<double, SCORE_TERM_COUNT>& given, std::uint64_t seed,
                        std::size_t each) {
  const std::vector<char> is_first = drawn_half(grips, seed, each);
  std::vector<TermedGrip> first;
  std::vector<NumberedOutcome> second, tried;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    if (is_first[i / each]) {
      first.push_back(grips[i]);
      continue;
    }
    second.emplace_back(grips[i], i / each);
    if (!grips[i].discarded) tried.emplace_back(grips[i], i / each);
  }
  WeightTrial trial;
  trial.fitted_on = first.size() / each;
  trial.judged_on = second.size() / each;
  trial.fit = fit_logistic(first);
  if (!trial.fit.is_fitted) return trial;
  trial.weights = weights_of(trial.fit);
  trial.all = contest_of(second, trial.weights, given, seed);
  trial.tried = contest_of(tried, trial.weights, given, seed);
  return trial;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "evidence/trials/logistic.h"

#include <algorithm>
#include <numeric>

#include "base/numbers/random_bits.h"
#include "base/statistics/logistic.h"
#include "base/statistics/moments.h"

namespace wholehand {
namespace {

// What the fit adds up: coefficient k is (1 - terms x LEAST_WEIGHT) amount k + LEAST_WEIGHT x the sum of all amounts. With amounts of
// at least 0 each coefficient is at least LEAST_WEIGHT of their sum, and that sum is the amounts' own.
constexpr double OWN_SHARE = 1 - static_cast<double>(SCORE_TERM_COUNT) * LEAST_WEIGHT;

// What the amounts multiply, grip after grip; 0 where the term does not vary.
std::vector<double> regressors_of(std::span<const TermedGrip> grips) {
  std::vector<double> regressors(grips.size() * SCORE_TERM_COUNT), column(grips.size());
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    for (std::size_t i = 0; i < grips.size(); ++i) column[i] = grips[i].terms[k];
    if (!varies(column)) continue;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      const double all = std::accumulate(grips[i].terms.begin(), grips[i].terms.end(), 0.0);
      regressors[i * SCORE_TERM_COUNT + k] = OWN_SHARE * column[i] + LEAST_WEIGHT * all;
    }
  }
  return regressors;
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
  std::vector<char> success;
  for (const TermedGrip& grip : grips) success.push_back(grip.success ? 1 : 0);
  const LogisticModel model = fit_logistic_model(regressors_of(grips), SCORE_TERM_COUNT, success, Coefficients::not_negative);
  LogisticFit fit;
  fit.is_fitted = model.is_fitted;
  fit.has_ridge = model.has_ridge;
  fit.intercept = model.intercept;
  const std::vector<double>& amounts = model.coefficients;
  const double sum = std::accumulate(amounts.begin(), amounts.end(), 0.0);
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
    fit.coefficients[k] = OWN_SHARE * amounts[k] + LEAST_WEIGHT * sum;
    fit.is_least[k] = amounts[k] == 0;
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

// SPDX-License-Identifier: MIT
#include "evidence/check/error_row.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace wholehand {
namespace {

constexpr double NO_FIGURE = std::numeric_limits<double>::quiet_NaN();

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

ErrorFigures error_figures(const std::vector<double>& errors, const std::vector<std::string>& where) {
  if (errors.empty()) return {NO_FIGURE, NO_FIGURE, NO_FIGURE, "", 0};
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto value = [&](std::size_t i) { return std::isnan(errors[i]) ? std::numeric_limits<double>::infinity() : errors[i]; };
  // stable: the first of equally bad ones
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value(a) < value(b); });
  const auto rank = [&](double share) {
    const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(order.size())));
    return value(order[std::max<std::size_t>(place, 1) - 1]);
  };
  const double max = value(order.back());
  const std::size_t worst = *std::find_if(order.begin(), order.end(), [&](std::size_t i) { return value(i) == max; });
  return {rank(0.5), rank(0.999), max, where[worst], errors.size()};
}

TimeFigures time_figures(std::vector<double> runs, const std::vector<double>& base_beside, const std::vector<double>& base_all) {
  if (runs.empty()) return {};
  std::sort(runs.begin(), runs.end());
  double scale = 1;
  if (!base_beside.empty() && !base_all.empty() && middle(base_beside) > 0) scale = middle(base_all) / middle(base_beside);
  return {scale * middle(runs), scale * (runs[runs.size() * 3 / 4] - runs[runs.size() / 4])};
}

double ErrorRow::length_error() const {
  if (variant.axis == SweptAxis::effort) return NO_FIGURE;
  if (!variant.answers_the_question() || errors[ERROR_GAP].compared == 0) return NO_FIGURE;
  double worst = 0;
  for (const int q : {ERROR_SEPARATION, ERROR_POSED, ERROR_PROXY, ERROR_GAP, ERROR_COM})
    if (errors[q].compared > 0) worst = std::max(worst, errors[q].p999);
  return worst;
}

double ErrorRow::force_error() const {
  if (!variant.answers_the_question() || errors[ERROR_FEEDBACK].compared == 0) return NO_FIGURE;
  if (above_one_in_1000(hold_flips, errors[ERROR_FEEDBACK].compared)) return std::numeric_limits<double>::infinity();
  const double hold = errors[ERROR_HOLD].compared > 0 ? errors[ERROR_HOLD].p999 : 0;
  return std::max(errors[ERROR_FEEDBACK].p999, hold);
}

}  // namespace wholehand

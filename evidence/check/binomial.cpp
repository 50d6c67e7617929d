// SPDX-License-Identifier: MIT
#include "evidence/check/binomial.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wholehand {
namespace {

double log_factorial(double n) { return std::lgamma(n + 1); }

// P(X = count), 0 < share < 1.
double binomial_term(double trials, double count, double share) {
  const double choose = log_factorial(trials) - log_factorial(count) - log_factorial(trials - count);
  return std::exp(choose + count * std::log(share) + (trials - count) * std::log1p(-share));
}

}  // namespace

// The terms fall from the mean on to either side, each a known multiple of the one before: the side away from the mean is summed, so that
// nothing cancels where the answer is small.
double binomial_tail(std::uint64_t trials, std::uint64_t count, double share) {
  if (count == 0 || (share >= 1 && count <= trials)) return 1;
  if (count > trials || !(share > 0)) return 0;
  const auto n = static_cast<double>(trials);
  const double odds = share / (1 - share);
  const bool is_above = static_cast<double>(count) > n * share;
  double k = is_above ? static_cast<double>(count) : static_cast<double>(count - 1);
  double term = binomial_term(n, k, share), sum = 0;
  while (term > sum * std::numeric_limits<double>::epsilon() / 4) {
    sum += term;
    term *= is_above ? (n - k) / (k + 1) * odds : k / (n - k + 1) / odds;
    k += is_above ? 1 : -1;
  }
  return is_above ? std::min(sum, 1.0) : std::max(0.0, 1 - sum);
}

std::uint64_t largest_plausible_count(std::uint64_t trials, double share, double significance) {
  std::uint64_t count = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(static_cast<double>(trials) * share));
  while (binomial_tail(trials, count + 1, share) >= significance) ++count;
  return count;
}

}  // namespace wholehand

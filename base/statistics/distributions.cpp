// SPDX-License-Identifier: MIT
#include "base/statistics/distributions.h"

#include <cmath>

namespace wholehand {
namespace {

constexpr int MOST_TERMS = 10000;
constexpr double TINY = 1e-300, END = 1e-16;

double away_from_zero(double x) { return std::abs(x) < TINY ? TINY : x; }

// For numbers above 0. std::lgamma writes the sign of the gamma function to a global, which is a race between threads.
double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

// The continued fraction of 26.5.8; it converges fast for x < (a + 1) / (a + b + 2).
double fraction(double a, double b, double x) {
  double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), value = d;
  for (int m = 1; m <= MOST_TERMS; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away_from_zero(1 + even * d);
    c = away_from_zero(1 + even / c);
    value *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away_from_zero(1 + odd * d);
    c = away_from_zero(1 + odd / c);
    value *= c * d;
    if (std::abs(c * d - 1) < END) break;
  }
  return value;
}

// The regularized lower incomplete gamma function P(a, x): the series of 6.5.29, whose terms are all positive.
double incomplete_gamma(double a, double x) {
  double term = 1, sum = 1;
  for (int n = 1; n <= MOST_TERMS && term > END * sum; ++n) sum += term *= x / (a + n);
  return sum * std::exp(a * std::log(x) - x - log_gamma(a + 1));
}

}  // namespace

double incomplete_beta(double a, double b, double x) {
  if (std::isnan(x)) return x;  // no tail: not one of 0
  if (!(x > 0)) return 0;
  if (!(x < 1)) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
  const double front = std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) + b * std::log1p(-x));
  return front * fraction(a, b, x) / a;
}

double f_tail(double f, double above, double below) {
  if (std::isnan(f)) return f;  // no test, and not one that shows nothing
  if (!(f > 0)) return 1;
  return incomplete_beta(below / 2, above / 2, below / (below + above * f));
}

double chi_square_quantile(double p, double freedom) {
  double low = 0, high = freedom;
  // For an x far above a the series overflows, and NaN is not below p.
  while (incomplete_gamma(freedom / 2, high / 2) < p) high *= 2;
  while (high - low > 1e-10 * high) {
    const double middle = low + (high - low) / 2;
    (incomplete_gamma(freedom / 2, middle / 2) < p ? low : high) = middle;
  }
  return high;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "base/numbers/normal.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace wholehand {
namespace {

constexpr double SQUARE_ROOT_OF_2_PI = 2.5066282746310005024;

// Acklam's approximation, relative error below 1.15e-9.
double approximate_quantile(double p) {
  constexpr std::array<double, 6> A{-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                                    1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr std::array<double, 5> B{-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02, 6.680131188771972e+01,
                                    -1.328068155288572e+01};
  constexpr std::array<double, 6> C{-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                                    -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr std::array<double, 4> D{7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00, 3.754408661907416e+00};
  constexpr double TAIL = 0.02425;
  const auto horner = [](const auto& coefficients, double x) {
    return std::accumulate(coefficients.begin(), coefficients.end(), 0.0, [x](double sum, double c) { return sum * x + c; });
  };
  if (p < TAIL) {
    const double q = std::sqrt(-2 * std::log(p));
    return horner(C, q) / (horner(D, q) * q + 1);
  }
  const double q = p - 0.5, r = q * q;
  return horner(A, r) * q / (horner(B, r) * r + 1);
}

}  // namespace

double normal_quantile(double p) {
  if (!(p > 0 && p < 1)) return p > 0 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  if (p > 0.5) return -normal_quantile(1 - p);
  const double x = approximate_quantile(p);
  const double error = 0.5 * std::erfc(-x / std::sqrt(2.0)) - p;
  const double step = error * SQUARE_ROOT_OF_2_PI * std::exp(x * x / 2);
  return x - step / (1 + x * step / 2);
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Small symmetric systems, as those of a fit by Newton's steps.
#pragma once

#include <cmath>
#include <cstddef>

namespace wholehand {

// A pivot of less than this share of its place: the unknowns depend on one another.
constexpr double DEPENDENT_PIVOT = 1e-10;

// Solves a symmetric positive system, of which the lower half is given, by Cholesky's method: `b` becomes the answer. False where the
// system is not positive, or hardly.
template <class Matrix, class Column>
bool solve_positive(Matrix a, Column& b) {
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

}  // namespace wholehand

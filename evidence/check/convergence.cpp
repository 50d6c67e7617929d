// SPDX-License-Identifier: MIT
#include "evidence/check/convergence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace wholehand {

double fitted_order(const std::vector<double>& steps, const std::vector<double>& errors) {
  double count = 0, x_sum = 0, y_sum = 0, xx = 0, xy = 0;
  for (std::size_t k = 0; k < std::min(steps.size(), errors.size()); ++k) {
    const double x = std::log(steps[k]), y = std::log(errors[k]);
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    ++count;
    x_sum += x;
    y_sum += y;
    xx += x * x;
    xy += x * y;
  }
  const double spread = count * xx - x_sum * x_sum;
  return count >= 2 && spread > 0 ? (count * xy - x_sum * y_sum) / spread : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace wholehand

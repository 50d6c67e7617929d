// SPDX-License-Identifier: MIT
#include "evidence/allowance.h"

#include <limits>

#include "evidence/binomial.h"
#include "shaders/layout.h"

namespace wholehand {

Allowance allowance(Precision precision) {
  if (precision == Precision::single) return {std::numeric_limits<float>::epsilon(), STOP_TOLERANCE_F32, LEVEL_TOLERANCE_F32, true};
  return {std::numeric_limits<double>::epsilon(), STOP_TOLERANCE_F64, LEVEL_TOLERANCE_F64, true};
}

Allowance float_against_double() {
  Allowance allowed = allowance(Precision::single);
  allowed.same_stop = false;
  return allowed;
}

std::uint64_t allowed_flips(std::uint64_t grips) { return largest_plausible_count(grips, FLIP_SHARE, FLIP_SIGNIFICANCE); }

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "studies/words.h"

#include <cmath>

namespace wholehand {

std::string word_of_correlation(double r) {
  if (std::isnan(r)) return "";
  const double size = std::abs(r);
  if (size < WEAK_R) return "-";
  return std::string(size < STRONG_R ? "" : size < VERY_STRONG_R ? "S" : "VS") + (r < 0 ? "N" : "P");
}

}  // namespace wholehand

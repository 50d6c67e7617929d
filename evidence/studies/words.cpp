// SPDX-License-Identifier: MIT
#include "evidence/studies/words.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace wholehand {

std::string word_of_correlation(double r) {
  if (std::isnan(r)) return "";
  double size = 0;
  const std::string shown = fmt::format("{:.2f}", std::abs(r));
  std::from_chars(shown.data(), shown.data() + shown.size(), size);
  if (size < WEAK_R) return "-";
  return std::string(size < STRONG_R ? "" : size < VERY_STRONG_R ? "S" : "VS") + (r < 0 ? "N" : "P");
}

std::string why_no_correlation(double touch_share) {
  if (std::isnan(touch_share)) return "no grasp holds";
  if (touch_share == 0) return "never touches";
  return touch_share == 1 ? "always touches" : "too few grasps";
}

}  // namespace wholehand

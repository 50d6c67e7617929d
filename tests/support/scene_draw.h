// SPDX-License-Identifier: MIT
// What scenes are drawn with by chance.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/scenes.h"

namespace wholehand {

class SceneDraw {
 public:
  explicit SceneDraw(std::uint64_t seed) : random_(seed) {}

  double between(double low, double high) { return random_.uniform(low, high); }
  // Evenly in the logarithm.
  double over(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool chance(double share) { return between(0, 1) < share; }
  int of(int count) { return static_cast<int>(between(0, count)); }
  std::string word(const std::vector<std::string>& words) {
    return words[static_cast<std::size_t>(of(static_cast<int>(words.size())))];
  }

 private:
  Random random_;
};

}  // namespace wholehand

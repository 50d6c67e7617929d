// SPDX-License-Identifier: MIT
// Numbers as if at random that are found by counting: nothing is kept between two of them, so any of them can be had first.
#pragma once

#include <cstdint>

namespace wholehand {

// Names a stream of numbers: independent of the order of asking and of other names. A person's own has experiment 0, grasp 0.
struct DrawName {
  std::uint64_t seed = 0;
  std::uint64_t person = 0;
  std::uint64_t experiment = 0;
  std::uint64_t grasp = 0;
};

// The number `index` of a name, uniform in (0, 1).
double drawn(const DrawName& name, std::uint64_t index);

}  // namespace wholehand

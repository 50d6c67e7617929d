// SPDX-License-Identifier: MIT
// Counter-based random numbers: no state is kept between two draws, so any of them can be drawn first.
#pragma once

#include <cstdint>

namespace wholehand {

// Names a stream of numbers that does not depend on other names or on the order of use. A person's own stream has experiment 0, grasp 0.
struct DrawName {
  std::uint64_t seed = 0;
  std::uint64_t person = 0;
  std::uint64_t experiment = 0;
  std::uint64_t grasp = 0;
};

// The number `index` of a name, uniform in (0, 1).
double drawn(const DrawName& name, std::uint64_t index);

}  // namespace wholehand

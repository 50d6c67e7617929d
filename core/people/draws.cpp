// SPDX-License-Identifier: MIT
#include "core/people/draws.h"

#include <cmath>
#include <initializer_list>

#include "base/numbers/random_bits.h"

namespace wholehand {

// Each part of the name selects the sequence that SplitMix64 has there, so two names that differ in a part diverge for good.
double drawn(const DrawName& name, std::uint64_t index) {
  std::uint64_t bits = 0;
  for (const std::uint64_t part : {name.seed, name.person, name.experiment, name.grasp, index})
    bits = mixed_bits(bits + SPLIT_MIX_STEP * (part + 1));
  return std::fmin(unit_interval(bits) + 0x1p-54, 1 - 0x1p-53);  // the middle of its cell; that of the last one rounds to 1
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "base/numbers/random_bits.h"

#include <gtest/gtest.h>

namespace wholehand {
namespace {

// The first numbers of Vigna's splitmix64.c for the seed 1234567.
TEST(RandomBits, SplitMixIsThePublishedSequence) {
  std::uint64_t state = 1234567;
  EXPECT_EQ(split_mix(state), 6457827717110365317u);
  EXPECT_EQ(split_mix(state), 3203168211198807973u);
  EXPECT_EQ(split_mix(state), 9817491932198370423u);
}

TEST(RandomBits, TheUnitIntervalLacksItsEnd) {
  EXPECT_EQ(unit_interval(0), 0);
  EXPECT_EQ(unit_interval(std::uint64_t{1} << 63), 0.5);
  EXPECT_EQ(unit_interval(~std::uint64_t{0}), 1 - 0x1p-53);
}

}  // namespace
}  // namespace wholehand

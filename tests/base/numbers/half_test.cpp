// SPDX-License-Identifier: MIT
// Halves against the format's own definition.
// sanitizers: address
#include "base/numbers/half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// IEEE 754: (-1)^s 2^(e - 15) (1 + f / 1024), or f 2^-24 where e is 0.
double by_definition(std::uint16_t bits) {
  const double sign = bits >> 15 != 0 ? -1 : 1;
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

TEST(Half, ValuesAreThoseOfTheFormat) {
  for (int bits = 0; bits < 0x10000; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    if ((bits >> 10 & 31) == 31) {
      EXPECT_TRUE(std::isnan(half_value(half))) << bits;
    } else {
      EXPECT_EQ(half_value(half), by_definition(half)) << bits;
      EXPECT_EQ(half_bits(half_value(half)), half);
    }
  }
}

TEST(Half, RoundsToTheNearestAndOfTwoToTheEven) {
  for (int bits = 0; bits < 0x7BFF; ++bits) {
    const float low = half_value(static_cast<std::uint16_t>(bits)), high = half_value(static_cast<std::uint16_t>(bits + 1));
    const float middle = 0.5f * (low + high);  // exact: a float has 13 bits more
    for (const int sign : {1, -1}) {
      const int base = sign > 0 ? 0 : 0x8000;
      const auto s = static_cast<float>(sign);
      EXPECT_EQ(half_bits(s * middle), base + bits + bits % 2) << bits;
      EXPECT_EQ(half_bits(s * std::nextafter(middle, 0.0f)), base + bits) << bits;
      EXPECT_EQ(half_bits(s * std::nextafter(middle, 1e9f)), base + bits + 1) << bits;
    }
  }
}

TEST(Half, WhatIsTooLargeBecomesTheLargest) {
  for (const float value : {65504.0f, 65519.0f, 1e9f, std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(half_value(half_bits(value)), LARGEST_HALF);
    EXPECT_EQ(half_value(half_bits(-value)), -LARGEST_HALF);
  }
}

}  // namespace
}  // namespace wholehand

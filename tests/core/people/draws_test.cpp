// SPDX-License-Identifier: MIT
// Numbers that are found by counting: by another program, uniform, and unrelated to those of every neighboring name.
#include "core/people/draws.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace wholehand {
namespace {

// The numbers come from the same chain of SplitMix64 in Python.
TEST(Draws, AreThoseOfAnotherProgram) {
  EXPECT_EQ(drawn({0, 0, 0, 0}, 0), 0.4714104296684803);
  EXPECT_EQ(drawn({1, 2, 3, 4}, 5), 0.992563044392504);
  EXPECT_EQ(drawn({9223372036854775807u, 1000000, 7, 9}, 42), 0.13214489595288176);
}

constexpr int COUNT = 40000;

TEST(Draws, FillTheUnitIntervalEvenly) {
  for (const std::uint64_t index : {0, 1, 17}) {
    std::array<int, 64> cells{};
    for (std::uint64_t person = 0; person < COUNT; ++person) {
      const double x = drawn({5, person}, index);
      ASSERT_GT(x, 0);
      ASSERT_LT(x, 1);
      ++cells[static_cast<std::size_t>(x * 64)];
    }
    double chi = 0;
    for (const int n : cells) chi += (n - COUNT / 64.0) * (n - COUNT / 64.0) / (COUNT / 64.0);
    // 63 degrees of freedom: mean 63, deviation 11.2; six of them
    EXPECT_NEAR(chi, 63, 68) << index;
  }
}

// The correlation of two sequences, of uniform numbers.
double correlation(const std::function<double(std::uint64_t)>& a, const std::function<double(std::uint64_t)>& b) {
  double sum = 0;
  for (std::uint64_t k = 0; k < COUNT; ++k) sum += (a(k) - 0.5) * (b(k) - 0.5);
  return sum / COUNT * 12;
}

TEST(Draws, NeighborsAreUnrelated) {
  const auto plain = [](std::uint64_t k) { return drawn({9, k}, 3); };
  // deviation of the correlation of 40,000 unrelated pairs: 0.005; five of them
  constexpr double FIVE = 0.025;
  EXPECT_NEAR(correlation(plain, plain), 1, FIVE);
  EXPECT_NEAR(correlation(plain, [](std::uint64_t k) { return drawn({9, k}, 4); }), 0, FIVE);
  EXPECT_NEAR(correlation(plain, [](std::uint64_t k) { return drawn({9, k + 1}, 3); }), 0, FIVE);
  EXPECT_NEAR(correlation(plain, [](std::uint64_t k) { return drawn({10, k}, 3); }), 0, FIVE);
  EXPECT_NEAR(correlation(plain, [](std::uint64_t k) { return drawn({9, k, 1}, 3); }), 0, FIVE);
  EXPECT_NEAR(correlation(plain, [](std::uint64_t k) { return drawn({9, k, 0, 1}, 3); }), 0, FIVE);
  EXPECT_NEAR(correlation(plain, [](std::uint64_t k) { return drawn({9, 3}, k); }), 0, FIVE);
}

}  // namespace
}  // namespace wholehand

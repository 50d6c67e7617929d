// SPDX-License-Identifier: MIT
// Indices of models whose own are known.
// sanitizers: none
#include "base/statistics/sobol_indices.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

using Row = std::array<double, 3>;

std::vector<SensitivityIndex> indices_of(const std::function<double(const Row&)>& model, std::size_t count) {
  std::uint64_t state = 3;
  std::vector<double> a, b;
  std::vector<std::vector<double>> mixed(3);
  for (std::size_t k = 0; k < count; ++k) {
    Row one{}, other{};
    for (double& x : one) x = unit_interval(split_mix(state));
    for (double& x : other) x = unit_interval(split_mix(state));
    a.push_back(model(one));
    b.push_back(model(other));
    for (std::size_t i = 0; i < 3; ++i) {
      Row row = one;
      row[i] = other[i];
      mixed[i].push_back(model(row));
    }
  }
  return first_order_indices(a, b, mixed, 200, 1);
}

// Ishigami & Homma 1990 with a = 7, b = 0.1: the indices are 0.3139, 0.4424 and 0.
TEST(SobolIndices, OfIshigamisFunction) {
  constexpr double PI = 3.14159265358979323846;
  const auto ishigami = [](const Row& row) {
    const double x = PI * (2 * row[0] - 1), y = PI * (2 * row[1] - 1), z = PI * (2 * row[2] - 1);
    return std::sin(x) + 7 * std::sin(y) * std::sin(y) + 0.1 * z * z * z * z * std::sin(x);
  };
  const auto indices = indices_of(ishigami, 40000);
  const std::array<double, 3> known{0.3139, 0.4424, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    // five deviations of the estimate, as its own interval has them
    const double deviation = (indices[i].interval.high - indices[i].interval.low) / (2 * NORMAL_95);
    EXPECT_NEAR(indices[i].first, known[i], 5 * deviation) << i;
    EXPECT_LT(deviation, 0.02);
  }
}

TEST(SobolIndices, OfASumAreTheSharesOfItsVariance) {
  const auto sum = [](const Row& row) { return 1000 + 1 * row[0] + 2 * row[1] + 3 * row[2]; };
  const auto indices = indices_of(sum, 40000);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(indices[i].first, (1.0 + i) * (1.0 + i) / 14, 0.03) << i;
}

TEST(SobolIndices, OfAConstantAreNone) {
  for (const double constant : {5.0, 0.1}) {  // the mean of many 0.1 is not 0.1
    const auto indices = indices_of([constant](const Row&) { return constant; }, 100);
    for (const SensitivityIndex& index : indices) {
      EXPECT_EQ(index.first, 0);
      EXPECT_TRUE(std::isnan(index.interval.low));
    }
  }
}

}  // namespace
}  // namespace wholehand

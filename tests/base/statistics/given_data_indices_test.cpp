// SPDX-License-Identifier: MIT
// Indices from one sample, of models whose own are known.
#include "base/statistics/given_data_indices.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "base/numbers/normal.h"
#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

using Inputs = std::array<double, 4>;  // the last is for noise, and not shown
constexpr std::size_t SHOWN = 3;
constexpr double T_19 = 2.093024054408263;
constexpr double LINE_IN_BINS = 1 - 1.0 / (GivenDataIndices::BINS * GivenDataIndices::BINS);  // of its variance

GivenDataIndices given_indices(const std::function<double(const Inputs&)>& model, int count, std::uint64_t seed = 3) {
  GivenDataIndices indices(SHOWN, 1);
  std::uint64_t state = mixed_bits(seed);
  for (int k = 0; k < count; ++k) {
    Inputs inputs{};
    for (double& x : inputs) x = unit_interval(split_mix(state));
    indices.add(std::span(inputs).first(SHOWN), std::array{model(inputs)});
  }
  return indices;
}

double deviation_of_index(const SensitivityIndex& index) { return (index.interval.high - index.interval.low) / (2 * T_19); }

double noise_of(const Inputs& x) { return normal_quantile(std::fmax(x[3], 1e-300)); }

// Ishigami & Homma 1990 with a = 7, b = 0.1: the indices are 0.3139, 0.4424 and 0.
double ishigami_of(const Inputs& inputs) {
  const auto angle = [&](std::size_t i) { return std::numbers::pi * (2 * inputs[i] - 1); };
  const double x = angle(0), y = angle(1), z = angle(2);
  return std::sin(x) + 7 * std::sin(y) * std::sin(y) + 0.1 * z * z * z * z * std::sin(x);
}

// What means over bins of `turn` radians leave of a sine's variance.
double sine_in_bins(double turn) { return std::pow(std::sin(turn / 2) / (turn / 2), 2); }

TEST(GivenDataIndices, OfASumAreTheSharesOfItsVariance) {
  // the large mean costs no digits
  const auto indices = given_indices([](const Inputs& x) { return 1e8 + 1 * x[0] + 2 * x[1] + 3 * x[2]; }, 40000);
  for (std::size_t i = 0; i < SHOWN; ++i) {
    const SensitivityIndex index = indices.first_order(0, i);
    EXPECT_NEAR(index.first, LINE_IN_BINS * (1.0 + i) * (1.0 + i) / 14, 5 * deviation_of_index(index)) << i;
    EXPECT_LT(deviation_of_index(index), 0.01);
  }
}

TEST(GivenDataIndices, OfIshigamisFunction) {
  const auto indices = given_indices(ishigami_of, 40000);
  const double bin = 2 * std::numbers::pi / GivenDataIndices::BINS;
  // the first answers as sin x, the second as cos 2 y
  const std::array<double, SHOWN> known{0.3139 * sine_in_bins(bin), 0.4424 * sine_in_bins(2 * bin), 0};
  for (std::size_t i = 0; i < SHOWN; ++i) {
    const SensitivityIndex index = indices.first_order(0, i);
    EXPECT_NEAR(index.first, known[i], 5 * deviation_of_index(index)) << i;
    EXPECT_LT(deviation_of_index(index), 0.01);
  }
  EXPECT_NEAR(sine_in_bins(2 * bin), 0.95, 1e-3);  // the loss that the header states
}

TEST(GivenDataIndices, AgreeWithThoseOfTwoSamples) {
  constexpr std::size_t ROWS = 20000;
  std::uint64_t state = 5;
  std::vector<double> a, b;
  std::vector<std::vector<double>> mixed(SHOWN);
  for (std::size_t k = 0; k < ROWS; ++k) {
    Inputs one{}, other{};
    for (double& x : one) x = unit_interval(split_mix(state));
    for (double& x : other) x = unit_interval(split_mix(state));
    a.push_back(ishigami_of(one));
    b.push_back(ishigami_of(other));
    for (std::size_t i = 0; i < SHOWN; ++i) {
      Inputs row = one;
      row[i] = other[i];
      mixed[i].push_back(ishigami_of(row));
    }
  }
  const auto known = first_order_indices(a, b, mixed, 200, 1);
  const auto given = given_indices(ishigami_of, 40000);
  for (std::size_t i = 0; i < SHOWN; ++i) {
    const SensitivityIndex index = given.first_order(0, i);
    const double deviation = (known[i].interval.high - known[i].interval.low) / (2 * NORMAL_95);
    // five deviations of the difference, and 5 % that the bins do not see
    EXPECT_NEAR(index.first, known[i].first, 5 * std::hypot(deviation, deviation_of_index(index)) + 0.05 * known[i].first) << i;
  }
}

// As often as 95 % of so many tosses, within four deviations. The third input has no influence: its interval is the wider one.
TEST(GivenDataIndices, IntervalsHoldTheIndexAsOftenAsTheySay) {
  constexpr int REPEATS = 200;
  const double deviation = std::sqrt(0.95 * 0.05 * REPEATS), variance = 4.0 / 12 + 1.0 / 12 + 0.25;
  const std::array<double, SHOWN> known{LINE_IN_BINS * 4.0 / 12 / variance, LINE_IN_BINS * 1.0 / 12 / variance, 0};
  std::array<int, SHOWN> held{};
  std::array<double, SHOWN> mean{};
  for (int repeat = 0; repeat < REPEATS; ++repeat) {
    const auto model = [](const Inputs& x) { return 2 * x[0] + x[1] + 0.5 * noise_of(x); };
    const auto indices = given_indices(model, 1000, 100 + static_cast<std::uint64_t>(repeat));
    for (std::size_t i = 0; i < SHOWN; ++i) {
      const SensitivityIndex index = indices.first_order(0, i);
      held[i] += index.interval.low <= known[i] && known[i] <= index.interval.high ? 1 : 0;
      mean[i] += index.first / REPEATS;
    }
  }
  for (std::size_t i = 0; i < SHOWN; ++i) EXPECT_GE(held[i], 0.95 * REPEATS - 4 * deviation) << i;
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(held[i], REPEATS) << i;  // by chance once in 28,000
  // without noise's part taken off, each were some 0.015 larger; the mean of 200 has a deviation of 0.0015 at most
  for (std::size_t i = 0; i < SHOWN; ++i) EXPECT_NEAR(mean[i], known[i], 0.006) << i;
}

TEST(GivenDataIndices, OfNoiseAreAboutNothing) {
  const auto indices = given_indices(noise_of, 20000);
  for (std::size_t i = 0; i < SHOWN; ++i) {
    const SensitivityIndex index = indices.first_order(0, i);
    EXPECT_LE(index.interval.low, 0) << i;
    EXPECT_GE(index.interval.high, 0) << i;
    EXPECT_LT(deviation_of_index(index), 1e-3);
  }
}

TEST(GivenDataIndices, OfAConstantAreNothing) {
  for (const double constant : {0.0, 0.1, 1e9}) {
    const SensitivityIndex index = given_indices([&](const Inputs&) { return constant; }, 400).first_order(0, 0);
    EXPECT_EQ(index.first, 0);
    EXPECT_TRUE(std::isnan(index.interval.low));
  }
}

TEST(GivenDataIndices, OfTooFewEntriesAreNone) {
  const auto model = [](const Inputs& x) { return x[0]; };
  constexpr int LEAST = GivenDataIndices::LEAST_VALUES;
  EXPECT_TRUE(std::isnan(given_indices(model, LEAST - 1).first_order(0, 0).first));
  EXPECT_TRUE(std::isnan(GivenDataIndices(2, 1).first_order(0, 1).first));
  // the input explains all; the rest is the line's slope within the bins
  EXPECT_NEAR(given_indices(model, LEAST).first_order(0, 0).first, 1, 0.01);
}

// One person of a thousand does something else: without that one's group nothing varies but by rounding, which each usual answer
// has its own of.
TEST(GivenDataIndices, OfASingleExceptionAreFinite) {
  for (const int exception : {0, 500}) {
    for (double usual = 0.1; usual < 1; usual += 0.1) {
      int number = 0;
      const auto indices = given_indices([&](const Inputs&) { return number++ == exception ? 5 : usual; }, 1000);
      const SensitivityIndex index = indices.first_order(0, 0);
      // it is one value in the mean of a bin of 60
      EXPECT_LT(std::abs(index.first), 0.05) << exception << " " << usual;
      EXPECT_LT(index.interval.high - index.interval.low, 0.2) << exception << " " << usual;
      EXPECT_TRUE(index.interval.low <= 0 && index.interval.high >= 0) << exception << " " << usual;
    }
  }
}

// Another output keeps its entry, and the same bits as without.
TEST(GivenDataIndices, WhatIsNoNumberIsLeftOut) {
  GivenDataIndices with(1, 2), without(1, 1);
  std::uint64_t state = 1;
  for (int k = 0; k < 1000; ++k) {
    const double x = unit_interval(split_mix(state)), y = x + unit_interval(split_mix(state));
    with.add(std::array{x}, std::array{k % 2 == 0 ? std::nan("") : y, y});
    if (k % 2 != 0) without.add(std::array{x}, std::array{y});
    with.add(std::array{0.5}, std::array{HUGE_VAL, std::nan("")});
  }
  const SensitivityIndex some = with.first_order(0, 0), alone = without.first_order(0, 0), all = with.first_order(1, 0);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(some.first), std::bit_cast<std::uint64_t>(alone.first));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(some.interval.low), std::bit_cast<std::uint64_t>(alone.interval.low));
  EXPECT_NEAR(all.first, 0.5, 5 * deviation_of_index(all) + 0.01);
  EXPECT_NE(all.first, some.first);
}

TEST(GivenDataIndices, EndsOfTheInputsAreInTheirBins) {
  GivenDataIndices indices(1, 1);
  for (int k = 0; k < 400; ++k) indices.add(std::array{k % 2 == 0 ? 0.0 : 1.0}, std::array{k % 2 == 0 ? 3.0 : 4.0});
  EXPECT_DOUBLE_EQ(indices.first_order(0, 0).first, 1);
}

}  // namespace
}  // namespace wholehand

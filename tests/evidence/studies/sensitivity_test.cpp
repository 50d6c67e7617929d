// SPDX-License-Identifier: MIT
// Rows of sensitivity, and the three inputs that a table shows.
#include "evidence/studies/sensitivity.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/people/draws.h"

namespace wholehand {
namespace {

const std::vector<std::string> ANSWERS{"first", "second"}, PARTS{"a", "b", "c", "d", "e"};

GivenDataIndices five_inputs() {
  GivenDataIndices indices(PARTS.size(), ANSWERS.size());
  for (std::uint64_t n = 0; n < 4000; ++n) {
    std::array<double, 5> x{};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = drawn({1, n}, i);
    indices.add(x, std::array{x[0] + 4 * x[1] + 2 * x[2] + 3 * x[3], 7.0});
  }
  return indices;
}

TEST(Sensitivity, HasARowForEachInputOfEachAnswer) {
  const GivenDataIndices indices = five_inputs();
  const auto rows = sensitivity_rows("sessions", ANSWERS, PARTS, indices);
  ASSERT_EQ(rows.size(), 10u);
  EXPECT_EQ(rows[1].experiment, "sessions");
  EXPECT_EQ(rows[1].pose, "");
  EXPECT_EQ(rows[1].vessel, "all");
  EXPECT_EQ(rows[1].statistic, "first_order_of_first");
  EXPECT_EQ(rows[1].subject, "b");
  EXPECT_EQ(rows[1].value, indices.first_order(0, 1).first);
  EXPECT_EQ(rows[1].interval.low, indices.first_order(0, 1).interval.low);
  EXPECT_FALSE(rows[1].paper.has_value());
  EXPECT_EQ(rows[9].statistic, "first_order_of_second");
  EXPECT_EQ(rows[9].subject, "e");
}

TEST(Sensitivity, TheStrongestInputsAreThreeInTheirOrder) {
  const auto rows = sensitivity_rows("sessions", ANSWERS, PARTS, five_inputs());
  const auto strongest = strongest_inputs(rows);
  ASSERT_EQ(strongest.size(), 2u);
  EXPECT_EQ(strongest[0].output, "first");
  EXPECT_EQ(strongest[0].experiment, "sessions");
  ASSERT_EQ(strongest[0].inputs.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(strongest[0].inputs[k].input, (std::array{"b", "d", "c"})[k]);
  EXPECT_EQ(strongest[0].inputs[0].index, rows[1].value);
  EXPECT_EQ(strongest[0].inputs[0].interval.high, rows[1].interval.high);
  EXPECT_EQ(strongest[1].output, "second");
  EXPECT_TRUE(strongest[1].inputs.empty()) << "it does not vary";
}

TEST(Sensitivity, WhatMayBeNothingIsNoStrongestInput) {
  const std::vector<StudyRow> rows{
      {"contacts", "paper", "all", "held_share", "", 1, {0.9, 1}, std::nullopt},
      {"contacts", "", "all", "first_order_of_held", "a", 0.9, {-0.01, 1.8}, std::nullopt},
      {"contacts", "", "all", "first_order_of_held", "b", 0.1, {0.05, 0.15}, std::nullopt},
      {"contacts", "", "all", "first_order_of_held", "c", std::nan(""), {}, std::nullopt},
      {"sessions", "", "all", "first_order_of_held", "a", 0.2, {0.1, 0.3}, std::nullopt},
  };
  const auto strongest = strongest_inputs(rows);
  ASSERT_EQ(strongest.size(), 2u);
  ASSERT_EQ(strongest[0].inputs.size(), 1u);
  EXPECT_EQ(strongest[0].inputs[0].input, "b");
  EXPECT_EQ(strongest[1].experiment, "sessions");
  ASSERT_EQ(strongest[1].inputs.size(), 1u);
  EXPECT_EQ(strongest[1].inputs[0].input, "a");
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// When two hands count as different, and the greedy choice against a search through all pairs.
// sanitizers: address
#include "sweeps/lists/different_grips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace wholehand::sweeps {
namespace {

constexpr double QUARTER = 0.25;  // m, so that sums of it are exact

PosedHand hand_at(double x, double y = 0, double z = 0) {
  PosedHand hand;
  for (int j = 0; j < JOINT_COUNT; ++j) hand[j] = {x + j, y - j, z};
  return hand;
}

TEST(DifferentGrips, OneJointMoreThanApartAwayIsEnough) {
  const PosedHand hand = hand_at(0);
  EXPECT_FALSE(are_different(hand, hand, QUARTER));
  EXPECT_FALSE(are_different(hand, hand_at(QUARTER), QUARTER)) << "exactly apart is not more than apart";
  EXPECT_TRUE(are_different(hand, hand_at(QUARTER + 1e-9), QUARTER));
  for (int j = 0; j < JOINT_COUNT; ++j) {
    for (int k = 0; k < 3; ++k) {
      PosedHand moved = hand;
      moved[j][k] += 2 * QUARTER;
      EXPECT_TRUE(are_different(hand, moved, QUARTER)) << j;
      EXPECT_TRUE(are_different(moved, hand, QUARTER)) << j;
    }
  }
  // the distance is that in space: each coordinate alone is less than apart
  EXPECT_TRUE(are_different(hand, hand_at(0.2, 0.2, 0.2), QUARTER));
}

TEST(DifferentGrips, AHandIsComparedAtEqualJoints) {
  const PosedHand hand = hand_at(0);
  PosedHand turned = hand;
  std::swap(turned[0], turned[1]);
  EXPECT_TRUE(are_different(hand, turned, QUARTER)) << "the same points, of other joints";
}

TEST(DifferentGrips, WithoutAHandOrADistanceEverythingDiffers) {
  const PosedHand hand = hand_at(0);
  EXPECT_TRUE(are_different(std::nullopt, hand, QUARTER));
  EXPECT_TRUE(are_different(std::nullopt, std::nullopt, QUARTER));
  EXPECT_TRUE(are_different(hand, hand, 0));
}

TEST(DifferentGrips, TheChoiceIsThatOfASearchThroughAllPairs) {
  std::mt19937 random(7);
  std::size_t left_out = 0, listed = 0;
  for (int round = 0; round < 200; ++round) {
    // places on both sides of zero, many on edges of cells, at distances of about `apart`
    const double apart = std::array<double, 4>{0.25, 0.1, 1e-6, 3}[random() % 4];
    const std::size_t size = 1 + random() % 20;
    DifferentGrips tested(size, apart);
    std::vector<Candidate> expected;
    std::vector<std::optional<PosedHand>> hands;
    for (std::uint64_t i = 0; i < 150; ++i) {
      const auto place = [&] { return (static_cast<double>(random() % 17) - 8) * 0.5 * apart; };
      std::optional<PosedHand> hand = hand_at(place(), place(), place());
      if (random() % 40 == 0) hand.reset();
      bool differs = true;
      for (const auto& other : hands) differs = differs && are_different(hand, other, apart);
      EXPECT_EQ(tested.differs(hand), differs) << round << " " << i;
      tested.offer({1, i}, hand);
      if (!differs) ++left_out;
      if (!differs || expected.size() == size) continue;
      expected.push_back({1, i});
      hands.push_back(hand);
      ++listed;
    }
    ASSERT_EQ(tested.chosen().size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(tested.chosen()[k].index, expected[k].index) << round;
    EXPECT_EQ(tested.is_full(), expected.size() == size);
  }
  EXPECT_GT(left_out, 1000u);
  EXPECT_GT(listed, 1000u);
}

}  // namespace
}  // namespace wholehand::sweeps

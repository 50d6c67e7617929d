// SPDX-License-Identifier: MIT
// Hands of virtual people: of the person's size, with the person's proportions, and each of them closes.
#include <gtest/gtest.h>

#include <cmath>

#include "core/people/person.h"
#include "core/prepare.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

TEST(PersonHand, HasThePersonsSizeAndCloses) {
  int shortened = 0, open = 0;
  const HandData plain;
  constexpr int COUNT = 500;
  for (std::uint64_t n = 0; n < COUNT; ++n) {
    const Person person = draw_person({}, 5, n);
    const HandData hand = hand_of({}, person);
    EXPECT_NEAR(size_of(hand).length, person.hand.length, 1e-14);
    EXPECT_NEAR(size_of(hand).breadth, person.hand.breadth, 1e-14);
    const PreparedHand prepared = prepare_hand(hand, 2);  // throws if the gap did not fall
    // docs/people.md: up to 13 mm stay between the pads, of 7 % of the hands; a half is shortened, by a sixth at most
    const double apart = prepared.gap_closed - hand.fingers[0].radii[3] - hand.fingers[1].radii[4];
    EXPECT_LT(apart, 13e-3) << n;
    open += apart > 0;
    const double end = (hand.mcp.closed - hand.mcp.open) / (plain.mcp.closed - plain.mcp.open);
    EXPECT_GE(end, 5.0 / 6) << n;
    shortened += end < 1;
  }
  // five deviations of a share of 500
  EXPECT_NEAR(shortened, 0.5 * COUNT, 5 * std::sqrt(0.25 * COUNT));
  EXPECT_NEAR(open, 0.07 * COUNT, 5 * std::sqrt(0.07 * 0.93 * COUNT));
}

TEST(PersonHand, OfTheMeanPersonHasTheDefaultsShares) {
  PeopleData people;
  people.scatter = 0;
  const HandData hand = hand_of({}, make_person(people, {})), plain;
  const double ratio = 187.18 / 187.17;
  for (std::size_t f = 0; f < FINGER_COUNT; ++f)
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(hand.fingers[f].segments[k], ratio * plain.fingers[f].segments[k], 1e-14);
  EXPECT_EQ(hand.mcp.closed, plain.mcp.closed);
}

TEST(PersonHand, KeepsWhatIsNotSize) {
  HandData plain;
  plain.handedness = Handedness::left;
  plain.scale = 1.3;
  plain.between = 5;
  plain.depth_limit = 7e-3;
  const HandData hand = hand_of(plain, draw_person({}, 5, 1));
  EXPECT_EQ(hand.handedness, Handedness::left);
  EXPECT_EQ(hand.scale, 1);
  EXPECT_EQ(hand.between, 5);
  EXPECT_EQ(hand.depth_limit, 7e-3);
}

// The size of the scene's hand has no influence, whatever else the scene says of the hand: proportions alone distinguish hands.
TEST(PersonHand, IsTheSameOfAHandOfAnySize) {
  HandData thin = left_hand();
  for (FingerData& finger : thin.fingers) finger.radii.fill(0);
  HandData own;
  own.fingers[1].segments[2] *= 1.1;
  own.fingers[4].base[0] += 2e-3;
  own.fingers[3].radii[2] = 9e-3;
  for (const HandData& plain : {paper_hand(), left_hand(), thin, own, odd_hand()})
    for (const HandSize& size : {HandSize{0.26, 0.1}, HandSize{0.16, 0.09}}) {
      HandData sized = plain;
      set_size(sized, size);
      sized.scale = 1.7;
      for (std::uint64_t n = 0; n < 20; ++n) {
        const Person person = draw_person({}, 5, n);
        const HandData hand = hand_of(sized, person), expected = hand_of(plain, person);
        EXPECT_EQ(hand.handedness, plain.handedness);
        EXPECT_EQ(hand.scale, expected.scale);
        // m: sums and products of lengths under 0.3 m
        for (std::size_t f = 0; f < FINGER_COUNT; ++f) {
          for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(hand.fingers[f].base[k], expected.fingers[f].base[k], 1e-15);
          for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(hand.fingers[f].segments[k], expected.fingers[f].segments[k], 1e-15);
          for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(hand.fingers[f].radii[k], expected.fingers[f].radii[k], 1e-15);
        }
      }
    }
}

// A hand whose thumb and index finger pass each other before the end: its trajectories end where they are nearest.
TEST(PersonHand, TrajectoriesEndWhereTheGapTurns) {
  HandData passing;
  passing.pip.closed = radians(70);
  ASSERT_LT(gap_falls_until(passing), 1);
  Person person;
  person.segments.fill(1);
  person.hand = size_of(passing);
  const HandData hand = hand_of(passing, person);
  EXPECT_LT(hand.pip.closed, passing.pip.closed);
  EXPECT_EQ(hand.pip.open, passing.pip.open);
  EXPECT_EQ(gap_falls_until(hand), 1);
  EXPECT_EQ(gap_falls_until(paper_hand()), 1);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Sizes of hands: as measured on the posed flat hand, and as a survey of people has them.
#include "core/hand_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/normal.h"
#include "core/hand.h"
#include "core/prepare.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// m: sums of at most five lengths under 0.3 m, and products of them.
constexpr double SIZE_ROUNDING = 1e-15;

// The tip of a finger, or its MCP, with every joint straight.
core_f64::Vec3 straight(const core_f64::Hand& hand, std::size_t finger, std::size_t segments) {
  core_f64::Vec3 at = hand.frame[finger].base;
  for (std::size_t k = 0; k < segments; ++k) at = core_f64::segment_end(hand.frame[finger], at, hand.length[finger][k], 0);
  return at;
}

// By the kernel that poses hands, which shares no code with the size.
HandSize measured(const HandData& data) {
  const core_f64::Hand hand = ready_hand(data);
  HandSize size;
  size.length = -straight(hand, 2, 4).z;
  size.breadth = straight(hand, 4, 1).x + hand.radius[4][1] - straight(hand, 1, 1).x + hand.radius[1][1];
  return size;
}

HandData sized(const HandSize& size) {
  HandData hand;
  set_size(hand, size);
  return hand;
}

TEST(HandSize, OfThePapersHandIsWhatTheReferenceSays) {
  EXPECT_NEAR(size_of(paper_hand()).length, 186.91e-3, SIZE_ROUNDING);
  EXPECT_NEAR(size_of(paper_hand()).breadth, 69.24e-3, 5e-6);  // in two digits
}

// The paper's hand, at the survey's means of as many women as men: each number of the default is that to 0.01 mm.
TEST(HandSize, TheDefaultHandIsTheMeanAdults) {
  HandData mean = paper_hand();
  const HandSurvey &women = hand_survey(Sex::female), &men = hand_survey(Sex::male);
  set_size(mean, {(women.length.mean + men.length.mean) / 2, (women.breadth.mean + men.breadth.mean) / 2});
  const HandData plain;
  for (std::size_t f = 0; f < FINGER_COUNT; ++f) {
    const FingerData &is = plain.fingers[f], &wanted = mean.fingers[f];
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(is.base[k], wanted.base[k], 5e-6);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(is.segments[k], wanted.segments[k], 5e-6);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(is.radii[k], wanted.radii[k], 5e-6);
    EXPECT_EQ(is.splay, wanted.splay);
    EXPECT_EQ(is.arch, wanted.arch);
  }
}

TEST(HandSize, IsMeasuredOnThePosedFlatHand) {
  for (const HandData& hand : {HandData{}, odd_hand(), sized({0.2, 0.07})}) {
    EXPECT_NEAR(size_of(hand).length, measured(hand).length, 1e-14);
    EXPECT_NEAR(size_of(hand).breadth, measured(hand).breadth, 1e-14);
  }
}

TEST(HandSize, IsTheOneThatWasAskedFor) {
  for (const HandSize wanted : {HandSize{0.1, 0.049}, HandSize{0.165, 0.072}, HandSize{0.19, 0.1}, HandSize{0.3, 0.06}}) {
    const HandSize is = measured(sized(wanted));
    EXPECT_NEAR(is.length, wanted.length, SIZE_ROUNDING);
    EXPECT_NEAR(is.breadth, wanted.breadth, SIZE_ROUNDING);
  }
  // to the default's own size: the default, to rounding
  const HandData same = sized(size_of({})), plain;
  for (std::size_t f = 0; f < FINGER_COUNT; ++f)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(same.fingers[f].base[k], plain.fingers[f].base[k], SIZE_ROUNDING);
}

// One length or breadth, all of its parts: no angle changes.
TEST(HandSize, LengthsAndRadiiHaveARatioEach) {
  const HandData hand = sized({1.1 * size_of({}).length, 1.3 * size_of({}).breadth}), plain;
  for (std::size_t f = 0; f < FINGER_COUNT; ++f) {
    const FingerData &finger = hand.fingers[f], &before = plain.fingers[f];
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(finger.segments[k], 1.1 * before.segments[k], SIZE_ROUNDING);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(finger.radii[k], 1.3 * before.radii[k], SIZE_ROUNDING);
    for (const std::size_t k : {1, 2}) EXPECT_NEAR(finger.base[k], 1.1 * before.base[k], SIZE_ROUNDING);
    EXPECT_EQ(finger.splay, before.splay);
    EXPECT_EQ(finger.arch, before.arch);
  }
  // each knuckle as much further from the index finger's
  const core_f64::Hand posed = ready_hand(hand), was = ready_hand(plain);
  for (const std::size_t f : {2, 3, 4}) {
    EXPECT_NEAR(straight(posed, f, 1).x - straight(posed, 1, 1).x, 1.3 * (straight(was, f, 1).x - straight(was, 1, 1).x),
                SIZE_ROUNDING);
  }
}

TEST(HandSize, AHandOfAnySizeClosesAsTheDefaultDoes) {
  const core_f64::Hand plain = ready_hand({});
  for (const HandSize size : {HandSize{0.1, 0.049}, HandSize{0.15, 0.1}, HandSize{0.3, 0.06}}) {
    const core_f64::Hand hand = ready_hand(sized(size));  // refused if its gap did not fall
    const double ratio = size.length / size_of({}).length;
    for (const double closure : {0.0, 0.3, 0.8, 1.0}) {
      EXPECT_NEAR(core_f64::gap_at(hand, closure), ratio * core_f64::gap_at(plain, closure), 1e-15);
    }
  }
}

TEST(HandSize, TheMedianPersonHasTheSurveysMeans) {
  EXPECT_EQ(surveyed_size(Sex::female, 50).length, 181.08e-3);
  EXPECT_EQ(surveyed_size(Sex::female, 50).breadth, 78.15e-3);
  EXPECT_EQ(surveyed_size(Sex::male, 50).length, 193.28e-3);
  EXPECT_EQ(surveyed_size(Sex::male, 50).breadth, 88.26e-3);
}

// The survey's own percentiles, in whole mm; the normal distribution's are within 1.5 mm of them.
TEST(HandSize, PercentilesAreNearTheSurveysCounted) {
  struct Counted {
    Sex sex;
    double percentile, length, breadth;
  };
  for (const Counted& c : {Counted{Sex::female, 5, 165, 72}, Counted{Sex::female, 50, 180, 78}, Counted{Sex::female, 95, 199, 85},
                           Counted{Sex::male, 5, 177, 81}, Counted{Sex::male, 50, 193, 88}, Counted{Sex::male, 95, 210, 96}}) {
    const HandSize size = surveyed_size(c.sex, c.percentile);
    EXPECT_NEAR(size.length, c.length * 1e-3, 1.5e-3);
    EXPECT_NEAR(size.breadth, c.breadth * 1e-3, 1.5e-3);
  }
}

TEST(HandSize, MomentsOfThePercentilesAreTheSurveys) {
  constexpr int COUNT = 10000;
  for (const Sex sex : {Sex::female, Sex::male}) {
    double sum = 0, squares = 0;
    for (int k = 0; k < COUNT; ++k) {
      const double length = surveyed_size(sex, 100 * (k + 0.5) / COUNT).length;
      sum += length;
      squares += length * length;
    }
    const double mean = sum / COUNT;
    // the middles of 10,000 cells lose a 2e-4th of the deviation in the tails
    EXPECT_NEAR(mean, hand_survey(sex).length.mean, 1e-9);
    EXPECT_NEAR(std::sqrt(squares / COUNT - mean * mean) / hand_survey(sex).length.deviation, 1, 5e-4);
  }
}

// The regression that docs/method.md prints.
TEST(HandSize, TheExpectedBreadthIsARegressionOverBothSexes) {
  EXPECT_NEAR(expected_breadth(187.18e-3), 83.205e-3, 1e-9);
  EXPECT_NEAR((expected_breadth(0.2) - expected_breadth(0.18)) / 0.02, 0.397, 5e-4);
}

}  // namespace
}  // namespace wholehand

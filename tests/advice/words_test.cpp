// SPDX-License-Identifier: MIT
// Known advice in words.
// sanitizers: address
#include "advice/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace wholehand {
namespace {

constexpr double NEVER = std::numeric_limits<double>::infinity();

GripInput moved(double height_mm, double roll_deg = 0, double obliquity_deg = 0, double azimuth_deg = 0, double offset_mm = 0) {
  return {0.05 + 1e-3 * height_mm, radians(azimuth_deg), radians(obliquity_deg), radians(roll_deg), 1e-3 * offset_mm, 1};
}

TEST(WayWords, SayEachWholeUnitAndNothingOfLess) {
  const std::vector<std::pair<GripInput, std::string>> table{
      {moved(8, 12), "8 mm higher, turn 12 degrees"},
      {moved(-8, -12), "8 mm lower, turn 12 degrees back"},
      {moved(1, 1), "1 mm higher, turn 1 degree"},
      {moved(0.4, 0.4), ""},
      {moved(0, 0, 5), "index finger 5 degrees up"},
      {moved(0, 0, -1), "index finger 1 degree down"},
      {moved(0, 0, 0, 20), "around by 20 degrees to the left"},
      {moved(0, 0, 0, -20), "around by 20 degrees to the right"},
      {moved(0, 0, 0, 0, 3), "3 mm nearer to you"},
      {moved(2, 0, 0, 0, -3), "2 mm higher, 3 mm further from you"},
  };
  for (const auto& [to, words] : table) EXPECT_EQ(way_words(moved(0), to), words);
  // a line that runs backwards has the other side towards the user
  EXPECT_EQ(way_words(moved(0, 0, 0, 180), moved(0, 0, 0, 180, 3)), "3 mm further from you");
}

TEST(EffortWords, AreShares) {
  EXPECT_EQ(effort_words(0.21), ".21");
  EXPECT_EQ(effort_words(0.094), ".09");
  EXPECT_EQ(effort_words(1.3), "1.30");
  EXPECT_EQ(effort_words(NEVER), "more than any strength");
}

Advice free_hand(double from, double to) {
  Advice advice;
  advice.vessel = 0;
  advice.present = {moved(0), true, from, 0};
  advice.best = RatedGrip{moved(8, 12), true, to, 0};
  advice.is_better = true;
  return advice;
}

TEST(AdviceWords, OfAHandOnItsWay) {
  EXPECT_EQ(advice_words({}), "");
  EXPECT_EQ(advice_words(free_hand(0.21, 0.09)), "8 mm higher, turn 12 degrees: effort .21 to .09");
  EXPECT_EQ(advice_words(free_hand(NEVER, 0.09)), "8 mm higher, turn 12 degrees: effort more than any strength to .09");
  Advice impossible = free_hand(0, 0.09);
  impossible.present.is_possible = false;
  EXPECT_EQ(advice_words(impossible), "8 mm higher, turn 12 degrees: effort .09; from here no grip is possible");
  Advice good = free_hand(0.09, 0.09);
  good.is_better = false;
  EXPECT_EQ(advice_words(good), "this grip is good: effort .09");
  Advice none = free_hand(0.2, 0.1);
  none.best.reset();
  EXPECT_EQ(advice_words(none), "no grip within reach is possible");
}

Advice held(double effort, double other) {
  Advice advice = free_hand(0.4, 0.38);
  advice.is_held = true;
  advice.is_better = false;
  TiltsAhead ahead;
  ahead.tilts[0] = {radians(60), std::min(0.2, effort), other};
  ahead.tilts[1] = {radians(70), effort, 0.5 * other};
  ahead.count = 2;
  advice.ahead = ahead;
  return advice;
}

TEST(AdviceWords, OfAHandThatHolds) {
  EXPECT_EQ(advice_words(held(0.4, 0.21)), "at 70 degrees the grip needs .40 of your strength; tilt over the other side: .21");
  EXPECT_EQ(advice_words(held(0.4, 0.39)), "at 70 degrees the grip needs .40 of your strength");
  EXPECT_EQ(advice_words(held(NEVER, 0.5)), "at 70 degrees no strength holds this grip; tilt over the other side: .50");
  EXPECT_EQ(advice_words(held(0.05, 0.01)), "this grip is good");
  Advice better = held(0.4, 0.39);
  better.is_better = true;
  better.best->effort = 0.2;
  EXPECT_EQ(advice_words(better),
            "at 70 degrees the grip needs .40 of your strength; another grip, 8 mm higher, turn 12 degrees: effort .40 to .20");
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Known advice in words.
// sanitizers: address
#include "device/advice/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/evaluator.h"
#include "core/vectors.h"
#include "sweeps/grips/hand_nodes.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

constexpr double NEVER = std::numeric_limits<double>::infinity();

GripInput moved(double height_mm, double roll_deg = 0, double obliquity_deg = 0, double azimuth_deg = 0, double offset_mm = 0) {
  return {0.05 + 1e-3 * height_mm, radians(azimuth_deg), radians(obliquity_deg), radians(roll_deg), 1e-3 * offset_mm, 1};
}

TEST(WayWords, SayEachWholeUnitAndNothingOfLess) {
  const std::vector<std::pair<GripInput, std::string>> table{
      {moved(8, 12), "8 mm higher, wrist 12 degrees down"},
      {moved(-8, -12), "8 mm lower, wrist 12 degrees up"},
      {moved(1, 1), "1 mm higher, wrist 1 degree down"},
      {moved(0.4, 0.4), ""},
      {moved(0, 0, 5), "index finger 5 degrees up"},
      {moved(0, 0, -1), "index finger 1 degree down"},
      {moved(0, 0, 0, 20), "around by 20 degrees to the right"},
      {moved(0, 0, 0, -20), "around by 20 degrees to the left"},
      {moved(0, 0, 0, 0, 3), "3 mm towards you"},
      {moved(2, 0, 0, 0, -3), "2 mm higher, 3 mm away from you"},
  };
  for (const auto& [to, words] : table) EXPECT_EQ(way_words(moved(0), to), words);
  const std::string all = way_words(moved(0), moved(8, 12, 5, 20, 3));
  std::size_t last = 0;
  for (const char* part : {"8 mm higher", ", wrist 12", ", index finger 5", ", around by 20", ", 3 mm"}) {
    const std::size_t at = all.find(part);
    ASSERT_NE(at, all.npos) << part << " in " << all;
    EXPECT_GE(at, last) << all;
    last = at;
  }
  // a line that runs backwards has the other side towards the user
  EXPECT_EQ(way_words(moved(0, 0, 0, 180), moved(0, 0, 0, 180, 3)), "3 mm away from you");
}

// The line of a hand at the side of the vessel is moved sideways, and that of a vessel that was turned likewise.
TEST(WayWords, OfTheOffsetAreThoseOfTheWorld) {
  const GripInput at_the_side = moved(0, 0, 0, 80), aside = moved(0, 0, 0, 80, 3);
  EXPECT_EQ(way_words(at_the_side, aside), "3 mm to the right");
  EXPECT_EQ(way_words(moved(0, 0, 0, 100), moved(0, 0, 0, 100, 3)), "3 mm to the right") << "the same on both sides of 90 degrees";
  EXPECT_EQ(way_words(moved(0, 0, 0, -80), moved(0, 0, 0, -80, 3)), "3 mm to the left");
  EXPECT_EQ(way_words(moved(0), moved(0, 0, 0, 0, 3), turned('y', radians(-100))), "3 mm to the left");
  EXPECT_EQ(way_words(moved(0), moved(0, 0, 0, 0, 3), turned('x', radians(80))), "3 mm down") << "the vessel is poured from";
}

// From where a hand's wrist is to where it goes, by the core.
Triple way_of_wrist(const Scene& scene, const GripInput& from, const GripInput& to) {
  const auto core = make_core_evaluator(scene);
  const auto wrist = [&](const GripInput& grip) {
    GripResult result;
    core->grip(0, grip, result);
    EXPECT_EQ(result.reason, Reason::none);
    return sweeps::hand_nodes(scene.hand, grip, result).wrist.position;
  };
  const Triple a = wrist(from), b = wrist(to);
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

struct Turn {
  const char* words;
  int axis;     // along which the wrist goes most
  double sign;  // towards +x, to the right; +y, up; +z, towards the person
};
constexpr std::array<Turn, 6> TURNS{
    {{"right", 0, 1}, {"left", 0, -1}, {"up", 1, 1}, {"down", 1, -1}, {"towards you", 2, 1}, {"away from you", 2, -1}}};

void expect_wrist_to_follow(const Scene& scene, const GripInput& from, const GripInput& to) {
  const std::string words = way_words(from, to, NO_ROTATION, scene.hand.handedness);
  const auto turn = std::find_if(TURNS.begin(), TURNS.end(), [&](const Turn& t) { return words.ends_with(t.words); });
  ASSERT_NE(turn, TURNS.end()) << words;
  const Triple gone = way_of_wrist(scene, from, to);
  EXPECT_GT(turn->sign * gone[static_cast<std::size_t>(turn->axis)], 0.5 * norm(gone))
      << words << ", from azimuth " << degrees(from.azimuth) << ", roll " << degrees(from.roll);
}

// The words for a turned hand say where its wrist then is, by the core: in front of the vessel, behind it and at its sides, beside
// it and above it, for either hand. The wrist is not straight behind the line of the tips, so it goes that way by more than half.
TEST(WayWords, OfTurnsAreWhereTheWristGoes) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    Scene scene = scene_of({beaker1()});
    scene.hand.handedness = handedness;
    for (const double azimuth : {0.0, 90.0, 180.0, -90.0}) {
      for (const double way : {-10.0, 10.0}) {
        expect_wrist_to_follow(scene, moved(10, -10, 0, azimuth), moved(10, -10 + way, 0, azimuth));
        expect_wrist_to_follow(scene, moved(10, -80, 0, azimuth), moved(10, -80 + way, 0, azimuth));
        expect_wrist_to_follow(scene, moved(10, -10, 0, azimuth), moved(10, -10, 0, azimuth + way));
      }
    }
  }
}

TEST(EffortWords, AreShares) {
  EXPECT_EQ(effort_words(0.21), "0.21");
  EXPECT_EQ(effort_words(0.094), "0.09");
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
  EXPECT_EQ(advice_words(free_hand(0.21, 0.09)), "8 mm higher, wrist 12 degrees down: effort 0.21 to 0.09");
  EXPECT_EQ(advice_words(free_hand(NEVER, 0.09)), "8 mm higher, wrist 12 degrees down: effort more than any strength to 0.09");
  Advice impossible = free_hand(0, 0.09);
  impossible.present.is_possible = false;
  EXPECT_EQ(advice_words(impossible), "8 mm higher, wrist 12 degrees down: effort 0.09; from here no grip is possible");
  Advice good = free_hand(0.09, 0.09);
  good.is_better = false;
  EXPECT_EQ(advice_words(good), "this grip is good: effort 0.09");
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
  EXPECT_EQ(advice_words(held(0.4, 0.21)), "at 70 degrees the grip needs 0.40 of your strength; tilt over the other side: 0.21");
  EXPECT_EQ(advice_words(held(0.4, 0.39)), "at 70 degrees the grip needs 0.40 of your strength");
  EXPECT_EQ(advice_words(held(NEVER, 0.5)), "at 70 degrees no strength holds this grip; tilt over the other side: 0.50");
  EXPECT_EQ(advice_words(held(0.05, 0.01)), "this grip is good");
  Advice unrated = held(0.05, 0.01);
  unrated.present.is_possible = false;
  EXPECT_EQ(advice_words(unrated), "");
  unrated.ahead = TiltsAhead{};
  EXPECT_EQ(advice_words(unrated), "");
  unrated.is_better = true;
  EXPECT_EQ(advice_words(unrated), "another grip, 8 mm higher, wrist 12 degrees down: effort 0.38") << "the ghost that is shown";
  Advice better = held(0.4, 0.39);
  better.is_better = true;
  better.best->effort = 0.2;
  EXPECT_EQ(
      advice_words(better),
      "at 70 degrees the grip needs 0.40 of your strength; another grip, 8 mm higher, wrist 12 degrees down: effort 0.40 to 0.20");
}

}  // namespace
}  // namespace wholehand::device

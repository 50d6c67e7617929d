// SPDX-License-Identifier: MIT
// The grips of a question lie within reach: half of them about the best one, the others new with each turn.
// sanitizers: address
#include "device/advice/cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

GripInput somewhere() {
  GripInput grip{0.05, 0.3, 0.1, -0.5, 4e-3, 1};
  return grip;
}

TEST(Cloud, LiesWithinReachAndFillsIt) {
  const Reach reach = reach_of(beaker1(), somewhere());
  const std::vector<GripInput> grips = grip_cloud(reach, somewhere(), {}, 1, 5, 1024);
  ASSERT_EQ(grips.size(), 1024u);
  for (const GripInput& grip : grips) EXPECT_TRUE(reach.has(grip));
  for (const auto place : {&GripInput::height, &GripInput::obliquity, &GripInput::roll, &GripInput::offset}) {
    const auto [low, high] =
        std::minmax_element(grips.begin(), grips.end(), [&](const auto& a, const auto& b) { return a.*place < b.*place; });
    const double size = reach.high.*place - reach.low.*place;
    EXPECT_LT((*low).*place, reach.low.*place + 0.02 * size);
    EXPECT_GT((*high).*place, reach.high.*place - 0.02 * size);
  }
  EXPECT_EQ(way_between(grips.front(), somewhere()), 0);
  for (const GripInput& grip : grips) EXPECT_EQ(grip.azimuth, 0.3);  // which changes nothing on a beaker
}

TEST(Cloud, ItsSecondHalfIsAboutTheBest) {
  const Reach reach = reach_of(beaker1(), somewhere());
  GripInput best = somewhere();
  best.height = reach.high.height;  // at the end of the reach: the box is cut there
  const std::vector<GripInput> grips = grip_cloud(reach, somewhere(), best, 0.1, 5, 512);
  for (std::size_t k = 256; k < grips.size(); ++k) {
    EXPECT_TRUE(reach.has(grips[k]));
    EXPECT_LE(std::abs(grips[k].height - best.height), 0.1 * REACH_HEIGHT + 1e-12);
    EXPECT_LE(std::abs(grips[k].roll - best.roll), 0.1 * REACH_ROLL + 1e-12);
  }
}

TEST(Cloud, EachTurnAsksAboutOthersAndTheSameTurnAboutTheSame) {
  const Reach reach = reach_of(beaker1(), somewhere());
  const auto cloud = [&](std::uint64_t turn) { return grip_cloud(reach, somewhere(), {}, 1, turn, 64); };
  for (std::size_t k = 1; k < 64; ++k) {
    EXPECT_EQ(way_between(cloud(3)[k], cloud(3)[k]), 0);
    EXPECT_NE(cloud(3)[k].height, cloud(4)[k].height);
  }
}

TEST(Cloud, KeepsToTheVesselAndItsAxis) {
  GripInput low = somewhere();
  low.height = -0.3;
  low.offset = 0.12;  // the hand is beside the vessel
  const VesselData vessel = beaker1();
  const Reach reach = reach_of(vessel, low);
  EXPECT_EQ(reach.low.height, vessel.base);
  EXPECT_EQ(reach.high.height, vessel.base);
  EXPECT_EQ(reach.low.offset, -MOST_OFFSET);
  EXPECT_EQ(come_in(low).offset, 0);
  EXPECT_EQ(come_in(somewhere()).offset, 4e-3);
}

// Coordinates that the reach leaves free do not change.
TEST(Cloud, AGripOfBeforeTurnsWithTheHandWhereThatChangesNothing) {
  GripInput before = somewhere();
  before.azimuth += 0.01;
  before.height += 0.01;
  GripInput turned = before;
  turned.azimuth = somewhere().azimuth;
  EXPECT_EQ(way_between(reach_of(beaker1(), somewhere()).with_kept(before), turned), 0);
  EXPECT_EQ(way_between(reach_of(lopsided(), somewhere()).with_kept(before), before), 0);
  turned.offset = 0;
  EXPECT_EQ(way_between(reach_of(lopsided(), somewhere(), true).with_kept(before), turned), 0);
}

TEST(Cloud, TurnsAboutVesselsOnWhichThatMatters) {
  const Reach reach = reach_of(lopsided(), somewhere());
  EXPECT_NEAR(reach.high.azimuth - reach.low.azimuth, 2 * REACH_AZIMUTH, 1e-12);
  const Reach kept = reach_of(lopsided(), somewhere(), true);
  EXPECT_EQ(kept.high.azimuth, kept.low.azimuth);
  EXPECT_EQ(kept.high.offset, 0);
}

}  // namespace
}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
#include "device/grippers/haply_tips.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/vectors.h"
#include "device/loop/guard.h"

namespace wholehand::device {
namespace {

Triple unit(const Triple& v) {
  const double size = norm(v);
  return {v[0] / size, v[1] / size, v[2] / size};
}
Triple column(const Rotation& r, std::size_t k) { return {r[k], r[3 + k], r[6 + k]}; }

// A rotation by the angle between +x and the direction is the smallest that does it: its trace is 1 + 2 cos.
TEST(HaplyTips, TheRotationIsTheSmallestToTheLine) {
  EXPECT_EQ(rotation_along({1, 0, 0}, {}), NO_ROTATION);
  for (const Triple& way : {Triple{1, 2, 3}, {-1, 2, -3}, {0, 0, 1}, {0, -1, 0}, {-5, 0.5, 0}}) {
    const Triple direction = unit(way);
    const Rotation rotation = rotation_along(direction, NO_ROTATION);
    EXPECT_TRUE(is_rotation(rotation, 1e-12));
    EXPECT_NEAR(distance(column(rotation, 0), direction), 0, 1e-15);
    EXPECT_NEAR(rotation[0] + rotation[4] + rotation[8], 1 + 2 * direction[0], 1e-12);
  }
}

TEST(HaplyTips, ALineThatIsTurnedRoundKeepsItsRotation) {
  const Rotation before = rotation_along(unit({-1, 0.2, 0}), NO_ROTATION);
  EXPECT_EQ(rotation_along({-1, 0, 0}, before), before);
  EXPECT_EQ(rotation_along(unit({-1, 0.01, 0.01}), before), before);
}

TEST(HaplyTips, TheLineFollowsTipsThatAreApartAtOnceButNoFasterThanAWrist) {
  ClosingLine line;
  EXPECT_EQ(line.direction(), (Triple{1, 0, 0}));
  const double turn = 0.9 * ClosingLine::TURN * 1e-3;  // rad in one millisecond
  line.follow({0.05 * std::cos(turn), 0.05 * std::sin(turn), 0}, 1e-3);
  EXPECT_NEAR(line.direction()[1], std::sin(turn), 1e-12);
  line = {};
  line.follow({0, 0.05, 0}, 1e-3);
  EXPECT_NEAR(std::atan2(line.direction()[1], line.direction()[0]), ClosingLine::TURN * 1e-3, 1e-12);
  EXPECT_NEAR(norm(line.direction()), 1, 1e-15);
  for (int tick = 0; tick < 40; ++tick) line.follow({0, 0.05, 0}, 1e-3);
  EXPECT_EQ(line.direction(), (Triple{0, 1, 0})) << "90 degrees at 50 rad/s take 31 ms";
}

// Whatever the tips do in their contact, the guard sees no turn that it takes for a jump.
TEST(HaplyTips, TipsThatTouchTurnNothing) {
  ClosingLine line;
  line.follow({0, 0, 0}, 1);
  line.follow({NAN, 0, 0}, 1);
  EXPECT_EQ(line.direction(), (Triple{1, 0, 0}));
  line.follow({0, 0, -1e-3}, 1e-3);
  EXPECT_NEAR(std::acos(line.direction()[0]), ClosingLine::TURN * 1e-3 / 400, 1e-9) << "a twentieth of the distance";
  line = {};
  line.follow({-0.05, 0, 0}, 1e-3);
  EXPECT_EQ(line.direction(), (Triple{1, 0, 0})) << "opposite: there is no way that is shorter than another";
  EXPECT_LT(ClosingLine::TURN, JUMP_TURN);
}

TEST(HaplyTips, AForceIsSharedAndAGripIsOpposite) {
  const Triple along = unit({1, 2, 2});
  const Triple across{0.5, -0.25, 0.125};
  const auto tips = tip_forces({{1, -2, 3}, 1.5, across}, along, 10);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(tips[0][axis] + tips[1][axis], (Triple{1, -2, 3})[axis], 1e-15);
    EXPECT_NEAR((tips[1][axis] - tips[0][axis]) / 2, 1.5 * along[axis] + across[axis], 1e-15)
        << "a positive grip pushes the tips apart";
  }
}

TEST(HaplyTips, NoTipGetsMoreThanItsDeviceBears) {
  const auto tips = tip_forces({{0, -20, 0}, 0}, {1, 0, 0}, 4);
  EXPECT_EQ(tips[0], (Triple{0, -4, 0}));
  const auto one = tip_forces({{-10, 0, 0}, 5}, {1, 0, 0}, 8);
  EXPECT_EQ(one[0], (Triple{-8, 0, 0}));
  EXPECT_EQ(one[1], (Triple{0, 0, 0})) << "the other one is as it was";
}

}  // namespace
}  // namespace wholehand::device

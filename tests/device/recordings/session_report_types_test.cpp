// SPDX-License-Identifier: MIT
// Sessions made up from known courses: the types of grip force, and what has none.
// sanitizers: address
#include "device/recordings/session_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/recorded_session.h"

namespace wholehand::device {
namespace {

TEST(SessionReport, TypeG1WhereGripRisesAsTheNormalForceDoes) {
  const auto rise = [](double more) {
    return only_grasp(tilted_session(
        radians(90), [more](double x) { return linear_between(x, 3, 4.2 + more); },
        [](double x) { return linear_between(x, 0.8, 2); }));
  };
  EXPECT_EQ(rise(0).course, GripCourse::equal);
  EXPECT_EQ(rise(0.09).course, GripCourse::equal);
  EXPECT_EQ(rise(-0.09).course, GripCourse::equal);
  EXPECT_EQ(rise(0.11).course, GripCourse::more);
  EXPECT_EQ(rise(-0.11).course, GripCourse::less);
  EXPECT_NEAR(rise(0).grip_change, 1.2, 1e-3);
}

TEST(SessionReport, TypeG2WhereItRisesMore) {
  EXPECT_EQ(only_grasp(tilted_session(
                           radians(90), [](double x) { return linear_between(x, 3, 6); },
                           [](double x) { return linear_between(x, 0.8, 2); }))
                .course,
            GripCourse::more);
}

TEST(SessionReport, TypeG3WhereItRisesLessOrFalls) {
  const auto normal = [](double x) { return linear_between(x, 0.8, 2); };
  EXPECT_EQ(only_grasp(tilted_session(
                           radians(90), [](double) { return 3; }, normal))
                .course,
            GripCourse::less);
  EXPECT_EQ(only_grasp(tilted_session(
                           radians(90), [](double x) { return linear_between(x, 3, 2); }, normal))
                .course,
            GripCourse::less);
}

TEST(SessionReport, TypeG4WhereItTurnsBack) {
  const auto normal = [](double x) { return linear_between(x, 0.8, 2); };
  const auto swing = [](double size) { return [size](double x) { return 3 + 1.2 * x + size * std::sin(4 * PI * x); }; };
  const GraspReport grasp = only_grasp(tilted_session(radians(90), swing(0.5), normal));
  EXPECT_EQ(grasp.course, GripCourse::complex);
  EXPECT_GT(grasp.turning_back, 0.2);
  // the same ends: only the way between them differs
  EXPECT_EQ(only_grasp(tilted_session(radians(90), swing(0.05), normal)).course, GripCourse::equal);
  // up and down again
  EXPECT_EQ(only_grasp(tilted_session(
                           radians(90), [](double x) { return 3 + std::sin(PI * x); }, normal))
                .course,
            GripCourse::complex);
  // what trembles ten times a second is no course
  EXPECT_EQ(only_grasp(tilted_session(
                           radians(90), [](double x) { return 3 + 1.2 * x + 0.15 * std::sin(40 * PI * x); }, normal))
                .course,
            GripCourse::equal);
}

// Beyond 90 degrees the torque falls again. A grip that follows it turns back with it, and is not complex for that.
TEST(SessionReport, FollowingANormalForceThatFallsIsNotComplex) {
  const auto normal = [](double x) { return 0.8 + std::sin(radians(140) * x); };
  const GraspReport grasp = only_grasp(tilted_session(
      radians(140), [&](double x) { return 2 + normal(x); }, normal));
  EXPECT_EQ(grasp.course, GripCourse::equal);
  EXPECT_NEAR(grasp.turning_back, 0, 1e-9);
}

// At F_max the gripper clamps, so the user does not cause the apparent changes of the grip force.
TEST(SessionReport, WhatSaturatesWhileItIsTiltedHasNoType) {
  const auto grip = [](double) { return 3.0; };
  const auto normal = [](double x) { return linear_between(x, 0.8, 2); };
  RecordedSession session = tilted_session(radians(90), grip, normal);
  session.recording.info.force_max = 8;
  for (Tick& tick : session.recording.ticks) tick.feedback = is_held(tick.state) ? 5 : 0;
  EXPECT_EQ(only_grasp(session).course, GripCourse::less);
  EXPECT_EQ(only_grasp(session).saturated, 0);
  for (Tick& tick : session.recording.ticks)
    if (tick.state == SessionState::lift) tick.feedback = 8;
  EXPECT_NEAR(only_grasp(session).saturated, 1, 1e-9);
  EXPECT_EQ(only_grasp(session).course, GripCourse::less) << "before the tilt";
  for (Tick& tick : session.recording.ticks)
    if (tick.state == SessionState::maintain) tick.feedback = 8;
  EXPECT_NEAR(only_grasp(session).saturated, 2, 1e-9);
  EXPECT_EQ(only_grasp(session).course, GripCourse::not_analyzed);
  EXPECT_NE(session_table(session.report()).find("the feedback was at F_max for 2.000 s"), std::string::npos);
}

TEST(SessionReport, TiltsUnder30DegreesAreNotAnalyzed) {
  const auto of = [](double tilt) {
    return only_grasp(tilted_session(
        radians(tilt), [](double x) { return linear_between(x, 3, 6); }, [](double x) { return linear_between(x, 0.8, 2); }));
  };
  EXPECT_EQ(of(29).course, GripCourse::not_analyzed);
  EXPECT_EQ(of(31).course, GripCourse::more);
  EXPECT_NEAR(of(29).grip_change, 3, 2e-3) << "measured all the same";
  RecordedSession upright;
  upright.hold(0).stretch(1, SessionState::lift);
  const GraspReport grasp = only_grasp(upright);
  EXPECT_EQ(grasp.course, GripCourse::not_analyzed);
  EXPECT_TRUE(std::isnan(grasp.tilt_start));
  EXPECT_TRUE(std::isnan(grasp.grip_change));
}

}  // namespace
}  // namespace wholehand::device

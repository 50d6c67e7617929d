// SPDX-License-Identifier: MIT
// sanitizers: address
#include "device/simulated/replay_gripper.h"

#include <gtest/gtest.h>

#include <string>

namespace wholehand::device {
namespace {

Tick recorded(std::int64_t number, double gap, ReadOutcome read = ReadOutcome::value, Fault fault = Fault::none) {
  Tick tick;
  tick.number = number;
  tick.read = read;
  tick.fault = fault;
  tick.device.gap = gap;
  tick.device.position = {gap + 1, gap + 2, gap + 3};
  tick.device.buttons = 5;
  tick.device.sequence = static_cast<std::uint32_t>(number);
  return tick;
}

GripperLimits some_limits() {
  GripperLimits limits;
  limits.name = "omega.7";
  limits.address = "replay:a.nc";
  limits.force = 12;
  limits.is_left_handed = true;
  return limits;
}

TEST(ReplayGripper, SaysAgainWhatWasRead) {
  const auto gripper = make_replay({recorded(0, 0.01), recorded(1, 0.02)}, some_limits());
  EXPECT_EQ(gripper->limits().name, "omega.7");
  EXPECT_EQ(gripper->limits().address, "replay:a.nc");
  EXPECT_EQ(gripper->limits().force, 12);
  EXPECT_TRUE(gripper->limits().is_left_handed);
  GripperState state;
  for (const std::int64_t number : {0, 1}) {
    EXPECT_FALSE(gripper->is_done());
    ASSERT_EQ(gripper->replayed_tick(), number);
    ASSERT_EQ(gripper->read(state, number), ReadOutcome::value);
    EXPECT_EQ(state.gap, number == 0 ? 0.01 : 0.02);
    EXPECT_EQ(state.position[2], state.gap + 3);
    EXPECT_EQ(state.sequence, number);
    EXPECT_EQ(state.buttons, 5u);
    EXPECT_TRUE(gripper->write({}));
  }
  EXPECT_TRUE(gripper->is_done());
  EXPECT_EQ(gripper->replayed_tick(), -1);
  EXPECT_EQ(gripper->read(state, 2), ReadOutcome::timeout);
  EXPECT_EQ(state.sequence, 1u) << "left alone";
}

TEST(ReplayGripper, DictatesTheNumbersThatWereRecorded) {
  const auto gripper = make_replay({recorded(3, 0), recorded(4, 0), recorded(9, 0)}, some_limits());
  GripperState state;
  for (const std::int64_t number : {3, 4, 9}) {
    ASSERT_EQ(gripper->replayed_tick(), number);
    EXPECT_EQ(gripper->read(state, number), ReadOutcome::value);
  }
}

// A loop that keeps its own tick numbers gets the record of each number, and a timeout where there is none.
TEST(ReplayGripper, HasNothingForTicksThatWereMissed) {
  const auto gripper = make_replay({recorded(3, 0.1), recorded(5, 0.2)}, some_limits());
  GripperState state;
  EXPECT_EQ(gripper->read(state, 2), ReadOutcome::timeout);
  EXPECT_EQ(gripper->read(state, 3), ReadOutcome::value);
  EXPECT_EQ(gripper->read(state, 4), ReadOutcome::timeout);
  EXPECT_EQ(state.gap, 0.1);
  EXPECT_EQ(gripper->read(state, 5), ReadOutcome::value);
  EXPECT_EQ(state.gap, 0.2);
  const auto other = make_replay({recorded(3, 0.1), recorded(5, 0.2)}, some_limits());
  EXPECT_EQ(other->read(state, 5), ReadOutcome::value);
  EXPECT_TRUE(other->is_done());
}

TEST(ReplayGripper, FailsWhereItFailedThen) {
  const auto gripper = make_replay({recorded(0, 0.1), recorded(1, 0.2, ReadOutcome::timeout), recorded(2, 0.3, ReadOutcome::error),
                                    recorded(3, 0.4, ReadOutcome::value, Fault::write_error), recorded(4, 0.5)},
                                   some_limits());
  GripperState state;
  EXPECT_EQ(gripper->read(state, 0), ReadOutcome::value);
  EXPECT_EQ(gripper->read(state, 1), ReadOutcome::timeout);
  EXPECT_EQ(gripper->read(state, 2), ReadOutcome::error);
  EXPECT_EQ(state.gap, 0.1) << "left alone";
  EXPECT_NE(std::string(gripper->last_error()), "");
  EXPECT_TRUE(gripper->write({}));
  EXPECT_EQ(gripper->read(state, 3), ReadOutcome::value);
  EXPECT_FALSE(gripper->write({}));
  EXPECT_EQ(gripper->release(), ReleaseResult::no_force) << "there is no device that could keep a force";
  EXPECT_EQ(gripper->read(state, 4), ReadOutcome::value);
  EXPECT_TRUE(gripper->write({}));
}

TEST(ReplayGripper, IsDoneWhereTheLoopItselfFailed) {
  for (int k = 0; k < FAULTS; ++k) {
    const auto fault = static_cast<Fault>(k);
    const bool is_of_loop = fault == Fault::late || fault == Fault::ring_full || fault == Fault::interrupted;
    const auto gripper =
        make_replay({recorded(0, 0.1), recorded(1, 0.2, ReadOutcome::value, fault), recorded(2, 0.3)}, some_limits());
    GripperState state;
    EXPECT_EQ(gripper->read(state, 0), ReadOutcome::value);
    EXPECT_EQ(gripper->is_done(), is_of_loop) << FAULT_NAMES[k];
    EXPECT_EQ(gripper->replayed_tick(), is_of_loop ? -1 : 1) << FAULT_NAMES[k];
  }
}

TEST(ReplayGripper, OfNothingIsDoneAtOnce) {
  const auto gripper = make_replay({}, some_limits());
  EXPECT_TRUE(gripper->is_done());
  GripperState state;
  EXPECT_EQ(gripper->read(state, 0), ReadOutcome::timeout);
}

}  // namespace
}  // namespace wholehand::device

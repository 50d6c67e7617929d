// SPDX-License-Identifier: MIT
// Reads of mock grippers on a machine that may be busy.
#pragma once

#include <array>
#include <chrono>
#include <thread>

#include "device/loop/gripper.h"
#include "tests/support/mock_grippers.h"

namespace wholehand {

inline constexpr double PATIENT_WATCHDOG = 1;  // s

// A device whose clock is the machine's.
inline MockSettings on_the_clock() {
  MockSettings settings;
  settings.step = 0;
  return settings;
}

inline void rest(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// A machine that is busy may let no report through within a read's patience: then again, for a minute.
inline device::ReadOutcome read_soon(device::Gripper& gripper, device::GripperState& state) {
  device::ReadOutcome outcome = device::ReadOutcome::timeout;
  for (int i = 0; i < 6000 && outcome == device::ReadOutcome::timeout; ++i) outcome = gripper.read(state, i);
  return outcome;
}

// The outcome once the good reports that still wait have been read.
template <class Read>
device::ReadOutcome first_failure(const Read& read) {
  device::GripperState state;
  device::ReadOutcome outcome = device::ReadOutcome::value;
  for (int i = 0; i < 100 && outcome == device::ReadOutcome::value; ++i) outcome = read(state);
  return outcome;
}
inline device::ReadOutcome first_error(device::Gripper& gripper) {
  return first_failure([&gripper](device::GripperState& state) { return read_soon(gripper, state); });
}

inline bool is_nothing(const device::protocol::OutputReport& report) {
  return report.flags == 0 && report.arm == std::array<std::int32_t, 3>{} && report.grip == 0;
}

// Whether so many reports of the host have arrived, now or in a while: a device takes one a frame.
inline bool arrives(const MockGripper& mock, std::size_t count) {
  for (int i = 0; i < 60000 && mock.outputs().size() < count; ++i) rest(0.001);
  return mock.outputs().size() >= count;
}

}  // namespace wholehand

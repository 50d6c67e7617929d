// SPDX-License-Identifier: MIT
// What every open gripper must do, whatever carries its reports: each check opens a mock through the transport under test.
#pragma once

#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <memory>
#include <string>
#include <thread>

#include "base/text/error.h"
#include "tests/support/mock_grippers.h"
#include "tests/support/patient_reads.h"

namespace wholehand {

template <class Action>
void expect_error(const Action& action, ExitCode code, const std::string& start) {
  try {
    action();
    ADD_FAILURE() << "no error where this was due: " << start;
  } catch (const Error& error) {
    EXPECT_EQ(error.code, code) << error.what();
    EXPECT_TRUE(std::string(error.what()).starts_with(start)) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

// Some hundred cycles: poses as the mock moves, forces as written, its watchdog set, nothing before the first force and nothing
// left.
template <class Open>
void check_session(MockGripper& mock, const Open& open) {
  constexpr int CYCLES = 300;
  constexpr double ROUNDING = 2e-9;  // m, and of a rotation: nanometers and 2^-30, rounded
  std::unique_ptr<device::Gripper> gripper = open();
  EXPECT_EQ(gripper->limits().force, 12);
  EXPECT_EQ(gripper->limits().grip, 8);
  EXPECT_EQ(gripper->limits().rate, 500);
  EXPECT_EQ(gripper->limits().address, mock.address());
  EXPECT_EQ(mock.watchdog().period, 1'000'000u);
  EXPECT_EQ(mock.watchdog().flags, device::protocol::WATCHDOG_ON);
  for (const auto& report : mock.outputs()) EXPECT_TRUE(is_nothing(report)) << "force before the first write";
  const std::size_t before = mock.outputs().size();
  EXPECT_GE(before, 1u) << "a watchdog that tripped earlier stays so";

  device::GripperState state, last;
  const auto force_at = [](int i) { return device::GripperForce{{0.01 * i, -0.02 * i, 0.5}, i % 2 ? 1.25 : -1.25}; };
  for (int i = 0; i < CYCLES; ++i) {
    ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::value) << i << ' ' << gripper->last_error();
    const device::GripperState truth = mock.motion_at(state.time);
    for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(state.position[axis], truth.position[axis], ROUNDING) << i;
    for (std::size_t part = 0; part < 9; ++part) ASSERT_NEAR(state.rotation[part], truth.rotation[part], 2 * ROUNDING) << i;
    ASSERT_NEAR(state.gap, truth.gap, ROUNDING) << i;
    ASSERT_EQ(state.buttons, truth.buttons) << i;
    if (i > 0) {
      ASSERT_GT(state.sequence, last.sequence) << i;
      ASSERT_GT(state.time, last.time) << i;
    }
    last = state;
    ASSERT_TRUE(gripper->write(force_at(i))) << i << ' ' << gripper->last_error();
    // on a busy machine the mock may be the slow one, and a force that waits is overtaken by the next
    ASSERT_TRUE(arrives(mock, before + static_cast<std::size_t>(i) + 1)) << i;
  }
  // over its limits it is scaled, and what is no number does not go out; each after the one before has arrived
  EXPECT_TRUE(gripper->write({{30, 0, -40}, -100}));
  EXPECT_TRUE(arrives(mock, before + CYCLES + 1));
  EXPECT_TRUE(mock.has_force());
  EXPECT_FALSE(gripper->write({{0, std::numeric_limits<double>::quiet_NaN(), 0}, 0}));
  EXPECT_STREQ(gripper->last_error(), "a force that is no number");
  EXPECT_TRUE(arrives(mock, before + CYCLES + 2));
  gripper.reset();

  const auto outputs = mock.outputs();
  EXPECT_EQ(mock.rejected(), 0);
  ASSERT_EQ(outputs.size(), before + CYCLES + 3);
  for (int i = 0; i < CYCLES; ++i) {
    const auto& report = outputs[before + static_cast<std::size_t>(i)];
    const device::GripperForce force = force_at(i);
    for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(report.arm[axis], force.arm[axis] * 1e6, 1) << i;
    ASSERT_NEAR(report.grip, force.grip * 1e6, 1) << i;
    ASSERT_EQ(report.flags, device::protocol::ENABLE) << i;
    ASSERT_EQ(report.sequence, static_cast<std::uint32_t>(i + 1));
  }
  const auto& clamped = outputs[before + CYCLES];
  EXPECT_NEAR(clamped.arm[0], 7.2e6, 1);
  EXPECT_NEAR(clamped.arm[2], -9.6e6, 1);
  EXPECT_EQ(clamped.grip, -8'000'000);
  EXPECT_TRUE(is_nothing(outputs[before + CYCLES + 1]));
  EXPECT_TRUE(is_nothing(outputs.back())) << "force after closing";
  EXPECT_FALSE(mock.has_force());
}

template <class Mock, class Open>
void check_clock(const Open& open) {
  MockBench bench;
  MockSettings settings = on_the_clock();
  settings.first_time = 0xFFFFFFFF - 300'000;  // wraps after 0.3 s
  Mock mock(bench, settings);
  const auto gripper = open(mock);
  device::GripperState state;
  ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::value);
  const double first = state.time;
  double last = first;
  for (int i = 1; last < first + 0.5; ++i) {
    ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::value) << gripper->last_error();
    ASSERT_GT(state.time, last);
    ASSERT_LT(state.time, last + 2);
    last = state.time;
  }
  EXPECT_GT(last, 4294.9673) << "it has not wrapped";
}

template <class Open>
void check_wrong_reports(MockGripper& mock, const Open& open) {
  const struct {
    Mischief mischief;
    const char* words;
  } cases[] = {
      {Mischief::short_report, "a report of the wrong length"},
      {Mischief::long_report, "a report of the wrong length"},
      {Mischief::wrong_version, "a report of another protocol version"},
      {Mischief::wrong_id, "a report of the wrong id"},
      {Mischief::no_rotation, "a quaternion that is no rotation"},
      {Mischief::not_homed, "the device is not homed"},
      {Mischief::fault, "the device reports a fault of its own"},
      {Mischief::number_back, "its sequence numbers go back"},
      {Mischief::alternating, "its sequence numbers go back"},
      {Mischief::clock_back, "its clock steps back"},
      {Mischief::garbage, "a report of the wrong id"},  // what one byte in 256 is not
  };
  for (const auto& [mischief, words] : cases) {
    SCOPED_TRACE(words);
    mock.misbehave(Mischief::none);
    const auto gripper = open();
    mock.misbehave(mischief);
    ASSERT_EQ(first_error(*gripper), device::ReadOutcome::error);
    if (mischief != Mischief::garbage) {
      EXPECT_STREQ(gripper->last_error(), words);
    }
    if (mischief == Mischief::alternating) continue;  // each second one is good
    // the state that was asked for is left alone, and good reports are good again
    device::GripperState state;
    state.sequence = 4711;
    ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::error);
    EXPECT_EQ(state.sequence, 4711u);
    mock.misbehave(Mischief::none);
    device::ReadOutcome outcome = device::ReadOutcome::error;
    for (int i = 0; i < 200 && outcome != device::ReadOutcome::value; ++i) outcome = gripper->read(state, i);
    EXPECT_EQ(outcome, device::ReadOutcome::value) << gripper->last_error();
  }
  // the same measurement again and again is a value: the loop judges it
  mock.misbehave(Mischief::same_sequence);
  const auto gripper = open();
  device::GripperState first, again;
  ASSERT_EQ(read_soon(*gripper, first), device::ReadOutcome::value);
  ASSERT_EQ(read_soon(*gripper, again), device::ReadOutcome::value);
  EXPECT_EQ(first.sequence, again.sequence);
  EXPECT_EQ(first.time, again.time);
}

// On the machine's clock. Both sides let go: the host's read says so within its patience, the device by its watchdog of 200 ms, which stays tripped
// for this session and not for the next.
template <class Open>
void check_silence(MockGripper& mock, const Open& open) {
  std::unique_ptr<device::Gripper> gripper = open();
  EXPECT_EQ(mock.watchdog().period, 200'000u);
  const std::size_t before = mock.outputs().size();
  ASSERT_TRUE(gripper->write({{1, 2, 3}, 1}));
  EXPECT_TRUE(arrives(mock, before + 1));
  EXPECT_TRUE(mock.has_force());
  mock.misbehave(Mischief::silent);
  ASSERT_EQ(first_failure([&gripper](device::GripperState& state) { return gripper->read(state, 0); }),
            device::ReadOutcome::timeout);
  EXPECT_STREQ(gripper->last_error(), "no report");
  const auto start = std::chrono::steady_clock::now();
  device::GripperState state;
  EXPECT_EQ(gripper->read(state, 0), device::ReadOutcome::timeout);
  const double waited = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GE(waited, 0.9 * device::READ_PATIENCE);
  EXPECT_LT(waited, 50 * device::READ_PATIENCE) << "umockdev and a busy machine included";
  for (int k = 0; k < 60000 && (mock.has_force() || !mock.has_tripped()); ++k) rest(1e-3);
  EXPECT_FALSE(mock.has_force());
  EXPECT_TRUE(mock.has_tripped());
  mock.misbehave(Mischief::none);
  gripper->write({{1, 2, 3}, 1});
  EXPECT_FALSE(mock.has_force()) << "it started again with the force of before";
  ASSERT_EQ(first_error(*gripper), device::ReadOutcome::error);
  EXPECT_STREQ(gripper->last_error(), "the device's watchdog has tripped");
  gripper.reset();
  gripper = open();
  EXPECT_EQ(read_soon(*gripper, state), device::ReadOutcome::value) << gripper->last_error();
}

template <class Open>
void check_unplugging(MockGripper& mock, const Open& open) {
  const auto gripper = open();
  device::GripperState state;
  for (int i = 0; i < 5; ++i) ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::value);
  ASSERT_TRUE(gripper->write({{1, 0, 0}, 0}));
  mock.unplug();
  ASSERT_EQ(first_error(*gripper), device::ReadOutcome::error);
  EXPECT_STREQ(gripper->last_error(), "unplugged");
  EXPECT_EQ(read_soon(*gripper, state), device::ReadOutcome::error);
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->last_error(), "unplugged");
  EXPECT_EQ(gripper->release(), device::ReleaseResult::refused);
  EXPECT_STREQ(gripper->last_error(), "unplugged");
  EXPECT_EQ(gripper->panic(), device::ReleaseResult::refused) << "nothing was written";
}

// A handler for a signal while it lives.
class Handler {
 public:
  Handler(int signal, void (*function)(int)) : signal_(signal) {
    struct sigaction action {};
    action.sa_handler = function;  // and not SA_RESTART: calls are interrupted
    sigaction(signal, &action, &before_);
  }
  ~Handler() { sigaction(signal_, &before_, nullptr); }
  Handler(const Handler&) = delete;
  Handler& operator=(const Handler&) = delete;

 private:
  int signal_;
  struct sigaction before_ {};
};

// Out of a signal handler. Whatever is written after it has no force either.
template <class Open>
void check_panic(MockGripper& mock, const Open& open) {
  static device::Gripper* frightened;
  const auto gripper = open();
  frightened = gripper.get();
  const std::size_t opened = mock.outputs().size();
  ASSERT_TRUE(gripper->write({{1, 2, 3}, 1}));
  device::GripperState state;
  ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::value);
  ASSERT_TRUE(arrives(mock, opened + 1));
  ASSERT_TRUE(mock.has_force());
  const std::size_t before = mock.outputs().size();
  static device::ReleaseResult outcome;
  outcome = device::ReleaseResult::no_force;
  const Handler handler(SIGUSR1, [](int) { outcome = frightened->panic(); });
  raise(SIGUSR1);
  EXPECT_EQ(outcome, device::ReleaseResult::written);
  ASSERT_EQ(mock.outputs().size(), before + 1);
  EXPECT_TRUE(is_nothing(mock.outputs().back()));
  EXPECT_FALSE(mock.has_force());
  EXPECT_TRUE(gripper->write({{1, 2, 3}, 1}));
  ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::value) << gripper->last_error();
  EXPECT_TRUE(arrives(mock, before + 2));
  EXPECT_TRUE(is_nothing(mock.outputs().back()));
  EXPECT_FALSE(mock.has_force());
}

// From a second thread, and the session goes on afterwards.
template <class Open>
void check_release_from_watchdog(MockGripper& mock, const Open& open) {
  const auto gripper = open();
  const std::size_t before = mock.outputs().size();
  ASSERT_TRUE(gripper->write({{1, 2, 3}, 1}));
  ASSERT_TRUE(arrives(mock, before + 1));
  ASSERT_TRUE(mock.has_force());
  std::thread([&gripper] { EXPECT_EQ(gripper->release_from_watchdog(), device::ReleaseResult::written); }).join();
  ASSERT_TRUE(arrives(mock, before + 2));
  EXPECT_TRUE(is_nothing(mock.outputs().back()));
  EXPECT_FALSE(mock.has_force());
  ASSERT_TRUE(gripper->write({{0, 0, 0.5}, 0}));
  EXPECT_TRUE(arrives(mock, before + 3));
  EXPECT_TRUE(mock.has_force());
  EXPECT_EQ(gripper->release(), device::ReleaseResult::written);
  EXPECT_FALSE(mock.has_force());
  mock.misbehave(Mischief::takes_no_force);
  EXPECT_EQ(gripper->release_from_watchdog(), device::ReleaseResult::refused);
}

// A signal that somebody else handles is no error of the device. Not for USB: of an ioctl() that a signal interrupts umockdev loses
// the error number.
template <class Open>
void check_signals(MockGripper& mock, const Open& open) {
  const Handler handler(SIGUSR1, [](int) {});
  const auto gripper = open();
  mock.misbehave(Mischief::silent);
  const auto read = [&gripper](device::GripperState& state) { return gripper->read(state, 0); };
  ASSERT_EQ(first_failure(read), device::ReadOutcome::timeout);
  std::atomic<bool> is_enough{false};
  std::thread knocking([&is_enough, reader = pthread_self()] {
    for (; !is_enough; rest(1e-3)) pthread_kill(reader, SIGUSR1);
  });
  device::GripperState state;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(read(state), device::ReadOutcome::timeout) << gripper->last_error();
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::duration<double>(20 * 0.9 * device::READ_PATIENCE))
      << "given up early";
  mock.misbehave(Mischief::none);
  EXPECT_EQ(read_soon(*gripper, state), device::ReadOutcome::value) << gripper->last_error();
  is_enough = true;
  knocking.join();
}

// On the machine's clock. Nobody reads for longer than any queue lasts: what still waits then is old, and only a measurement of now is given out.
template <class Open>
void check_old_reports(MockGripper& mock, const Open& open) {
  const auto gripper = open();
  device::GripperState state, next;
  ASSERT_EQ(read_soon(*gripper, state), device::ReadOutcome::value);
  rest(0.4);  // 200 measurements
  mock.misbehave(Mischief::silent);
  EXPECT_EQ(gripper->read(next, 1), device::ReadOutcome::timeout);
  mock.misbehave(Mischief::none);
  ASSERT_EQ(read_soon(*gripper, next), device::ReadOutcome::value) << gripper->last_error();
  EXPECT_GT(next.time, state.time + 0.35);
}

template <class Mock, class Open>
void check_refusals(const Open& open) {
  const auto refused = [&open](const MockSettings& settings, Mischief mischief, double watchdog, ExitCode code,
                               const std::string& words) {
    MockBench bench;
    Mock mock(bench, settings);
    mock.misbehave(mischief);
    const std::string start = code == ExitCode::failure ? mock.address() + ": " + words : words;
    expect_error([&] { open(mock, watchdog); }, code, start);
    mock.misbehave(Mischief::none);
    EXPECT_NO_THROW(open(mock, 0.1)) << "and afterwards it is free";
  };
  const auto refused_for_good = [&open](const MockSettings& settings, const std::string& words) {
    MockBench bench;
    Mock mock(bench, settings);
    expect_error([&] { open(mock, 0.1); }, ExitCode::failure, mock.address() + ": " + words);
    EXPECT_FALSE(mock.has_force());
  };
  refused({}, Mischief::silent, 0.1, ExitCode::failure, "it sends no measurements");
  refused({}, Mischief::not_homed, 0.1, ExitCode::failure, "the device is not homed");
  refused({}, Mischief::short_report, 0.1, ExitCode::failure, "a report of the wrong length");
  refused({}, Mischief::takes_no_force, 0.1, ExitCode::failure, "it takes no force");
  refused({}, Mischief::none, 0.001, ExitCode::usage, "a watchdog of 0.001 s: give 0.002 to 1");
  refused({}, Mischief::none, 1.5, ExitCode::usage, "a watchdog of 1.5 s: give 0.002 to 1");
  refused({}, Mischief::none, std::numeric_limits<double>::quiet_NaN(), ExitCode::usage, "a watchdog of nan s: give 0.002 to 1");
  MockSettings settings;
  settings.version = 2;
  refused_for_good(settings, "it speaks version 2 of the gripper protocol, this program version 1");
  settings = {};
  settings.identity.rate = 0;
  refused_for_good(settings, "it does not say what it is: a number out of its range");
  settings = {};
  settings.keeps_watchdog = true;
  settings.identity.watchdog = 200'000;
  refused_for_good(settings, "asked for a watchdog of 100 ms, it keeps 200 ms");
}

template <class Open, class Find>
void check_second_session(MockGripper& mock, const Open& open, const Find& find) {
  {
    const auto first = open();
    expect_error(open, ExitCode::failure, mock.address() + ": in use by another session");
    const auto found = find();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].address, "");
    EXPECT_EQ(found[0].missing, "in use by another session");
    device::GripperState state;
    EXPECT_EQ(read_soon(*first, state), device::ReadOutcome::value) << first->last_error();
    EXPECT_TRUE(first->write({{1, 0, 0}, 0}));
  }
  EXPECT_NO_THROW(open()) << "closed, and still in use";
}

}  // namespace wholehand

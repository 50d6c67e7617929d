// SPDX-License-Identifier: MIT
// Children that fail, and a gripper that logs to memory shared with the test.
#pragma once

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

#include "device/loop/haptic_loop.h"
#include "device/loop/panic.h"
#include "tests/support/scenes.h"

namespace wholehand {

// What survives the child.
struct PanicLog {
  std::atomic<int> writes{0}, panics{0}, ended{0}, meanwhiles{0};
  std::atomic<double> grip{0};  // the last that was written; panic() writes 0
};

class SharedPanicLog {
 public:
  SharedPanicLog()
      : log_(new (mmap(nullptr, sizeof(PanicLog), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) PanicLog) {}
  ~SharedPanicLog() { munmap(log_, sizeof(PanicLog)); }
  SharedPanicLog(const SharedPanicLog&) = delete;
  SharedPanicLog& operator=(const SharedPanicLog&) = delete;
  PanicLog& operator*() const { return *log_; }
  PanicLog* operator->() const { return log_; }

 private:
  PanicLog* log_;
};

class LoggingGripper : public device::Gripper {
 public:
  explicit LoggingGripper(PanicLog& log) : log_(log) {
    limits_.force = 12;
    limits_.grip = 8;
    limits_.gap = {0, 0.1};
    limits_.watchdog = 20e-3;
  }
  const device::GripperLimits& limits() const noexcept override { return limits_; }
  device::ReadOutcome read(device::GripperState& state, std::int64_t tick) noexcept override {
    if (tick == fails_at) fail();
    state.position = {0, 1, 0};
    state.gap = 0.05;
    state.sequence = static_cast<std::uint32_t>(tick + 1);
    return device::ReadOutcome::value;
  }
  bool write(const device::GripperForce& force) noexcept override {
    ++log_.writes;
    log_.grip = force.grip;
    return true;
  }
  device::ReleaseResult panic() noexcept override {
    ++log_.panics;
    in_panic();
    if (answer == device::ReleaseResult::written) log_.grip = 0;
    ++log_.ended;
    return answer;
  }
  device::ReleaseResult release_from_watchdog() noexcept override {
    ++log_.meanwhiles;
    in_meanwhile();
    log_.grip = 0;
    return device::ReleaseResult::written;
  }

  std::function<void()> fail = [] {};
  std::function<void()> in_panic = [] {}, in_meanwhile = [] {};
  device::ReleaseResult answer = device::ReleaseResult::written;  // of panic()
  std::int64_t fails_at = -1;

 private:
  PanicLog& log_;
  device::GripperLimits limits_;
};

struct PanicOutcome {
  int code = -1;  // 1000 + signal where one ended it
  std::string error_output;
};

// Runs in a child, within ten seconds, and keeps what it says on stderr.
inline PanicOutcome run_in_child(const std::function<void()>& body) {
  std::fflush(nullptr);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    alarm(10);
    body();
    _exit(0);
  }
  close(ends[1]);
  PanicOutcome outcome;
  char part[512];
  for (ssize_t got = 0; (got = read(ends[0], part, sizeof part)) > 0;)
    outcome.error_output.append(part, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  return outcome;
}

inline int line_count(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

inline void expect_panic(const PanicOutcome& outcome, const PanicLog& log, const std::string& why) {
  EXPECT_EQ(outcome.code, 3) << outcome.error_output;
  EXPECT_EQ(log.panics, 1);
  EXPECT_EQ(log.grip, 0);
  EXPECT_NE(outcome.error_output.find("wholehand: live: the program failed (" + why +
                                      "); zero force was written, state released; please report it\n"),
            std::string::npos)
      << outcome.error_output;
}

// The loop runs on a thread of its own, as in a live session, with a force on the gripper.
inline void run_loop(LoggingGripper& gripper, const std::function<void()>& on_another_thread = {}) {
  static const std::atomic<bool> stop{false};
  Scene scene = scene_of({beaker1()});
  device::Session session(scene, {0, 0.1});
  device::LoopOptions options;
  options.is_simulated = true;
  options.seconds = 100;
  device::HapticLoop loop(scene.live, gripper, session, {}, options);
  std::thread haptic([&] { loop.run(stop); });
  if (on_another_thread) on_another_thread();
  haptic.join();
}

}  // namespace wholehand

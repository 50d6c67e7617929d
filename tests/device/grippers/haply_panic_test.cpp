// SPDX-License-Identifier: MIT
// A child that crashes with a force on Haply's devices: the service has zero force afterwards.
// sanitizers: none
#include <gtest/gtest.h>

#include <dirent.h>
#include <signal.h>
#include <sys/syscall.h>

#include <atomic>
#include <fstream>
#include <string>
#include <thread>

#include "device/loop/panic.h"
#include "tests/support/haply_rig.h"
#include "tests/support/panicking.h"

namespace wholehand::device {
namespace {

// Sends a signal to the thread of that name. False: there is none.
bool kill_thread(const std::string& name, int signal) {
  DIR* const tasks = opendir("/proc/self/task");
  if (!tasks) return false;
  bool is_found = false;
  while (const dirent* const task = readdir(tasks)) {
    std::ifstream file(std::string("/proc/self/task/") + task->d_name + "/comm");
    std::string found;
    if (!std::getline(file, found) || found != name) continue;
    is_found = syscall(SYS_tgkill, getpid(), std::stoi(task->d_name), signal) == 0;
  }
  closedir(tasks);
  return is_found;
}

// Writes a force in a child until the service has it, and then fails.
PanicOutcome fail_with_force(stand_in::HaplyService& service, const std::function<void()>& fail) {
  static const std::atomic<bool> is_over{false};  // beyond the service's threads
  service.move(haply_greeting(is_over));
  const SharedPanicLog log;
  std::thread watching([&] {
    if (service.wait([&] { return service.has_force(); })) ++log->writes;
  });
  const PanicOutcome outcome = run_in_child([&] {
    const auto gripper = open_haply(
        {{"127.0.0.1", service.port()}, {}}, live_scene(), LONG_WATCHDOG, [](const std::string&) {}, QUICK_CALIBRATION);
    const PanicGuard guard(*gripper);
    const GripperForce force{{2, 0, 0}, 1};
    while (log->writes == 0) {
      gripper->set_last_written_force(force);
      gripper->write(force);
    }
    fail();
    for (;;) pause();
  });
  watching.join();
  return outcome;
}

TEST(HaplyPanic, ACrashLeavesNoForce) {
  const auto crashes = std::vector<std::pair<std::string, std::function<void()>>>{
      {"SIGSEGV", [] { raise(SIGSEGV); }}, {"an assertion or an uncaught error", [] { std::abort(); }}};
  for (const auto& [name, fail] : crashes) {
    stand_in::HaplyService service{{}};
    const PanicOutcome outcome = fail_with_force(service, fail);
    EXPECT_EQ(outcome.code, 3) << outcome.error_output;
    EXPECT_NE(outcome.error_output.find("(" + name + "); zero force was written"), std::string::npos) << outcome.error_output;
    EXPECT_TRUE(service.wait([&] { return !service.has_force(); })) << name;
  }
}

// Then nobody sends on the connection that speaks, and the idle one has to do. In which order the service takes the messages of two connections is its
// own affair.
TEST(HaplyPanic, ACrashOfTheThreadThatSpeaksSendsZeroForceByTheIdleConnection) {
  stand_in::HaplyService service{{}};
  const PanicOutcome outcome = fail_with_force(service, [] { EXPECT_TRUE(kill_thread("haply", SIGSEGV)); });
  EXPECT_EQ(outcome.code, 3) << outcome.error_output;
  EXPECT_NE(outcome.error_output.find("(SIGSEGV); zero force was written"), std::string::npos) << outcome.error_output;
  EXPECT_TRUE(service.wait([&] { return service.other_messages() > 0; }));
}

}  // namespace
}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// Whole sessions of `live` in forked children with the stand-in for Force Dimension's library, which fails as the test wants, and a
// log of what it was given that the test shares with them.
#pragma once

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "app/commands/live.h"
#include "base/system/clock.h"
#include "base/system/output.h"
#include "base/text/error.h"
#include "device/grippers/omega_gripper.h"
#include "tests/support/files.h"
#include "tests/support/stand_in_dhd.h"

namespace wholehand {

// What was written to the device; survives the child.
struct DeviceLog {
  static constexpr int MOST = 20000;
  std::atomic<int> writes{0};
  std::atomic<bool> taken{false};  // by somebody else while the library waited
  struct Write {
    double time = 0, force = 0, grip = 0;  // s on the clock, N
  } all[MOST];

  void add(const std::array<double, 7>& force) {
    const int at = writes;
    if (at < MOST) all[at] = {monotonic_now(), std::hypot(force[0], force[1], force[2]), std::abs(force[6])};
    writes = at + 1;
  }
  const Write& last() const { return all[std::min<int>(writes, MOST) - 1]; }
  double largest() const {
    double most = 0;
    for (int k = 0; k < std::min<int>(writes, MOST); ++k) most = std::max(most, all[k].force);
    return most;
  }
};

class SharedDeviceLog {
 public:
  SharedDeviceLog()
      : log_(new (mmap(nullptr, sizeof(DeviceLog), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) DeviceLog) {}
  ~SharedDeviceLog() { munmap(log_, sizeof(DeviceLog)); }
  SharedDeviceLog(const SharedDeviceLog&) = delete;
  SharedDeviceLog& operator=(const SharedDeviceLog&) = delete;
  DeviceLog& operator*() const { return *log_; }
  DeviceLog* operator->() const { return log_; }

 private:
  DeviceLog* log_;
};

// The beaker stands where the device's thumb presses some millimeters into it, and stays there: a force of some newtons from the
// first tick on.
constexpr const char* PRESSED_SCENE =
    "[device]\ngap_mm = [0, 25]\n[live]\nrate_Hz = 500\nramp_s = 0\nslew_N_s = 100000\njump_m_s = 1000\nlate_steps = 1000\n"
    "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n";

inline std::vector<StandInPose> presses() {
  std::vector<StandInPose> motion;
  // from the right, at 1 m/s
  for (int k = 0; k <= 10; ++k) {
    StandInPose pose;
    pose.position = pose.thumb = pose.finger = device::to_dhd({0.121 - 1e-3 * k, 0.055, 0});
    pose.gap = 25e-3;
    motion.push_back(pose);
  }
  return motion;
}

struct EndedSession {
  int code = -1;  // 1000 + signal where one ended it
  std::string error_output, printed;
};

// A session in a child of its own.
class DeviceSession {
 public:
  DeviceSession() {
    std::ofstream(scene_) << PRESSED_SCENE;
    options.scene = scene_;
    options.device = "omega";
    options.dhd_library = STAND_IN_DHD;
    options.unsafe_gains = true;
    options.seconds = 60;
  }

  // `plan`: in the child, before the session, what the stand-in does.
  void start(const std::function<void(StandIn&, DeviceLog&)>& plan) {
    std::fflush(nullptr);
    child_ = fork();
    if (child_ != 0) return;
    alarm_for_the_worst();
    if (!std::freopen(err_.c_str(), "w", stderr) || !std::freopen(out_.c_str(), "w", stdout)) _exit(99);
    prepare_output();
    StandIn dhd(STAND_IN_DHD);
    dhd->motion = presses();
    dhd->on_force = [this](const std::array<double, 7>& force) { log->add(force); };
    plan(dhd, *log);
    int code = 98;
    try {
      code = static_cast<int>(action(options));
      finish_output();
    } catch (const Error& error) {
      std::signal(SIGXFSZ, SIG_IGN);  // its guard has gone
      std::fprintf(stderr, "wholehand: %s\n", error.what());
      code = static_cast<int>(error.code);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "unexpected: %s\n", error.what());
    }
    std::fflush(nullptr);
    _exit(code);
  }

  // Until so many writes have come; false: the child has ended before.
  bool has_written(int count) const {
    while (log->writes < count) {
      if (has_ended()) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  bool has_ended() const {
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid != 0;
  }

  void stop_for(std::chrono::milliseconds time) const {
    kill(child_, SIGSTOP);
    go_on_after(time);
  }
  // It stops by itself, and goes on so long afterwards.
  void go_on_after(std::chrono::milliseconds time) const {
    int status = 0;
    waitpid(child_, &status, WUNTRACED);
    std::this_thread::sleep_for(time);
    kill(child_, SIGCONT);
  }
  void send(int signal) const { kill(child_, signal); }

  EndedSession wait() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), file_text(err_), file_text(out_)};
  }
  EndedSession run(const std::function<void(StandIn&, DeviceLog&)>& plan) {
    start(plan);
    return wait();
  }
  std::string file(const std::string& name) const { return folder_ / name; }

  LiveOptions options;
  std::function<ExitCode(const LiveOptions&)> action = run_live;
  SharedDeviceLog log;

 private:
  // not alarm(), which a session catches
  static void alarm_for_the_worst() {
    const rlimit cpu{60, 60};
    setrlimit(RLIMIT_CPU, &cpu);
    const pid_t self = getpid();
    std::thread([self] {
      std::this_thread::sleep_for(std::chrono::seconds(60));
      kill(self, SIGKILL);
    }).detach();
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_ / "scene.toml", err_ = folder_ / "err", out_ = folder_ / "out";
  pid_t child_ = -1;
};

[[noreturn]] inline void hang() {
  for (;;) pause();
}

inline void expect_said(const EndedSession& ended, const std::string& gist) {
  EXPECT_NE(ended.error_output.find(gist), std::string::npos) << ended.error_output << "lacks " << gist;
}

// Calls `act` in the write of that number, counted from 1.
inline std::function<void()> in_write(int number, const std::function<void()>& act) {
  return [count = 0, number, act]() mutable {
    if (++count == number) act();
  };
}

constexpr const char* SET_FORCE = "dhdSetForceAndTorqueAndGripperForce";
constexpr const char* GET_POSE = "dhdGetPositionAndOrientationFrame";
constexpr const char* GIVEN_UP =
    "wholehand: live: a call of the device has not returned for 1 s, and the program ends without it\n";

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// `live` with a device whose library fails in every way: forked children that run whole sessions against the stand-in for Force Dimension's SDK, and
// a log of what it was given that the test shares with them. What is on the device at the end is held to what is said of it.
// sanitizers: none
#include "app/live.h"

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
#include <cstdlib>
#include <fstream>
#include <functional>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "device/monotonic.h"
#include "device/omega_gripper.h"
#include "recordings/recording.h"
#include "system/output.h"
#include "tests/support/files.h"
#include "tests/support/scene_texts.h"
#include "tests/support/stand_in_dhd.h"

namespace wholehand {
namespace {

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

// The beaker stands where the device's thumb presses some millimetres into it, and stays there: a force of some newtons from the first tick on.
constexpr const char* PRESSED_SCENE =
    "[device]\ngap_mm = [0, 25]\n[live]\nrate_Hz = 500\nramp_s = 0\nslew_N_s = 100000\njump_m_s = 1000\nlate_steps = 1000\n"
    "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n";

std::vector<StandInPose> presses() {
  std::vector<StandInPose> motion;
  // from the right, at 1 m/s
  for (int k = 0; k <= 10; ++k) {
    StandInPose pose;
    pose.position = pose.thumb = pose.finger = to_dhd({0.121 - 1e-3 * k, 0.055, 0});
    pose.gap = 25e-3;
    motion.push_back(pose);
  }
  return motion;
}

struct Ended {
  int code = -1;  // 1000 + signal where one ended it
  std::string said, printed;
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
      siginfo_t info{};
      waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
      if (info.si_pid != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
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

  Ended wait() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), file_text(err_), file_text(out_)};
  }
  Ended run(const std::function<void(StandIn&, DeviceLog&)>& plan) {
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

[[noreturn]] void hang() {
  for (;;) pause();
}

void expect_said(const Ended& ended, const std::string& gist) {
  EXPECT_NE(ended.said.find(gist), std::string::npos) << ended.said << "lacks " << gist;
}

// Calls `act` in the write of that number, counted from 1.
std::function<void()> in_write(int number, const std::function<void()>& act) {
  return [count = 0, number, act]() mutable {
    if (++count == number) act();
  };
}

constexpr const char* SET_FORCE = "dhdSetForceAndTorqueAndGripperForce";
constexpr const char* GET_POSE = "dhdGetPositionAndOrientationFrame";
constexpr const char* GIVEN_UP =
    "wholehand: live: a call of the device has not returned for 1 s, and the program ends without it\n";

// ---- without a fault ----

TEST(LiveDevice, EndsWithZeroForceAndSaysSo) {
  DeviceSession session;
  session.options.seconds = 0.3;
  session.options.json = true;
  const Ended ended = session.run([](StandIn&, DeviceLog&) {});
  EXPECT_EQ(ended.code, 0) << ended.said;
  EXPECT_GT(session.log->largest(), 0.5) << "a force was on it";
  EXPECT_EQ(session.log->last().force, 0);
  EXPECT_EQ(nlohmann::json::parse(ended.printed)["force"], "zero force was written");
}

// Whatever bytes a device calls itself by.
TEST(LiveDevice, ANameOfNoEncodingIsPrintedAndIsJson) {
  for (const char* name : {"omega\xff\xfe", "om\xe9ga \xc3", "\x1b[31momega\n"}) {
    DeviceSession session;
    session.options.seconds = 0.05;
    session.options.json = true;
    const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) { dhd->name = name; });
    EXPECT_EQ(ended.code, 0) << ended.said;
    const auto report = nlohmann::json::parse(ended.printed, nullptr, false);
    ASSERT_FALSE(report.is_discarded()) << ended.printed;
    const std::string said = report["device"]["name"];
    EXPECT_TRUE(std::all_of(said.begin(), said.end(), [](char c) { return c >= ' ' && c <= '~'; })) << said;
  }
}

// ---- a process that stands still ----

// Long enough that a busy machine does not do the same between the loop's look at the clock and the library.
constexpr double STOPPED = 35e-3;  // s

// The write after each gap, or `later` ones after it, is zero.
void expect_zero_after_stops(const DeviceLog& log, int stops, int later = 0) {
  int gaps = 0;
  for (int k = 1; k + later < std::min<int>(log.writes, DeviceLog::MOST); ++k) {
    const double gap = log.all[k].time - log.all[k - 1].time;
    if (gap < STOPPED) continue;
    ++gaps;
    EXPECT_EQ(log.all[k + later].force, 0) << "after " << gap << " s, write " << k << "; before " << log.all[k - 1].force;
  }
  EXPECT_GE(gaps, stops);
}

TEST(LiveDevice, TheFirstForceAfterAStopIsZero) {
  DeviceSession session;
  session.start([](StandIn&, DeviceLog&) {});
  int stops = 0;
  for (const int ms : {40, 60, 120, 50, 600, 45}) {
    ASSERT_TRUE(session.has_written(session.log->writes + 50)) << session.wait().said;
    session.stop_for(std::chrono::milliseconds(ms));
    ++stops;
  }
  ASSERT_TRUE(session.has_written(session.log->writes + 50));
  session.send(SIGINT);
  const Ended ended = session.wait();
  EXPECT_EQ(ended.code, 130) << ended.said;
  EXPECT_GT(session.log->largest(), 0.5);
  expect_zero_after_stops(*session.log, stops);
}

// Stopped in the middle of a call of the library, too.
TEST(LiveDevice, TheFirstForceAfterAStopWithinACallIsZero) {
  for (const char* function : {GET_POSE, SET_FORCE}) {
    DeviceSession session;
    session.start([&](StandIn& dhd, DeviceLog&) { dhd->hooks[function] = in_write(200, [] { raise(SIGSTOP); }); });
    session.go_on_after(std::chrono::milliseconds(50));
    ASSERT_TRUE(session.has_written(session.log->writes + 50));
    session.send(SIGINT);
    EXPECT_EQ(session.wait().code, 130);
    // the force that the library had already been handed is its own affair
    expect_zero_after_stops(*session.log, 1, function == GET_POSE ? 0 : 1);
  }
}

// For longer than a lost call is waited for, too: it returns with the process.
TEST(LiveDevice, ALongStopWithinACallGoesOn) {
  DeviceSession session;
  session.start([&](StandIn& dhd, DeviceLog&) { dhd->hooks[GET_POSE] = in_write(200, [] { raise(SIGSTOP); }); });
  session.go_on_after(std::chrono::milliseconds(1500));
  ASSERT_TRUE(session.has_written(session.log->writes + 50)) << session.wait().said;
  session.send(SIGINT);
  EXPECT_EQ(session.wait().code, 130);
  expect_zero_after_stops(*session.log, 1);
}

// ---- calls that take long ----

TEST(LiveDevice, ACallThatAlwaysTakesLongEndsTheSession) {
  for (const int ms : {20, 200}) {
    DeviceSession session;
    std::ofstream(session.file("strict.toml"))
        << std::string(PRESSED_SCENE).replace(std::string(PRESSED_SCENE).find("1000\n[[v"), 4, "3");
    session.options.scene = session.file("strict.toml");
    const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) {
      dhd->hooks[GET_POSE] = [ms, count = 0]() mutable {
        if (++count > 100) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
      };
    });
    EXPECT_EQ(ended.code, 3);
    expect_said(ended,
                ": late (3 steps in a row took longer than a period, or their reads longer than 12 ms; [live] late_steps); ");
    expect_said(ended, "a call of the device did not return within 12 ms; meanwhile zero force was written\n");
    EXPECT_GT(session.log->largest(), 0.5);
    EXPECT_EQ(session.log->last().force, 0);
  }
}

// One alone is late and no more; meanwhile a second thread takes the force away, and then it begins at zero.
TEST(LiveDevice, ACallThatTakesLongOnceHasTheForceTakenAwayMeanwhile) {
  for (const char* function : {GET_POSE, SET_FORCE}) {
    DeviceSession session;
    session.options.seconds = 1;
    session.options.json = true;
    const Ended ended = session.run([&](StandIn& dhd, DeviceLog& log) {
      dhd->hooks[function] = in_write(200, [&log] {
        // until somebody else has written
        const int before = log.writes;
        for (int k = 0; k < 5000 && log.writes == before; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (log.writes > before && log.last().force == 0) log.taken = true;
      });
    });
    EXPECT_EQ(ended.code, 0) << ended.said;
    EXPECT_TRUE(session.log->taken) << "a second thread took the force away: " << function;
    expect_said(ended, "a call of the device did not return within 12 ms; meanwhile zero force was written\n");
    EXPECT_GE(nlohmann::json::parse(ended.printed)["late"], 1);
  }
}

// The second thread's own call never returns, though the haptic thread's does: the session runs to its end, and the end does not wait.
TEST(LiveDevice, ASecondThreadThatNeverReturnsIsNotWaitedFor) {
  DeviceSession session;
  session.options.seconds = 1;
  session.options.record = session.file("session.nc");
  const Ended ended = session.run([](StandIn& dhd, DeviceLog&) {
    dhd->hooks[SET_FORCE] = [count = std::make_shared<std::atomic<int>>(0)] {
      const int call = ++*count;
      if (call == 201)
        for (;;) pause();
      for (int k = 0; call == 200 && k < 5000 && *count == 200; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
  });
  EXPECT_EQ(ended.code, 3);
  expect_said(ended, "wholehand: live: over after 1");
  expect_said(ended, "; zero force was written\n");
  expect_said(ended, "wholehand: live: a second call of the device has not returned for 1 s, and the program ends without it\n");
  EXPECT_EQ(session.log->last().force, 0);
  EXPECT_GT(read_recording(session.options.record).ticks.size(), 100u);
}

// A call that never returns, and a library that lets nobody else in: the device's watchdog has the force, and the recording is whole.
TEST(LiveDevice, ACallThatNeverReturnsEndsTheSession) {
  DeviceSession session;
  session.options.record = session.file("session.nc");
  const Ended ended = session.run([](StandIn& dhd, DeviceLog&) {
    static std::mutex within;
    dhd->hooks[SET_FORCE] = [count = std::make_shared<std::atomic<int>>(0)] {
      const std::lock_guard lock(within);
      if (++*count == 200)
        for (;;) pause();
    };
  });
  EXPECT_EQ(ended.code, 3);
  const std::string left = "zero force was not written, since the device's library cannot be called now; the last force was ";
  expect_said(ended, "wholehand: live: a call of the device did not return within 12 ms; meanwhile " + left);
  expect_said(ended, "wholehand: live: a call of the device has not returned for 1 s, and the session is given up; " + left);
  expect_said(ended, "the device's own watchdog takes it away within 20 ms\n");
  EXPECT_GT(session.log->last().force, 0.5) << "and so it is";
  const Recording recording = read_recording(session.options.record);
  EXPECT_GT(recording.ticks.size(), 100u);
  ASSERT_TRUE(recording.end);
  EXPECT_EQ(recording.end->fault, Fault::late);
}

// It lets go of the force and then does not let go of the device: the reason, the report and the exit code come all the same.
TEST(LiveDevice, ADeviceThatIsNotLeftIsGivenUp) {
  for (const char* function : {"dhdStop", "dhdClose"}) {
    for (const bool is_fault : {false, true}) {
      SCOPED_TRACE(std::string(function) + (is_fault ? " after a fault" : ""));
      DeviceSession session;
      session.options.seconds = 0.5;
      session.options.json = true;
      session.options.record = session.file("session.nc");
      const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) {
        if (is_fault) dhd->hooks[GET_POSE] = in_write(200, [&dhd] { dhd->codes[GET_POSE] = -1; });
        dhd->hooks[function] = hang;
      });
      EXPECT_EQ(ended.code, 3);
      EXPECT_GT(session.log->largest(), 0.5);
      EXPECT_EQ(session.log->last().force, 0);
      expect_said(ended, is_fault ? ": read error (pose not read: no error); zero force was written\n"
                                  : "wholehand: live: over after 0.500 s; zero force was written\n");
      expect_said(ended, GIVEN_UP);
      const auto report = nlohmann::json::parse(ended.printed);
      EXPECT_EQ(report["fault"], is_fault ? nlohmann::json("read error") : nlohmann::json());
      EXPECT_EQ(report["force"], "zero force was written");
      EXPECT_GT(report["ticks"], 100);
      const Recording recording = read_recording(session.options.record);
      ASSERT_TRUE(recording.end);
      EXPECT_EQ(recording.end->fault, is_fault ? Fault::read_error : Fault::none);
      EXPECT_EQ(recording.ticks.back().state, SessionState::released);
    }
  }
}

// The last write after a fault does not return: the fault is told, and what a second thread could do about the force.
TEST(LiveDevice, AFaultWhoseZeroForceDoesNotReturnIsTold) {
  for (const bool lets_in : {false, true}) {
    DeviceSession session;
    session.options.json = true;
    session.options.record = session.file("session.nc");
    const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) {
      static std::mutex within;
      static std::atomic<bool> is_over;
      is_over = false;
      dhd->error = "unplugged";
      dhd->hooks[GET_POSE] = in_write(200, [&dhd] {
        dhd->codes[GET_POSE] = -1;
        is_over = true;
      });
      dhd->hooks[SET_FORCE] = [lets_in, has_hung = std::make_shared<std::atomic<bool>>(false)] {
        if (lets_in && is_over && !has_hung->exchange(true)) hang();
        if (lets_in) return;
        const std::lock_guard lock(within);
        if (is_over) hang();
      };
    });
    EXPECT_EQ(ended.code, 3);
    const std::string force =
        lets_in ? "zero force was written"
                : "zero force was not written, since the device's library cannot be called now; the last force was ";
    expect_said(ended, ": read error (pose not read: unplugged); " + force);
    expect_said(ended, GIVEN_UP);
    const auto report = nlohmann::json::parse(ended.printed);
    EXPECT_EQ(report["fault"], "read error");
    EXPECT_EQ(std::string(report["force"]).substr(0, force.size()), force);
    const Recording recording = read_recording(session.options.record);
    ASSERT_TRUE(recording.end);
    EXPECT_EQ(recording.end->fault, Fault::read_error);
  }
}

// ---- failures within the library ----

TEST(LiveDevice, ALibraryThatFailsHasTheForceTakenAwayByAnotherThread) {
  for (const char* function : {GET_POSE, SET_FORCE}) {
    DeviceSession session;
    const Ended ended =
        session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[function] = in_write(200, [] { raise(SIGSEGV); }); });
    EXPECT_EQ(ended.code, 3);
    EXPECT_GT(session.log->largest(), 0.5);
    EXPECT_EQ(session.log->last().force, 0);
    expect_said(ended, "wholehand: live: the program failed (SIGSEGV); zero force was written, state released; please report it\n");
  }
}

// It fails with its own locks held.
TEST(LiveDevice, ALibraryThatFailsAndLetsNobodyInLeavesItToTheWatchdog) {
  for (const bool is_exit : {false, true}) {
    DeviceSession session;
    const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) {
      static std::mutex within;
      dhd->hooks[SET_FORCE] = [is_exit, count = std::make_shared<std::atomic<int>>(0)] {
        const std::lock_guard lock(within);
        if (++*count != 200) return;
        if (is_exit) std::exit(0);
        raise(SIGSEGV);
      };
    });
    EXPECT_EQ(ended.code, 3);
    EXPECT_GT(session.log->last().force, 0.5);
    const std::string what = is_exit ? "a library ended the program by exit(0); " : "the program failed (SIGSEGV); ";
    expect_said(ended, "wholehand: live: " + what +
                           "zero force was not written, since the device's library cannot be called now; the last force was ");
    expect_said(ended, " N at the fingers; the device's own watchdog takes it away within 20 ms, state released");
  }
}

TEST(LiveDevice, ALibraryThatExitsIsAFailure) {
  DeviceSession session;
  const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[GET_POSE] = in_write(200, [] { std::exit(0); }); });
  EXPECT_EQ(ended.code, 3);
  EXPECT_GT(session.log->largest(), 0.5);
  EXPECT_EQ(session.log->last().force, 0);
  EXPECT_EQ(ended.said.substr(ended.said.rfind("wholehand")),
            "wholehand: live: a library ended the program by exit(0); zero force was written, state released\n");
}

// Before the loop, after it, and where it is only looked for.
TEST(LiveDevice, ALibraryThatExitsOutsideTheLoopIsAFailure) {
  for (const bool is_quick : {false, true}) {
    const auto leave = [is_quick] { is_quick ? std::quick_exit(0) : std::exit(0); };
    for (const char* function : {"dhdOpenID", "dhdEnableForce", "dhdStop", "dhdClose"}) {
      SCOPED_TRACE(function);
      DeviceSession session;
      session.options.seconds = 0.3;
      const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[function] = leave; });
      EXPECT_EQ(ended.code, 3);
      const bool is_open = function == std::string("dhdStop") || function == std::string("dhdClose");
      expect_said(ended, is_open
                             ? "wholehand: live: a library ended the program by exit(0); no force is on a device, state released\n"
                             : "wholehand: omega: a library ended the program by exit(0)\n");
      if (is_open) {
        EXPECT_EQ(session.log->last().force, 0);
      }
    }
    for (const char* function : {"dhdOpenID", "dhdClose"}) {
      DeviceSession session;
      session.action = [](const LiveOptions& options) {
        find_omega_grippers(options.dhd_library);
        return ExitCode::done;
      };
      const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[function] = leave; });
      EXPECT_EQ(ended.code, 3) << function;
      EXPECT_EQ(ended.said, "wholehand: omega: a library ended the program by exit(0)\n") << function;
    }
  }
}

// Every call fails from some moment on: the reason is the call's that failed first, and the force is said to be left.
TEST(LiveDevice, WhereEveryCallFailsTheForceIsSaidToBeLeft) {
  for (const bool is_read : {false, true}) {
    DeviceSession session;
    const Ended ended = session.run([&](StandIn& dhd, DeviceLog&) {
      dhd->hooks[is_read ? GET_POSE : SET_FORCE] = in_write(200, [&dhd] {
        dhd->error = "communication \xff error";
        dhd->codes[SET_FORCE] = dhd->codes[GET_POSE] = -1;
        dhd->on_force = {};
      });
    });
    EXPECT_EQ(ended.code, 3);
    EXPECT_GT(session.log->last().force, 0.5);
    expect_said(ended, is_read ? ": read error (pose not read: communication ? error); "
                               : ": write error (force not taken: communication ? error); ");
    expect_said(ended, "zero force could not be written (force not taken: communication ? error); the last force was ");
    expect_said(ended, "; the device's own watchdog takes it away within 20 ms\n");
  }
}

// A session that ends well by itself, but for its last write.
TEST(LiveDevice, AnEndWhoseZeroForceIsNotTakenIsAFailure) {
  DeviceSession session;
  const Ended ended = session.run([](StandIn& dhd, DeviceLog&) {
    dhd->hooks[SET_FORCE] = [&dhd, count = 0]() mutable {
      if (++count == 200) raise(SIGINT);  // the loop's next look sees it
      if (count > 200) dhd->codes[SET_FORCE] = -1;
    };
  });
  EXPECT_EQ(ended.code, 3);
  expect_said(ended, "wholehand: live: over after ");
  expect_said(ended, "zero force could not be written (force not taken: no error); the last force was ");
}

// ---- signals ----

TEST(LiveDevice, SignalsThatWouldEndItAtOnceLetGo) {
  for (const int signal : {SIGPWR, SIGSYS, SIGTRAP, SIGIO, SIGSTKFLT, SIGRTMIN, SIGRTMAX}) {
    DeviceSession session;
    session.start([](StandIn&, DeviceLog&) {});
    ASSERT_TRUE(session.has_written(100));
    session.send(signal);
    const Ended ended = session.wait();
    EXPECT_EQ(ended.code, 3) << signal;
    expect_said(ended, "zero force was written, state released");
    EXPECT_EQ(session.log->last().force, 0) << signal;
  }
}

// Ctrl-C is a wish that the loop looks at; where it hangs in the library, the next one takes the force away itself.
TEST(LiveDevice, ASecondInterruptLetsGo) {
  for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"}, std::pair{SIGTERM, "SIGTERM"}, std::pair{SIGHUP, "SIGHUP"}}) {
    DeviceSession session;
    session.start([](StandIn& dhd, DeviceLog&) {
      dhd->hooks[GET_POSE] = in_write(200, [] {
        raise(SIGSTOP);  // for the test to see where it is
        hang();
      });
    });
    session.go_on_after(std::chrono::milliseconds(1));
    session.send(signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    session.send(signal);
    const Ended ended = session.wait();
    EXPECT_EQ(ended.code, 3) << name;
    EXPECT_GT(session.log->largest(), 0.5);
    EXPECT_EQ(session.log->last().force, 0);
    expect_said(ended, std::string("wholehand: live: ended by a signal (") + name + "); zero force was written, state released\n");
  }
}

// Standard output is a file that has grown to its limit: what cannot be printed ends the session, and the signal does not.
TEST(LiveDevice, AFileThatMayNotGrowEndsItByTheWrite) {
  DeviceSession session;
  session.options.seconds = 0.5;
  const Ended ended = session.run([](StandIn&, DeviceLog&) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_FSIZE, &none);
  });
  EXPECT_EQ(ended.code, 3);
  EXPECT_GT(session.log->largest(), 0.5);
  EXPECT_EQ(session.log->last().force, 0);
}

}  // namespace
}  // namespace wholehand

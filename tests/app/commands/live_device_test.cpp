// SPDX-License-Identifier: MIT
// `live` with a device whose calls take long, in a process that stalls: the force on the device at the end is the reported one.
// sanitizers: none
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "base/files/json.h"
#include "device/recordings/recording.h"
#include "tests/support/device_session.h"
#include "tests/support/files.h"
#include "tests/support/stand_in_dhd.h"

namespace wholehand {
namespace {

// ---- without a fault ----

TEST(LiveDevice, EndsWithZeroForceAndSaysSo) {
  DeviceSession session;
  session.options.seconds = 0.3;
  session.options.json = true;
  const EndedSession ended = session.run([](StandIn&, DeviceLog&) {});
  EXPECT_EQ(ended.code, 0) << ended.error_output;
  EXPECT_GT(session.log->largest(), 0.5) << "a force was on it";
  EXPECT_EQ(session.log->last().force, 0);
  EXPECT_EQ(parse_json(ended.printed)["force"], "zero force was written");
}

// Whatever bytes a device calls itself by.
TEST(LiveDevice, ANameOfNoEncodingIsPrintedAndIsJson) {
  for (const char* name : {"omega\xff\xfe", "om\xe9ga \xc3", "\x1b[31momega\n"}) {
    DeviceSession session;
    session.options.seconds = 0.05;
    session.options.json = true;
    const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) { dhd->name = name; });
    EXPECT_EQ(ended.code, 0) << ended.error_output;
    const auto report = try_json(ended.printed);
    ASSERT_FALSE(report.is_discarded()) << ended.printed;
    const std::string said = report["device"]["name"];
    EXPECT_TRUE(std::all_of(said.begin(), said.end(), [](char c) { return c >= ' ' && c <= '~'; })) << said;
  }
}

// ---- a process that stalls ----

// Long enough that a busy machine does not stall as long between the loop's reading of the clock and the library.
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
    ASSERT_TRUE(session.has_written(session.log->writes + 50)) << session.wait().error_output;
    session.stop_for(std::chrono::milliseconds(ms));
    ++stops;
  }
  ASSERT_TRUE(session.has_written(session.log->writes + 50));
  session.send(SIGINT);
  const EndedSession ended = session.wait();
  EXPECT_EQ(ended.code, 130) << ended.error_output;
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
  ASSERT_TRUE(session.has_written(session.log->writes + 50)) << session.wait().error_output;
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
    const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) {
      dhd->hooks[GET_POSE] = [ms, count = 0]() mutable {
        if (++count > 100) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
      };
    });
    EXPECT_EQ(ended.code, 3);
    expect_said(ended,
                ": late (3 steps in a row took longer than a period, or their reads took longer than 12 ms; [live] late_steps sets "
                "this number); ");
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
    const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog& log) {
      dhd->hooks[function] = in_write(200, [&log] {
        // until somebody else has written
        const int before = log.writes;
        for (int k = 0; k < 5000 && log.writes == before; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (log.writes > before && log.last().force == 0) log.taken = true;
      });
    });
    EXPECT_EQ(ended.code, 0) << ended.error_output;
    EXPECT_TRUE(session.log->taken) << "a second thread took the force away: " << function;
    expect_said(ended, "a call of the device did not return within 12 ms; meanwhile zero force was written\n");
    EXPECT_GE(parse_json(ended.printed)["late"], 1);
  }
}

// The second thread's own call never returns, though the haptic thread's does: the session runs to its end, and the end does not
// wait.
TEST(LiveDevice, ASecondThreadThatNeverReturnsIsNotWaitedFor) {
  DeviceSession session;
  session.options.seconds = 1;
  session.options.record = session.file("session.nc");
  const EndedSession ended = session.run([](StandIn& dhd, DeviceLog&) {
    dhd->hooks[SET_FORCE] = [count = std::make_shared<std::atomic<int>>(0)] {
      const int call = ++*count;
      if (call == 201)
        for (;;) pause();
      for (int k = 0; call == 200 && k < 5000 && *count == 200; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
  });
  EXPECT_EQ(ended.code, 3);
  expect_said(ended, "wholehand: live: the session ended after 1");
  expect_said(ended, "; zero force was written\n");
  expect_said(ended, "wholehand: live: a second call of the device has not returned for 1 s, and the program ends without it\n");
  EXPECT_EQ(session.log->last().force, 0);
  EXPECT_GT(device::read_recording(session.options.record).ticks.size(), 100u);
}

// A call that never returns, and a library that lets nobody else in: the device's watchdog has the force, and the recording is
// whole.
TEST(LiveDevice, ACallThatNeverReturnsEndsTheSession) {
  DeviceSession session;
  session.options.record = session.file("session.nc");
  const EndedSession ended = session.run([](StandIn& dhd, DeviceLog& log) {
    static std::mutex within;
    dhd->hooks[SET_FORCE] = [&log, count = std::make_shared<std::atomic<int>>(0)] {
      const std::lock_guard lock(within);
      // a stall of the machine may take the force away for a while
      if (++*count >= 200 && log.last().force > 0.5)
        for (;;) pause();
    };
  });
  EXPECT_EQ(ended.code, 3);
  const std::string left = "zero force was not written, since the device's library cannot be called now; the last force was ";
  expect_said(ended, "wholehand: live: a call of the device did not return within 12 ms; meanwhile " + left);
  expect_said(ended, "wholehand: live: a call of the device has not returned for 1 s, and the session is given up; " + left);
  expect_said(ended, "the device's own watchdog takes it away within 20 ms\n");
  EXPECT_GT(session.log->last().force, 0.5) << "and so it is";
  const device::Recording recording = device::read_recording(session.options.record);
  EXPECT_GT(recording.ticks.size(), 100u);
  ASSERT_TRUE(recording.end);
  EXPECT_EQ(recording.end->fault, device::Fault::late);
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
      const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) {
        if (is_fault) dhd->hooks[GET_POSE] = in_write(200, [&dhd] { dhd->codes[GET_POSE] = -1; });
        dhd->hooks[function] = hang;
      });
      EXPECT_EQ(ended.code, 3);
      EXPECT_GT(session.log->largest(), 0.5);
      EXPECT_EQ(session.log->last().force, 0);
      expect_said(ended, is_fault ? ": read error (pose not read: no error); zero force was written\n"
                                  : "wholehand: live: the session ended after 0.500 s; zero force was written\n");
      expect_said(ended, GIVEN_UP);
      const auto report = parse_json(ended.printed);
      EXPECT_EQ(report["fault"], is_fault ? nlohmann::json("read error") : nlohmann::json());
      EXPECT_EQ(report["force"], "zero force was written");
      EXPECT_GT(report["ticks"], 100);
      const device::Recording recording = device::read_recording(session.options.record);
      ASSERT_TRUE(recording.end);
      EXPECT_EQ(recording.end->fault, is_fault ? device::Fault::read_error : device::Fault::none);
      EXPECT_EQ(recording.ticks.back().state, device::SessionState::released);
    }
  }
}

// The last write after a fault does not return: the report has the fault, and what a second thread could do about the force.
TEST(LiveDevice, AFaultWhoseZeroForceDoesNotReturnIsTold) {
  for (const bool lets_in : {false, true}) {
    DeviceSession session;
    session.options.json = true;
    session.options.record = session.file("session.nc");
    const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) {
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
    const auto report = parse_json(ended.printed);
    EXPECT_EQ(report["fault"], "read error");
    EXPECT_EQ(std::string(report["force"]).substr(0, force.size()), force);
    const device::Recording recording = device::read_recording(session.options.record);
    ASSERT_TRUE(recording.end);
    EXPECT_EQ(recording.end->fault, device::Fault::read_error);
  }
}

}  // namespace
}  // namespace wholehand

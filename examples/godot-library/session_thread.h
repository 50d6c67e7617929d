// SPDX-License-Identifier: MIT
// A session on a thread of its own, at the session's own rate. Godot's _process comes at 60 Hz and its physics at 60 to 240 Hz, and
// forces that are rendered so rarely shake. The engine says where the hand is and asks what came of it. It waits only for a copy.
#pragma once

#include <wholehand/wholehand.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

class SessionThread {
 public:
  // The session belongs to this thread from now on, and must live longer.
  SessionThread(wh_session* session, const wh_measurement& first);
  ~SessionThread();
  SessionThread(const SessionThread&) = delete;
  SessionThread& operator=(const SessionThread&) = delete;

  // Where the hand should be from the next tick on. A program with a gripper reads the gripper in run() instead.
  void move(const wh_measurement& measurement);
  // What the newest tick gave; false before the first one.
  bool newest(wh_session_output& output, wh_hand& hand, std::int64_t& tick);
  // What ended the session; "" while it runs.
  std::string failure();

 private:
  void run(double period);
  bool step(std::int64_t tick);

  wh_session* session_;
  std::mutex mutex_;  // held for copies alone
  wh_measurement wanted_;
  wh_session_output output_;
  wh_hand hand_;
  std::int64_t tick_ = -1;
  std::string failure_;
  std::atomic<bool> ends_{false};
  std::thread thread_;  // last, as it uses the others
};

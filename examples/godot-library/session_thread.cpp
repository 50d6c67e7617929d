// SPDX-License-Identifier: MIT
#include "session_thread.h"

#include <algorithm>
#include <chrono>

SessionThread::SessionThread(wh_session* session, const wh_measurement& first) : session_(session), wanted_(first) {
  WH_INIT(&output_);
  WH_INIT(&hand_);
  double period = 1e-3;
  wh_session_period(session, &period);
  thread_ = std::thread([this, period] { run(period); });
}

SessionThread::~SessionThread() {
  ends_ = true;
  thread_.join();
}

void SessionThread::move(const wh_measurement& measurement) {
  const std::lock_guard lock(mutex_);
  wanted_ = measurement;
}

bool SessionThread::newest(wh_session_output& output, wh_hand& hand, std::int64_t& tick) {
  const std::lock_guard lock(mutex_);
  output = output_;
  hand = hand_;
  tick = tick_;
  return tick_ >= 0;
}

std::string SessionThread::failure() {
  const std::lock_guard lock(mutex_);
  return failure_;
}

// Each tick has the number of its period. A missed period stays missing, because the session tells the time by these numbers.
void SessionThread::run(double period) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  for (std::int64_t tick = 0; !ends_ && step(tick);) {
    const double passed = std::chrono::duration<double>(Clock::now() - start).count();
    tick = std::max(tick + 1, static_cast<std::int64_t>(passed / period));
    const std::chrono::duration<double> due(period * static_cast<double>(tick));
    std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(due));
  }
}

bool SessionThread::step(std::int64_t tick) {
  wh_measurement measurement;
  {
    const std::lock_guard lock(mutex_);
    measurement = wanted_;
  }
  measurement.tick = tick;
  wh_session_output output;
  wh_hand hand;
  WH_INIT(&output);
  WH_INIT(&hand);
  const bool is_good = wh_session_step(session_, &measurement, &output) == WH_OK && wh_session_hand(session_, &hand) == WH_OK;
  const std::lock_guard lock(mutex_);
  if (!is_good) {
    failure_ = wh_message();
    return false;
  }
  output_ = output;
  hand_ = hand;
  tick_ = tick;
  return true;
}

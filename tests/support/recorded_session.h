// SPDX-License-Identifier: MIT
// Sessions made up from known courses.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "device/recordings/session_report.h"

namespace wholehand {

// Ticks one after the other, each a copy of the last with changes.
class RecordedSession {
 public:
  explicit RecordedSession(double rate = 1000) {
    recording.info.rate = rate;
    recording.info.scene_name = "bench";
    recording.info.device.name = "omega.7";
    recording.info.vessels = {{"one", "water", 2}, {"two", "oil", 3}};
    now_.device.gap = 0.02;
  }

  using Change = std::function<void(double t, device::Tick& tick)>;  // t: s since the start of this stretch

  RecordedSession& stretch(double seconds, device::SessionState state, const Change& change = {}) {
    const auto count = std::llround(seconds * recording.info.rate);
    now_.state = state;
    if (state == device::SessionState::free) now_.vessel = -1;
    for (std::int64_t k = 0; k < count; ++k) {
      if (change) change(static_cast<double>(k) / recording.info.rate, now_);
      recording.ticks.push_back(now_);
      ++now_.number;
    }
    return *this;
  }
  RecordedSession& hold(int vessel) {
    now_.vessel = vessel;
    ++now_.grasps;
    return *this;
  }
  RecordedSession& skip(std::int64_t periods) {
    now_.number += periods;
    return *this;
  }
  RecordedSession& with(const std::function<void(device::Tick&)>& change) {
    change(now_);
    return *this;
  }
  device::SessionReport report() const { return device::report_session(recording); }

  device::Recording recording;

 private:
  device::Tick now_;
};

// From `from` to `to` in `seconds`.
inline double ramp_to(double t, double seconds, double from, double to) { return from + (to - from) * std::min(1.0, t / seconds); }

// A grasp of vessel 0: lifted for 1 s, tilted to `tilt` within 2 s, kept there for 1 s. `grip` and `normal` give the forces over
// the tilt for x from 0 to 1, and keep their ends before and after.
inline RecordedSession tilted_session(double tilt, const std::function<double(double)>& grip,
                                      const std::function<double(double)>& normal) {
  RecordedSession session;
  const auto forces = [&](double x, device::Tick& tick) {
    tick.tilt = x * tilt;
    tick.user_force = grip(x);
    tick.normal_force = normal(x);
  };
  session.stretch(0.2, device::SessionState::free).hold(0);
  session.stretch(1, device::SessionState::lift, [&](double, device::Tick& tick) { forces(0, tick); });
  session.stretch(2, device::SessionState::tilt, [&](double t, device::Tick& tick) { forces(t / 2, tick); });
  session.stretch(1, device::SessionState::maintain, [&](double, device::Tick& tick) { forces(1, tick); });
  session.with([](device::Tick& tick) { tick.tilt = 0; });
  session.stretch(0.5, device::SessionState::free);
  return session;
}

inline double linear_between(double x, double from, double to) { return from + x * (to - from); }

inline device::GraspReport only_grasp(const RecordedSession& session) {
  const device::SessionReport report = session.report();
  EXPECT_EQ(report.grasps.size(), 1u);
  return report.grasps.at(0);
}

}  // namespace wholehand

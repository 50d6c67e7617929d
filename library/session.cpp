// SPDX-License-Identifier: MIT
#include <atomic>
#include <cmath>

#include "library/scene.h"
#include "library/status.h"
#include "live/hand_view.h"
#include "live/session.h"
#include "live/vessel_tracker.h"

using namespace wholehand;

struct wh_session {
  wh_session(const Scene& scene, std::array<double, 2> gap) : session(scene, gap), tracker(session.live().scene) {}
  Session session;
  VesselTracker tracker;
  Tick tick;
  std::int64_t last = -1;
  std::atomic_flag is_in_use = ATOMIC_FLAG_INIT;
};

namespace {

// One thread at a time; the others are told, and do not wait.
class Entered {
 public:
  explicit Entered(wh_session& session) noexcept
      : session_(session), has_(!session.is_in_use.test_and_set(std::memory_order_acquire)) {}
  ~Entered() {
    if (has_) session_.is_in_use.clear(std::memory_order_release);
  }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;
  explicit operator bool() const noexcept { return has_; }

 private:
  wh_session& session_;
  bool has_;
};

template <std::size_t N>
void copy(const std::array<double, N>& from, double* to) noexcept {
  for (std::size_t k = 0; k < N; ++k) to[k] = from[k];
}

bool is_finite(const wh_measurement& in) noexcept {
  double sum = in.gap;
  for (const double x : in.position) sum += x;
  for (const double x : in.rotation) sum += x;
  return std::isfinite(sum);
}

GripperState state_of(const wh_measurement& in) noexcept {
  GripperState state;
  bool has_rotation = false;
  for (int k = 0; k < 3; ++k) state.position[k] = in.position[k];
  for (int k = 0; k < 9; ++k) has_rotation = has_rotation || in.rotation[k] != 0;
  if (has_rotation)
    for (int k = 0; k < 9; ++k) state.rotation[k] = in.rotation[k];
  state.gap = in.gap;
  state.buttons = in.buttons;
  return state;
}

wh_session_output output_of(const Tick& tick) noexcept {
  wh_session_output out{};
  out.state = static_cast<wh_state>(static_cast<int>(tick.state));
  out.vessel = tick.vessel;
  copy(tick.wanted.arm, out.arm_force);
  out.grip_force = tick.wanted.grip;
  out.normal_force = tick.normal_force;
  out.feedback_force = tick.feedback;
  out.user_force = tick.user_force;
  out.weight = tick.weight;
  out.torque = tick.torque;
  out.tilt = tick.tilt;
  copy(tick.vessel_place, out.vessel_place);
  copy(tick.vessel_rotation, out.vessel_rotation);
  for (int k = 0; k < 2; ++k) copy(tick.tips[k], out.tips[k]);
  out.touch_mask = tick.touch_mask;
  out.used_mask = tick.used_mask;
  out.grasps = tick.grasps;
  out.lost = tick.lost;
  out.destinations = tick.destinations;
  out.is_task_done = tick.task_done ? 1 : 0;
  return out;
}

}  // namespace

wh_status wh_session_open(const wh_scene* scene, double gap_closed, double gap_open, wh_session** session) {
  if (!scene || !session) return fail(WH_ARGUMENT, "wh_session_open: a pointer is null");
  *session = nullptr;
  if (!std::isfinite(gap_closed) || !std::isfinite(gap_open)) return fail(WH_INPUT, "wh_session_open: a gap is not finite");
  return guarded([&] {
    *session = new wh_session(scene->scene, {gap_closed, gap_open});
    return WH_OK;
  });
}

void wh_session_free(wh_session* session) { delete session; }

wh_status wh_session_step(wh_session* session, const wh_measurement* measurement, wh_session_output* output) {
  if (!session) return fail(WH_ARGUMENT, "wh_session_step: the session is null");
  wh_measurement in;
  if (!take_over(measurement, in)) return fail(WH_ARGUMENT, "wh_session_step: the measurement is null, or its size is not set");
  if (!output || output->size < sizeof output->size)
    return fail(WH_ARGUMENT, "wh_session_step: the output is null, or its size is not set");
  const Entered entered(*session);
  if (!entered) return fail(WH_BUSY, "wh_session_step: another thread is in this session");
  if (!is_finite(in)) return fail(WH_INPUT, "wh_session_step: the measurement is not finite");
  if (in.tick <= session->last) return fail(WH_INPUT, "wh_session_step: the tick is not greater than the one before");
  session->last = in.tick;
  session->session.step(state_of(in), in.tick, session->tick);
  session->tracker.follow(session->tick);
  if (!give_back(output_of(session->tick), output)) return fail(WH_ARGUMENT, "wh_session_step: the output's size cannot be");
  return WH_OK;
}

wh_status wh_session_hand(wh_session* session, wh_hand* hand) {
  if (!session) return fail(WH_ARGUMENT, "wh_session_hand: the session is null");
  const Entered entered(*session);
  if (!entered) return fail(WH_BUSY, "wh_session_hand: another thread is in this session");
  if (session->last < 0) return fail(WH_ARGUMENT, "wh_session_hand: there is no hand before the first step");
  return guarded([&] {
    const HandView view = hand_view(session->session.live(), session->tick, session->tracker.poses());
    wh_hand own{};
    for (int j = 0; j < WH_JOINTS; ++j) copy(view.proxies[static_cast<std::size_t>(j)], own.joints[j]);
    copy(view.wrist, own.wrist);
    copy(view.rotation, own.rotation);
    return give_back(own, hand) ? WH_OK : fail(WH_ARGUMENT, "wh_session_hand: the hand is null, or its size is not set");
  });
}

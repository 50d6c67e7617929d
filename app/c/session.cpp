// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <cmath>

#include "app/c/scene.h"
#include "app/c/status.h"
#include "core/vectors.h"
#include "device/session/hand_view.h"
#include "device/session/reach.h"
#include "device/session/session.h"
#include "sweeps/grips/hand_nodes.h"

using namespace wholehand;

struct wh_session {
  wh_session(const Scene& scene, std::array<double, 2> gap) : session(scene, gap), yielding(session.live().hand) {}
  device::Session session;
  core_f64::Hand yielding;
  device::Tick tick;
  std::int64_t last = -1;  // number of the last tick; -1: none yet
  std::atomic_flag is_in_use = ATOMIC_FLAG_INIT;
};

namespace {

template <std::size_t N>
void copy(const std::array<double, N>& from, double* to) noexcept {
  for (std::size_t k = 0; k < N; ++k) to[k] = from[k];
}

device::GripperState state_of(const wh_measurement& in) noexcept {
  device::GripperState state;
  std::copy_n(in.position, 3, state.position.begin());
  // all zeros mean no rotation
  if (std::any_of(in.rotation, in.rotation + 9, [](double x) { return x != 0; }))
    std::copy_n(in.rotation, 9, state.rotation.begin());
  state.gap = in.gap;
  state.buttons = in.buttons;
  return state;
}

wh_session_output output_of(const device::Tick& tick) noexcept {
  wh_session_output out{};
  out.state = static_cast<std::int32_t>(tick.state);
  out.vessel = tick.vessel;
  copy(tick.wanted.arm, out.arm_force);
  out.grip_force = tick.wanted.grip;
  out.normal_force = tick.normal_force;
  out.feedback_force = tick.feedback;
  out.user_force = tick.user_force;
  out.weight = tick.weight;
  out.torque = tick.torque;
  out.tilt = tick.tilt;
  out.flow = tick.flow;
  out.closure = tick.closure;
  out.gap = tick.gap;
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
    *session = new wh_session(scene->ready->scene, {gap_closed, gap_open});
    return WH_OK;
  });
}

void wh_session_free(wh_session** session) {
  if (!session) return;
  delete *session;
  *session = nullptr;
}

wh_status wh_session_period(const wh_session* session, double* seconds) {
  if (!session || !seconds) return fail(WH_ARGUMENT, "wh_session_period: a pointer is null");
  *seconds = 1 / session->session.live().scene.live.rate;
  return WH_OK;
}

wh_status wh_session_step(wh_session* session, const wh_measurement* measurement, wh_session_output* output) {
  if (!session) return fail(WH_ARGUMENT, "wh_session_step: the session is null");
  wh_measurement in;
  if (const wh_status status = take_over(measurement, in, "wh_session_step: the measurement"); status != WH_OK) return status;
  if (const wh_status status = check_answer(output, "wh_session_step: the output"); status != WH_OK) return status;
  const Entered entered(session->is_in_use);
  if (!entered) return fail(WH_BUSY, "wh_session_step: another thread is in this session");
  const device::GripperState state = state_of(in);
  if (!device::is_finite(state)) return fail(WH_INPUT, "wh_session_step: the measurement is not finite");
  if (!device::is_in_reach(state))
    return fail(WH_INPUT, "wh_session_step: the measurement is out of reach; allowed: a position up to 25 m, a gap up to 10 m");
  if (!is_rotation(state.rotation, device::ROTATION_TOLERANCE))
    return fail(WH_INPUT, "wh_session_step: the measurement's rotation is not a rotation matrix");
  if (in.reserved != 0) return fail(WH_ARGUMENT, "wh_session_step: a reserved member of the measurement is not 0");
  if (in.tick < 0 || in.tick > device::LAST_TICK)
    return fail(WH_INPUT, "wh_session_step: the tick is %lld; allowed: 0 to 2^53", static_cast<long long>(in.tick));
  if (in.tick <= session->last)
    return fail(WH_INPUT, "wh_session_step: the tick %lld does not come after the tick %lld", static_cast<long long>(in.tick),
                static_cast<long long>(session->last));
  session->last = in.tick;
  session->session.step(state, in.tick, session->tick);
  give_back(output_of(session->tick), output);
  return WH_OK;
}

wh_status wh_session_vessel_at(wh_session* session, size_t index, wh_session_vessel* vessel) {
  if (!session) return fail(WH_ARGUMENT, "wh_session_vessel_at: the session is null");
  if (const wh_status status = check_answer(vessel, "wh_session_vessel_at: the vessel's struct"); status != WH_OK) return status;
  const Entered entered(session->is_in_use);
  if (!entered) return fail(WH_BUSY, "wh_session_vessel_at: another thread is in this session");
  const std::size_t vessels = session->session.live().scene.vessels.size();
  if (index >= vessels)
    return fail(WH_ARGUMENT, "wh_session_vessel_at: the scene has %zu vessels, and none of number %zu", vessels, index);
  wh_session_vessel own{};
  const device::VesselPose& pose = session->session.poses()[index];
  copy(pose.place, own.place);
  copy(pose.rotation, own.rotation);
  const bool has_stepped = session->last >= 0;
  own.volume = has_stepped ? session->tick.volume[index] : session->session.live().vessels[index].volume;
  own.arrived = session->tick.arrived[index];
  own.spilled = session->tick.spilled[index];
  give_back(own, vessel);
  return WH_OK;
}

wh_status wh_session_hand(wh_session* session, wh_hand* hand) {
  if (!session) return fail(WH_ARGUMENT, "wh_session_hand: the session is null");
  if (const wh_status status = check_answer(hand, "wh_session_hand: the hand's struct"); status != WH_OK) return status;
  const Entered entered(session->is_in_use);
  if (!entered) return fail(WH_BUSY, "wh_session_hand: another thread is in this session");
  if (session->last < 0) return fail(WH_ARGUMENT, "wh_session_hand: there is no hand before the first step");
  const device::LiveScene& live = session->session.live();
  const device::HandView view = device::hand_posture(live, session->tick, session->session.poses(), session->yielding);
  const sweeps::HandNodes nodes = sweeps::hand_nodes(live.scene.hand, live.hand, view.wrist, view.rotation, view.proxies);
  wh_hand own{};
  for (std::size_t j = 0; j < WH_JOINTS; ++j) {
    copy(view.proxies[j], own.joints[j]);
    copy(nodes.joints[j].rotation, own.quaternions[j]);
    own.radii[j] = nodes.joints[j].radius;
    own.contacts[j] = static_cast<std::int32_t>(view.contact[j]);
  }
  copy(view.wrist, own.wrist);
  copy(view.rotation, own.rotation);
  copy(nodes.wrist.rotation, own.wrist_quaternion);
  give_back(own, hand);
  return WH_OK;
}

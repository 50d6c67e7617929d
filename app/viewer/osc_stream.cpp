// SPDX-License-Identifier: MIT
#include "app/viewer/osc_stream.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text/error.h"
#include "core/joints.h"
#include "core/reader/text.h"
#include "device/advice/words.h"
#include "device/session/amounts.h"

namespace wholehand {
namespace {

constexpr std::string_view SCHEME = "osc://";
constexpr const char* PLACE = "--stream";
constexpr float UNHOLDABLE = -1;  // a hold force or an effort that is infinite

float number(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0; }
float holding_number(double value) { return std::isinf(value) ? UNHOLDABLE : number(value); }

}  // namespace

HostPort parse_osc_url(const std::string& url) {
  const auto refuse = [&url](const std::string& found) {
    throw usage_error(
        fmt::format("--stream {}: {}; allowed: osc://HOST:PORT, for example osc://127.0.0.1:9000", in_quotes(url), found));
  };
  if (url.rfind(SCHEME, 0) != 0) refuse("it does not begin with osc://");
  HostPort target;
  const std::string wrong = read_host_port(url.substr(SCHEME.size()), 1, target);
  if (!wrong.empty()) refuse(wrong);
  return target;
}

OscStream::OscStream(const HostPort& target, const device::LiveScene& live)
    : live_(live), to_(find_udp_address(target, PLACE)), socket_(to_.family(), PLACE) {
  for (int j = 0; j < JOINT_COUNT; ++j) joints_[j] = std::string("/wholehand/joint/") + JOINT_NAMES[j].openxr;
  for (int j = 0; j < JOINT_COUNT; ++j) ghost_joints_[j] = std::string("/wholehand/advice/joint/") + JOINT_NAMES[j].openxr;
  for (const VesselData& vessel : live.scene.vessels) {
    const std::string address = "/wholehand/vessel/" + vessel.name;
    vessels_.push_back({address + "/pose", address + "/liquid", {}});
  }
  if (live.scene.task)
    for (const auto& [liquid, volume] : live.scene.task->amounts) amounts_.push_back("/wholehand/amount/" + liquid);
  if (!to_.is_loopback()) {
    note_ = fmt::format("{}: the session goes unencrypted to {} port {}, outside of this machine", PLACE, to_.host(), target.port);
  }
  socket_.allow_broadcast();
}

void OscStream::show(const device::DisplayMoment& moment) noexcept {
  const auto state = static_cast<std::size_t>(moment.tick.state);
  tick_ = static_cast<std::int32_t>(moment.tick.number & INT32_MAX);
  time_ = number(static_cast<double>(moment.tick.number) / live_.scene.live.rate);
  put("/wholehand/state", {static_cast<std::int32_t>(state), std::string_view(device::SESSION_STATE_NAMES[state])});
  put_hand(moment);
  put_vessels(moment.tick, moment.poses);
  put_forces(moment);
  put_task(moment.tick);
  if (moment.advice) put_advice(*moment.advice, moment.poses);
  put("/wholehand/end", {tick_});
  flush();
}

// Every datagram first names its frame.
void OscStream::put(std::string_view address, std::span<const OscValue> values) noexcept {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (bundle_.is_empty()) bundle_.add("/wholehand/frame", {tick_, time_});
    if (bundle_.add(address, values)) return;
    flush();
  }
}

// A quaternion and its negative are the same rotation; sending the one nearer to the previous one lets receivers smooth it number by number.
void OscStream::put_pose(std::string_view address, const Triple& place, const Quaternion& turn, Quaternion& before) noexcept {
  double dot = 0;
  for (std::size_t k = 0; k < 4; ++k) dot += turn[k] * before[k];
  for (std::size_t k = 0; k < 4; ++k) before[k] = dot < 0 ? -turn[k] : turn[k];
  put(address, {number(place[0]), number(place[1]), number(place[2]), number(before[0]), number(before[1]), number(before[2]),
                number(before[3])});
}

void OscStream::flush() noexcept {
  if (!bundle_.is_empty()) socket_.send(bundle_.bytes(), to_);
  bundle_.clear();
}

void OscStream::put_hand(const device::DisplayMoment& moment) noexcept {
  const device::Tick& tick = moment.tick;
  const device::HandView& hand = moment.hand;
  const HandData& data = live_.scene.hand;
  std::string_view vessel;
  if (tick.vessel >= 0) vessel = live_.scene.vessels[static_cast<std::size_t>(tick.vessel)].name;
  put("/wholehand/hand/side", {std::string_view(data.handedness == Handedness::left ? "left" : "right")});
  put("/wholehand/hand/closure", {number(tick.closure)});
  put("/wholehand/hand/gap", {number(tick.gap)});
  put("/wholehand/hand/vessel", {static_cast<std::int32_t>(tick.vessel), vessel});
  put("/wholehand/hand/tilt", {number(tick.tilt)});
  put("/wholehand/hand/flow", {number(tick.flow)});
  const sweeps::HandNodes nodes = sweeps::hand_nodes(data, live_.hand, hand.wrist, hand.rotation, hand.proxies);
  put_pose("/wholehand/joint/XR_HAND_JOINT_WRIST_EXT", nodes.wrist.position, nodes.wrist.rotation, turns_[JOINT_COUNT]);
  for (int j = 0; j < JOINT_COUNT; ++j) put_pose(joints_[j], nodes.joints[j].position, nodes.joints[j].rotation, turns_[j]);
  std::array<OscValue, JOINT_COUNT> contacts;
  for (int j = 0; j < JOINT_COUNT; ++j) contacts[j] = static_cast<std::int32_t>(hand.contact[j]);
  put("/wholehand/hand/contacts", contacts);
}

void OscStream::put_vessels(const device::Tick& tick, const device::VesselPoses& poses) noexcept {
  for (std::size_t v = 0; v < vessels_.size(); ++v) {
    put_pose(vessels_[v].pose, poses[v].place, quaternion_of(poses[v].rotation), vessels_[v].turn);
    put(vessels_[v].liquid, {number(tick.volume[v])});
  }
}

void OscStream::put_forces(const device::DisplayMoment& moment) noexcept {
  const device::Tick& tick = moment.tick;
  const std::optional<device::HandHold>& hold = moment.hand.hold;
  const float base = device::is_held(tick.state) ? number(live_.scene.force.base) : 0;
  put("/wholehand/force/feedback", {number(tick.feedback)});
  put("/wholehand/force/base", {base});
  put("/wholehand/force/normal", {number(tick.normal_force)});
  put("/wholehand/force/opening", {number(tick.opening_force)});
  put("/wholehand/force/user", {number(tick.user_force)});
  put("/wholehand/force/hold", {holding_number(hold ? hold->force() : tick.hold_force)});
  put("/wholehand/force/weight", {number(tick.weight)});
  put("/wholehand/force/torque", {number(tick.torque)});
  if (live_.scene.strength) put_holding(hold);
}

void OscStream::put_holding(const std::optional<device::HandHold>& hold) noexcept {
  put("/wholehand/force/tips_hold", {hold ? holding_number(hold->tips_force()) : 0});
  put("/wholehand/hand/effort", {hold ? holding_number(hold->effort) : 0});
  put("/wholehand/hand/tips_effort", {hold ? holding_number(hold->tips) : 0});
}

void OscStream::put_advice(const device::Advice& advice, const device::VesselPoses& poses) noexcept try {
  const bool is_near = advice.vessel >= 0;
  std::string_view vessel;
  if (is_near) vessel = live_.scene.vessels[static_cast<std::size_t>(advice.vessel)].name;
  const std::string words = device::advice_words(advice);
  put("/wholehand/advice/vessel", {static_cast<std::int32_t>(advice.vessel), vessel});
  put("/wholehand/advice/words", {std::string_view(words)});
  put("/wholehand/advice/better", {is_near && advice.best && advice.is_better ? 1 : 0});
  if (!is_near) return;
  const auto effort = [](const device::RatedGrip* grip) {
    return grip && grip->is_possible ? holding_number(grip->effort) : UNHOLDABLE;
  };
  put("/wholehand/advice/effort", {effort(&advice.present), effort(advice.best ? &*advice.best : nullptr)});
  if (const device::TiltAhead* hardest = advice.ahead ? advice.ahead->hardest() : nullptr)
    put("/wholehand/advice/ahead",
        {number(hardest->tilt), holding_number(hardest->effort), holding_number(advice.ahead->other_worst())});
  if (!advice.best) return;
  const GripInput& grip = advice.best->grip;
  put("/wholehand/advice/grip",
      {number(grip.height), number(grip.azimuth), number(grip.obliquity), number(grip.roll), number(grip.offset)});
  if (const std::optional<GhostHand> ghost = ghost_of(live_.scene, advice, poses)) put_ghost(*ghost);
} catch (...) {  // no memory for this moment; the next one comes
}

void OscStream::put_ghost(const GhostHand& ghost) noexcept {
  put_pose("/wholehand/advice/joint/XR_HAND_JOINT_WRIST_EXT", ghost.wrist.place, ghost.wrist.turn, ghost_turns_[JOINT_COUNT]);
  for (int j = 0; j < JOINT_COUNT; ++j) put_pose(ghost_joints_[j], ghost.joints[j].place, ghost.joints[j].turn, ghost_turns_[j]);
}

void OscStream::put_task(const device::Tick& tick) noexcept {
  const Scene& scene = live_.scene;
  for (std::size_t k = 0; k < amounts_.size(); ++k) {
    const auto& [liquid, wanted] = scene.task->amounts[k];
    put(amounts_[k], {number(device::total_arrived(scene, tick, liquid)), number(wanted)});
  }
  put("/wholehand/task/spilled", {number(device::total_spilled(scene, tick))});
  put("/wholehand/task/guidance", {static_cast<std::int32_t>(tick.guidance)});
  put("/wholehand/task/done", {tick.task_done ? 1 : 0});
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "device/session/hand_view.h"

#include <algorithm>
#include <cmath>

#include "core/contacts.h"
#include "core/joints.h"
#include "core/prepare.h"
#include "core/vectors.h"

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec3;

namespace {

constexpr double OPPOSED = 0.5;  // cosine between a contact's normal and the line of the tips: from here on fully opposed

constexpr bool is_tracked(int joint) { return joint == THUMB_TIP || joint == INDEX_TIP; }

// The hand under way, in the world of the right hand.
class View {
 public:
  View(const LiveScene& live, const Tick& tick, const VesselPoses& poses, core_f64::Hand& yielding)
      : live_(live), tick_(tick), yielding_(yielding) {
    for (std::size_t v = 0; v < live.vessels.size(); ++v) stances_[v] = live.stance(poses[v]);
    rotation_ = live.mirror.in(tick.hand_rotation);
    for (int k = 0; k < 2; ++k) tips_[k] = live.mirror.in(tick.proxies[k]);
  }

  HandView make() {
    // a session that is over keeps what it last had in its hand
    const bool is_holding =
        tick_.vessel >= 0 && (is_held(tick_.state) || (tick_.state == SessionState::released && tick_.touch_mask != 0));
    rig();
    if (is_holding) {
      view_.vessel = tick_.vessel;
      pose(live_.hand, 1);
      leave_vessel(tick_.vessel);
      mark(tick_.touch_mask);
    } else {
      approach();
      std::uint32_t touching = 0;
      for (std::size_t v = 0; v < live_.vessels.size(); ++v) touching |= leave_vessel(static_cast<int>(v));
      mark(touching);
    }
    for (int j = 0; j < JOINT_COUNT; ++j) {
      view_.posed[j] = live_.mirror.out(posed_[j]);
      view_.proxies[j] = live_.mirror.out(proxies_[j]);
    }
    return view_;
  }

 private:
  // The hand that the gripper moves.
  void rig() {
    double e1_x = 0;
    core_f64::Closing closing;
    closing.closure = tick_.closure;
    closing.placement =
        place_live_hand(live_.hand, tick_.closure, rotation_, live_.mirror.in(tick_.middle), live_.hand.scale, e1_x);
    core_f64::GripAnswer answer;
    rest_hand(live_.hand, live_.vessels[0].vessel, core_f64::PoseKind::rigged, closing, 0, {true, false}, answer);
    for (int j = 0; j < JOINT_COUNT; ++j) view_.rigged[j] = live_.mirror.out(answer.joints[j]);
    view_.rigged_wrist = live_.mirror.out(closing.placement.translation);
  }

  // Before a grasp: the nearest vessel, and how far the other fingers have come to it.
  void approach() {
    double nearest = core_f64::NO_DISTANCE;
    for (int v = 0; v < static_cast<int>(live_.vessels.size()); ++v) {
      const double away = std::max(tip_separation(v, 0), tip_separation(v, 1));
      const bool is_meant = tick_.vessel == v && tick_.state == SessionState::touching;
      if (away >= nearest && !is_meant) continue;
      nearest = away;
      view_.vessel = v;
      if (is_meant) break;
    }
    const double near = std::clamp(1 - nearest / CLOSING_IN, 0.0, 1.0);
    const double share = near > 0 ? minimum_jerk(near) * minimum_jerk(opposition(view_.vessel)) : 0;
    if (share <= 0) {
      pose(live_.hand, 0);
      if (!(nearest < NEARBY)) view_.vessel = -1;
      return;
    }
    yielding_.max_angle = live_.hand.max_angle * share;
    yielding_.paper_max_angle = live_.hand.paper_max_angle * share;
    pose(yielding_, share);
  }

  double tip_separation(int v, int k) const {
    return core_f64::separation_at(live_.vessels[v].vessel, stances_[v].inward(tips_[k]), radius(k == 0 ? THUMB_TIP : INDEX_TIP));
  }

  // From 0 where the tips are not at either side of a vessel to 1 where they are opposed: a grasp asks for some of it
  // (GRAZING_COSINE).
  double opposition(int v) const {
    const Vec3 apart = tips_[1] - tips_[0];
    const double gap = glm::length(apart);
    if (!(gap > 0)) return 0;
    double least = 1;
    for (int k = 0; k < 2; ++k) {
      int element = -1;
      const Vec3 normal =
          stances_[v].rotation * core_f64::distance_gradient(live_.vessels[v].vessel, stances_[v].inward(tips_[k]), element);
      least = std::min(least, glm::dot(normal, (k == 0 ? -1.0 : 1.0) * apart / gap));
    }
    return std::clamp((least - GRAZING_COSINE) / (OPPOSED - GRAZING_COSINE), 0.0, 1.0);
  }

  // The hand with its tips at their proxies; its other fingers as the scene's pose has it, where they have begun to come to the
  // vessel (`share` > 0). A finger that is not at the glass yet and was inside it when open stays on its trajectory.
  void pose(const core_f64::Hand& hand, double share) {
    const int v = std::max(0, view_.vessel);
    const Stance& stance = stances_[v];
    double e1_x = 0;
    const core_f64::Closing closing = close_live_hand(hand, {stance.inward(tips_[0]), stance.inward(tips_[1])}, Vec3(0),
                                                      glm::transpose(stance.rotation) * rotation_, e1_x);
    const auto kind = share > 0 ? static_cast<core_f64::PoseKind>(static_cast<int>(live_.scene.pose)) : core_f64::PoseKind::rigged;
    core_f64::GripAnswer answer;
    rest_hand(hand, live_.vessels[v].vessel, kind, closing, 0, {true, false}, answer);
    projected_ = answer.tip_mask | answer.finger_mask | answer.inner_mask;
    for (int j = 0; j < JOINT_COUNT; ++j) {
      const bool is_blocked = (answer.status >> (STATUS_BLOCKED_SHIFT + finger_of(j)) & 1) != 0;
      posed_[j] = stance.outward(is_blocked && share < 1 ? answer.joints[j] : answer.posed[j]);
    }
    posed_[THUMB_TIP] = tips_[0];
    posed_[INDEX_TIP] = tips_[1];
    proxies_ = posed_;
    view_.wrist = live_.mirror.out(stance.outward(closing.placement.translation));
    view_.rotation = live_.mirror.out(stance.rotation * closing.placement.rotation);
  }

  // Kernel 4 on the points, in the frame of a vessel: those inside go out of it. Returns which touch it.
  std::uint32_t leave_vessel(int v) {
    const core_f64::Vessel& vessel = live_.vessels[v].vessel;
    const Stance& stance = stances_[v];
    const Vec3 center = stance.outward(Vec3(0, vessel.bound_height, 0));
    std::uint32_t touching = 0;
    for (int j = 0; j < JOINT_COUNT; ++j) {
      if (glm::length(proxies_[j] - center) > vessel.bound_radius + radius(j) + live_.hand.contact_tolerance) continue;
      const core_f64::Contact contact = core_f64::contact_at(vessel, stance.inward(proxies_[j]), radius(j));
      if (contact.separation <= live_.hand.contact_tolerance) touching |= 1u << j;
      if (contact.separation < 0) proxies_[j] = stance.outward(contact.proxy);
    }
    return touching;
  }

  void mark(std::uint32_t touching) {
    for (int j = 0; j < JOINT_COUNT; ++j) {
      const bool touches = (touching >> j & 1) != 0, is_projected = (projected_ >> j & 1) != 0;
      view_.contact[j] = is_tracked(j) ? (touches ? PointContact::tracked_touching : PointContact::tracked)
                         : !touches    ? PointContact::free
                                       : (is_projected ? PointContact::projected : PointContact::touching);
    }
  }

  double radius(int joint) const {
    const int finger = finger_of(joint);
    return live_.hand.scale * live_.hand.radius[finger][joint - finger_start(finger)];
  }

  static constexpr double NEARBY = 0.1;  // m: a vessel so near to both tips is reported

  const LiveScene& live_;
  const Tick& tick_;
  core_f64::Hand& yielding_;
  std::array<Stance, LIVE_VESSELS> stances_;
  Mat3 rotation_{1};
  std::array<Vec3, 2> tips_{};
  std::array<Vec3, JOINT_COUNT> posed_{}, proxies_{};
  std::uint32_t projected_ = 0;
  HandView view_;
};

// Up as a vessel sees it; its sine and cosine to the axis.
struct Upward {
  explicit Upward(const Rotation& rotation)
      : up(rotation[3], rotation[4], rotation[5]), sine(std::hypot(up.x, up.z)), cosine(up.y) {}
  Vec3 up;
  double sine, cosine;
};

}  // namespace

HandView hand_posture(const LiveScene& live, const Tick& tick, const VesselPoses& poses, core_f64::Hand& yielding) {
  return View(live, tick, poses, yielding).make();
}

HandView hand_view(const LiveScene& live, const Tick& tick, const VesselPoses& poses) {
  core_f64::Hand yielding = live.hand;
  HandView view = hand_posture(live, tick, poses, yielding);
  view.hold = hand_hold(live, tick, view.posed);
  return view;
}

std::optional<LiquidSurface> liquid_surface(const core_f64::Vessel& vessel, const core_f64::Quadrature& quadrature, double volume,
                                            const Rotation& rotation) {
  if (!(volume > 0) || vessel.cavity.empty()) return std::nullopt;
  const Upward to(rotation);
  const double held_back = core_f64::lip_capacity(vessel, quadrature, to.sine, to.cosine);
  if (!(held_back > 0)) return std::nullopt;
  const auto state = core_f64::liquid_at(vessel, quadrature, std::min(volume, held_back), to.sine, to.cosine);
  return LiquidSurface{to_triple(to.up), state.level};
}

std::optional<PouringStream> pouring_stream(const LiveScene& live, const Tick& tick, double table) {
  if (!(tick.flow > 0) || tick.vessel < 0) return std::nullopt;
  const core_f64::Vessel& glass = live.vessels[tick.vessel].vessel;
  const Upward to(tick.vessel_rotation);
  if (!(to.sine > core_f64::UPRIGHT_SINE)) return std::nullopt;
  const Vec3 lip(-glass.mouth_radius * to.up.x / to.sine, glass.mouth_height, -glass.mouth_radius * to.up.z / to.sine);
  PouringStream stream;
  stream.flow = tick.flow;
  stream.from = to_triple(to_vec3(tick.vessel_place) + to_mat3(tick.vessel_rotation) * lip);
  stream.to = {stream.from[0], std::min(table, stream.from[1]), stream.from[2]};
  if (const auto& task = live.scene.task) {
    const Triple& mouth = task->target_place;
    const bool hits = stream.from[1] >= mouth[1] &&
                      std::hypot(stream.from[0] - mouth[0], stream.from[2] - mouth[2]) <= 0.5 * task->target_diameter;
    if (hits) stream.to[1] = table + target_level(*task, target_volume(live.scene, tick), table);
  }
  return stream;
}

double target_level(const TaskData& task, double volume, double table) {
  const double radius = 0.5 * task.target_diameter;
  return std::clamp(volume / (PI * radius * radius), 0.0, std::max(0.0, task.target_place[1] - table));
}

double target_volume(const Scene& scene, const Tick& tick) {
  double volume = 0;
  for (std::size_t v = 0; v < std::min<std::size_t>(scene.vessels.size(), LIVE_VESSELS); ++v) volume += tick.arrived[v];
  return volume;
}

double table_height(const Scene& scene) {
  double lowest = core_f64::NO_DISTANCE;
  for (const VesselData& vessel : scene.vessels) lowest = std::min(lowest, vessel.place[1] + vessel.base);
  return lowest;
}

}  // namespace wholehand::device

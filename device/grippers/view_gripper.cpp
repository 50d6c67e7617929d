// SPDX-License-Identifier: MIT
#include "device/grippers/view_gripper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/prepare.h"
#include "core/quaternion.h"
#include "core/vectors.h"
#include "device/grippers/follower.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

// The box about vessels, target and destination.
struct Surroundings {
  Vec3 least{std::numeric_limits<double>::max()}, most{std::numeric_limits<double>::lowest()};
  void add(const Triple& place, double radius, double below, double above) {
    least = glm::min(least, to_vec3(place) + Vec3(-radius, below, -radius));
    most = glm::max(most, to_vec3(place) + Vec3(radius, above, radius));
  }
};

Surroundings surroundings_of(const Scene& scene) {
  Surroundings box;
  for (const VesselData& vessel : scene.vessels)
    box.add(vessel.place, prepare_vessel(vessel, vessel.has_cavity()).largest_radius, vessel.base, vessel.height);
  if (scene.task) {
    box.add(scene.task->target_place, scene.task->target_diameter / 2, 0, 0);
    box.add(scene.task->destination, 0, 0, 0);
  }
  return box;
}

std::array<double, 2> gap_of(const HandData& hand) {
  const PreparedHand prepared = prepare_hand(hand);
  return {hand.scale * prepared.gap_closed, hand.scale * prepared.gap_open};
}

// The turn by which `to` becomes `from`: axis times angle, at most pi.
Vec3 turn_between(const glm::dquat& from, const glm::dquat& to) {
  glm::dquat apart = from * glm::conjugate(to);
  if (apart.w < 0) apart = -apart;
  const Vec3 along(apart.x, apart.y, apart.z);
  const double sine = glm::length(along);
  return sine > 1e-12 ? (2 * std::atan2(sine, apart.w) / sine) * along : 2.0 * along;
}

glm::dquat turn_by(Vec3 turn) {
  const double angle = glm::length(turn);
  const Vec3 along = (angle > 1e-12 ? std::sin(angle / 2) / angle : 0.5) * turn;
  return {std::cos(angle / 2), along.x, along.y, along.z};
}

class ViewGripper final : public Gripper {
 public:
  ViewGripper(const Scene& scene, ViewInput& input) : input_(input), period_(1 / scene.live.rate) {
    limits_.name = "the page";
    limits_.address = "view";
    limits_.force = PAPER_FORCE;
    limits_.grip = PAPER_GRIP;
    limits_.gap = input.workspace().device_gap();
    limits_.rate = scene.live.rate;
    limits_.is_left_handed = scene.hand.handedness == Handedness::left;
    const double jump = scene.live.jump / 2;
    arm_pace_ = {VIEW_RATE, std::min(VIEW_SPEED / scene.device.workspace_scale, jump)};
    gap_pace_ = {VIEW_RATE, std::min(VIEW_GAP_SPEED / input.workspace().gap_slope(), jump)};
    turn_pace_ = {VIEW_RATE, VIEW_TURN};
    aim(input.state_of(input.limits().start));
    place_ = to_vec3(goal_.position);
    turn_ = goal_turn_;
    gap_ = goal_.gap;
  }

  const GripperLimits& limits() const noexcept override { return limits_; }

  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    GripperState wanted;
    if (input_.take(wanted)) aim(wanted);
    const double seconds = last_ < 0 ? 0 : period_ * static_cast<double>(tick - last_);
    last_ = tick;
    place_ += follow(place_ - to_vec3(goal_.position), velocity_, arm_pace_, seconds);
    gap_ += follow(gap_ - goal_.gap, gap_speed_, gap_pace_, seconds);
    turn_ = glm::normalize(turn_by(follow(turn_between(turn_, goal_turn_), turn_speed_, turn_pace_, seconds)) * turn_);
    state.position = to_triple(place_);
    state.rotation = to_rotation(glm::mat3_cast(turn_));
    state.gap = gap_;
    state.buttons = goal_.buttons;
    state.sequence = ++reads_;
    state.time = period_ * static_cast<double>(tick);
    return ReadOutcome::value;
  }

  bool write(const GripperForce&) noexcept override { return true; }

 private:
  void aim(const GripperState& wanted) noexcept {
    goal_ = wanted;
    goal_turn_ = to_quat(to_mat3(wanted.rotation));
  }

  ViewInput& input_;
  GripperLimits limits_;
  double period_;  // s
  Pace arm_pace_, gap_pace_, turn_pace_;
  GripperState goal_;
  glm::dquat goal_turn_{1, 0, 0, 0}, turn_{1, 0, 0, 0};
  Vec3 place_{}, velocity_{}, turn_speed_{};
  double gap_ = 0, gap_speed_ = 0;
  std::int64_t last_ = -1;  // tick; -1: none
  std::uint32_t reads_ = 0;
};

}  // namespace

ViewInput::ViewInput(const Scene& scene) : ViewInput(scene, gap_of(scene.hand)) {}

ViewInput::ViewInput(const Scene& scene, std::array<double, 2> hand_gap) : workspace_(scene, hand_gap, hand_gap) {
  const Surroundings box = surroundings_of(scene);
  const Vec3 center = 0.5 * (box.least + box.most);
  limits_.gap = hand_gap;
  limits_.center = to_triple(center);
  limits_.reach = 0.5 * glm::length(box.most - box.least) + VIEW_REACH;
  limits_.start.position = {center.x, center.y, box.most.z + VIEW_CLEARANCE};
  limits_.start.gap = hand_gap[1];
}

GripperState ViewInput::state_of(const ViewControl& control) const noexcept {
  HandPose pose;
  pose.middle = workspace_.mirror().in(control.position);
  pose.rotation = workspace_.mirror().in(control.rotation);
  pose.gap = control.gap;  // kept within the hand's by unmap
  GripperState state = workspace_.unmap(pose);
  state.buttons = control.buttons;
  return state;
}

bool ViewInput::post(const ViewControl& control) {
  ViewControl wanted = control;
  const Vec3 center = to_vec3(limits_.center), out = to_vec3(control.position) - center;
  const double far = glm::length(out);
  if (far > limits_.reach) wanted.position = to_triple(center + (limits_.reach / far) * out);
  const GripperState state = state_of(wanted);
  const std::lock_guard lock(mutex_);
  const std::int64_t behind = has_last_ ? last_ - control.sequence : -1;
  if (behind >= 0 && behind < OVERTAKEN) return false;
  has_last_ = true;
  last_ = control.sequence;
  newest_.put(state);
  return true;
}

std::unique_ptr<Gripper> open_view(const Scene& scene, ViewInput& input) { return std::make_unique<ViewGripper>(scene, input); }

}  // namespace wholehand::device

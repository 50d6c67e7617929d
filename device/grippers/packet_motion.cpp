// SPDX-License-Identifier: MIT
#include "device/grippers/packet_motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/gtc/quaternion.hpp>

#include "core/vectors.h"
#include "device/loop/guard.h"

namespace wholehand::device {

PacketMotion::Pose PacketMotion::pose_of(const GripperState& state) noexcept {
  return {to_vec3(state.position), to_quat(to_mat3(state.rotation)), state.gap};
}

void PacketMotion::start(const GripperState& state, std::int64_t tick) noexcept {
  from_ = goal_ = pose_of(state);
  buttons_ = state.buttons;
  began_ = moved_ = heard_ = tick;
}

// The move begins where the hand was at the previous tick, so that a sender as fast as the loop is not followed a tick late.
void PacketMotion::aim(const GripperState& goal, std::int64_t tick) noexcept {
  from_ = at(moved_);
  began_ = moved_;
  goal_ = pose_of(goal);
  buttons_ = goal.buttons;
  const double interval = silence(tick);
  heard_ = tick;
  intervals_[next_++ % intervals_.size()] = interval;
  const double longest = *std::max_element(intervals_.begin(), intervals_.end());
  span_ = std::clamp(std::max(longest, span_ * std::exp(-interval / FORGETS)), period_, LONGEST);
}

PacketMotion::Pose PacketMotion::at(std::int64_t tick) const noexcept {
  const double way = std::clamp(period_ * static_cast<double>(tick - began_) / span_, 0.0, 1.0);
  return {glm::mix(from_.place, goal_.place, way), glm::normalize(glm::slerp(from_.turn, goal_.turn, way)),
          from_.gap + way * (goal_.gap - from_.gap)};
}

void PacketMotion::move(GripperState& state, std::int64_t tick) noexcept {
  const Pose pose = at(tick);
  moved_ = tick;
  state.position = to_triple(pose.place);
  state.rotation = to_rotation(glm::mat3_cast(pose.turn));
  state.gap = pose.gap;
  state.buttons = buttons_;
}

PacketSteps::PacketSteps(double rate, double jump, double turn) noexcept : period_(1 / rate), jump_(jump), turn_(turn) {
  intervals_.fill(PacketMotion::LONGEST);
}

void PacketSteps::start(const GripperState& state, std::int64_t tick) noexcept {
  before_ = state;
  heard_ = tick;
}

bool PacketSteps::allows(const GripperState& state, std::int64_t tick) noexcept {
  const double interval = period_ * static_cast<double>(tick - heard_);
  intervals_[next_++ % intervals_.size()] = interval;
  const double mean = std::accumulate(intervals_.begin(), intervals_.end(), 0.0) / static_cast<double>(intervals_.size());
  const double seconds = std::max(interval, mean) + period_;
  const bool is_allowed = distance(state.position, before_.position) <= jump_ * seconds &&
                          std::abs(state.gap - before_.gap) <= jump_ * seconds &&
                          turned_by(state.rotation, before_.rotation) <= turn_ * seconds;
  start(state, tick);
  return is_allowed;
}

}  // namespace wholehand::device

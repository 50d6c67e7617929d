// SPDX-License-Identifier: MIT
// The page of a live view as a gripper: a user drags the hand in a browser, and feels nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>

#include "device/loop/gripper.h"
#include "device/session/newest.h"
#include "device/session/workspace.h"

namespace wholehand::device {

// The page's target for the hand, in the scene's own world, regardless of [device].
struct ViewControl {
  Triple position{};               // of the middle between the tips of thumb and index finger, m
  Rotation rotation{NO_ROTATION};  // of the gripper's axes (device/session/tick.h), to ROTATION_TOLERANCE
  double gap = 0;                  // between the tips, m
  std::uint32_t buttons = 0;
  std::int64_t sequence = 0;  // rises with each control
};

// The limits of a target, and the target before the first control.
struct ViewLimits {
  std::array<double, 2> gap{};  // closed, open, of the hand, m
  Triple center{};              // of the sphere that contains the position, m
  double reach = 0;             // its radius, m
  ViewControl start;            // open, in front of all vessels, palm towards them
};

// Passes controls from any number of threads to the haptic thread, which never waits for them.
class ViewInput {
 public:
  // Throws Error (usage) as Workspace and prepare_hand do.
  explicit ViewInput(const Scene& scene);

  const ViewLimits& limits() const noexcept { return limits_; }

  // Takes a control with finite numbers; position and gap beyond the limits are clamped. Returns false, and ignores it, if one that was sent later
  // came first. A control that is OVERTAKEN or more behind is from another clock, and counts.
  bool post(const ViewControl& control);

  // For the gripper: the newest control since the last call, if any, as the gripper's state at which the hand is there.
  bool take(GripperState& state) noexcept { return newest_.take(state); }
  const Workspace& workspace() const noexcept { return workspace_; }
  GripperState state_of(const ViewControl& control) const noexcept;

  static constexpr std::int64_t OVERTAKEN = 10000;

 private:
  ViewInput(const Scene& scene, std::array<double, 2> hand_gap);

  Workspace workspace_;
  ViewLimits limits_;
  std::mutex mutex_;  // between threads that post
  bool has_last_ = false;
  std::int64_t last_ = 0;  // its number
  Newest<GripperState> newest_;
};

// The gripper for this input, with the paper's force limits and, unless [device] gap_mm says otherwise, the hand's own gap. It rests at the start
// until the first control, and later at the last control: a pause is no fault. It moves like a critically damped spring, within the VIEW_* limits
// below and half of the speed that the guard calls a jump. Every read has a value; forces are discarded. `input` must outlive it and belong to the
// same scene.
std::unique_ptr<Gripper> open_view(const Scene& scene, ViewInput& input);

// Limits on the motion of the hand in the world; docs/devices.md.
constexpr double VIEW_RATE = 60;         // 1/s: 33 ms behind; leaves one hundredth of a mouse's steps at 60 Hz
constexpr double VIEW_SPEED = 2;         // m/s: an arm in a hurry
constexpr double VIEW_GAP_SPEED = 0.5;   // m/s: fingers that snap shut
constexpr double VIEW_TURN = 10;         // rad/s: a third of a quick wrist
constexpr double VIEW_REACH = 0.4;       // m around the vessels and the target
constexpr double VIEW_CLEARANCE = 0.15;  // m in front of them, the hand's start

}  // namespace wholehand::device

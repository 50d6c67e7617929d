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

namespace wholehand {

// What the page wants at a moment: of the hand and in the scene's own world, whatever its [device] says.
struct ViewControl {
  Triple position{};               // of the middle between the tips of thumb and index finger, m
  Rotation rotation{NO_ROTATION};  // of the gripper's axes (device/session/tick.h), to ROTATION_TOLERANCE
  double gap = 0;                  // between the tips, m
  std::uint32_t buttons = 0;
  std::int64_t sequence = 0;  // rises with each control
};

// What can be wanted, and what is before anybody does.
struct ViewLimits {
  std::array<double, 2> gap{};  // closed, open, of the hand, m
  Triple center{};              // of the sphere that the position stays in, m
  double reach = 0;             // its radius, m
  ViewControl start;            // open, in front of all vessels, the palm towards them
};

// Where controls go in, from as many threads as there are, and out on the haptic thread, which they never make wait.
class ViewInput {
 public:
  // Throws Error (usage) as Workspace and prepare_hand do.
  explicit ViewInput(const Scene& scene);

  const ViewLimits& limits() const noexcept { return limits_; }

  // A control with finite numbers; position and gap beyond the limits are moved to them. False: one that was sent later has come before
  // it, and it is left out. One that is OVERTAKEN behind and more is of another clock, and counts.
  bool post(const ViewControl& control);

  // For the gripper: the newest control, if there is one since the last, as the gripper's state at which the hand is there.
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

// The gripper behind it, with the paper's limits of force and, unless [device] gap_mm says otherwise, the hand's own gap. It rests at the
// start until the first control and at the last control after it: a pause is no fault. On the way it follows as a critically damped
// spring would, no faster than the VIEW_* below and half of what the guard calls a jump. Every read has a value; forces go nowhere. `input`
// must outlive it and be of the same scene.
std::unique_ptr<Gripper> open_view(const Scene& scene, ViewInput& input);

// Limits on the motion of the hand in the world; docs/devices.md.
constexpr double VIEW_RATE = 60;         // 1/s: 33 ms behind, and of the steps of a mouse at 60 Hz one hundredth is left
constexpr double VIEW_SPEED = 2;         // m/s: an arm in a hurry
constexpr double VIEW_GAP_SPEED = 0.5;   // m/s: fingers that snap shut
constexpr double VIEW_TURN = 10;         // rad/s: a third of a quick wrist
constexpr double VIEW_REACH = 0.4;       // m around the vessels and the target
constexpr double VIEW_CLEARANCE = 0.15;  // m in front of them, where the hand starts

}  // namespace wholehand

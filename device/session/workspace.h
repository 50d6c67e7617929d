// SPDX-License-Identifier: MIT
// Maps a gripper's own frame to the hand in the world: [device] of a scene.
#pragma once

#include "core/mirror.h"
#include "core/real.h"
#include "core/scene.h"
#include "device/session/tick.h"

namespace wholehand::device {

// Where a gripper puts the hand: `middle` between the two tips, `rotation` of the gripper's axes, the hand's gap. A left hand moves as the right hand
// of the world mirrored in x, so these are in that world (docs/method.md).
struct HandPose {
  core_f64::Vec3 middle{};
  core_f64::Mat3 rotation{1};
  double gap = 0;  // m
};

class Workspace {
 public:
  // `device_gap`: closed and open gap of the device itself, m; [device] gap_mm overrides it. `hand_gap`: g(1), g(0), m, scaled. Throws Error (usage)
  // if the device's gap is not a range.
  Workspace(const Scene& scene, std::array<double, 2> device_gap, std::array<double, 2> hand_gap);

  // Linear in place and gap, with the gap clamped. While the clutch button is pressed the hand stays still, and continues from there.
  HandPose map(const GripperState& state) noexcept;
  // The gripper's state, without clutch, buttons and numbers, at which the hand is there. The gap is clamped to the hand's.
  GripperState unmap(const HandPose& pose) const noexcept;
  bool is_clutched() const noexcept { return is_clutched_; }
  // Maps a force of that world back to the device: only the axes change.
  Triple to_device(core_f64::Vec3 force) const noexcept;
  // For GripperForce::across, from half the index finger's force less the thumb's: a left hand has its thumb at the gripper's +x.
  Triple across_to_device(core_f64::Vec3 apart) const noexcept { return to_device(side_ * apart); }
  core_f64::Vec3 to_world(const Triple& force) const noexcept;
  // Between that world and the scene's own.
  const Mirror& mirror() const noexcept { return mirror_; }

  std::array<double, 2> device_gap() const noexcept { return device_gap_; }
  double gap_slope() const noexcept { return slope_; }  // slope of the hand's gap over the device's

 private:
  core_f64::Mat3 axes_{1};  // device to world
  core_f64::Vec3 origin_{};
  double scale_ = 1;
  Mirror mirror_;
  double side_ = 1;  // -1: a left hand
  int clutch_ = -1;
  std::array<double, 2> device_gap_{}, hand_gap_{};
  double slope_ = 1;
  bool is_clutched_ = false;
  core_f64::Vec3 held_{};    // where the clutch holds the hand
  core_f64::Vec3 offset_{};  // sum of all clutching so far
};

// The factor by which a gripper feels the coupling's stiffness: at its arm, which pushes two tips by `workspace_scale` of its own way, or at a
// finger, whose tip goes `gap_slope` times as far; the greater of both.
double coupling_slope(double workspace_scale, double gap_slope);

// A minimum-jerk rise from 0 to 1 over 0 to 1; constant outside.
double minimum_jerk(double t);

}  // namespace wholehand::device

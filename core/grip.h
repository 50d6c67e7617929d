// SPDX-License-Identifier: MIT
// One grip through kernels 3, 4, 5, 8 and 11: the core's way of putting the leaf functions together. The shaders put the same leaves together
// in shaders/closure.comp, rest.comp, contact.comp and overlap.comp.
#pragma once

#include <array>
#include <cstdint>

#include "core/closure.h"
#include "core/projection.h"
#include "core/wrist.h"

namespace CORE_NS {

enum class PoseKind : int { articulated = POSE_ARTICULATED, paper = POSE_PAPER, rigged = POSE_RIGGED };

// What is asked of a grip beyond its masks and depths.
struct Wanted {
  bool joints = true;   // the rigged hand's joints
  bool proxies = true;  // proxies and bone stretch
};

struct GripAnswer {
  Closing closing;
  std::uint32_t status = 0;  // STATUS_*
  std::array<Vec3, JOINTS> joints{}, posed{}, proxies{};
  std::array<Real, JOINTS> separation{};
  std::uint32_t touch_mask = 0, tip_mask = 0, finger_mask = 0, inner_mask = 0, used_mask = 0;
  Real phalanx_depth = 0, palm_depth = 0, bone_stretch = 0;
  Real table_depth = 0;   // where the vessel is on a table
  Real self_depth = 0;    // of a hand with spheres between its joints
  Wrist wrist;            // in a scene with an arm
  int advance_steps = 0;  // of the longest stage of a finger (pose articulated)
};

// Kernels 5, 4 and, with spheres between joints or a table, 8, and with an arm 11, for a closed hand. `closing`: where the hand is, without
// a reason against it. Allocates nothing.
void rest_hand(const Hand& hand, const Vessel& vessel, PoseKind pose, const Closing& closing, Real friction, Wanted wanted,
               GripAnswer& answer);
// How deep the phalanges of two digits lie in each other, m: the largest overlap of any two bones, less than 0 where all are apart. `scale`: of
// the placed hand.
Real digits_overlap(const Hand& hand, const std::array<Vec3, JOINTS>& posed, Real scale);
// The whole. Allocates nothing. Fields as in wholehand::GripResult; where not wanted they keep their zeros. `friction` decides `antipodal`.
void evaluate_grip(const Hand& hand, const Vessel& vessel, PoseKind pose, Grip grip, Real friction, Wanted wanted,
                   GripAnswer& answer);

}  // namespace CORE_NS

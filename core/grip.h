// SPDX-License-Identifier: MIT
// One grip through kernels 3, 4, 5, 8 and 11: how the core combines the leaf functions. The shaders combine the same leaves in shaders/closure.comp,
// rest.comp, contact.comp and overlap.comp.
#pragma once

#include <array>
#include <cstdint>

#include "core/closure.h"
#include "core/projection.h"
#include "core/wrist.h"

namespace CORE_NS {

enum class PoseKind : int { articulated = POSE_ARTICULATED, paper = POSE_PAPER, rigged = POSE_RIGGED };

// What to compute for a grip besides its masks and depths.
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
  Real table_depth = 0;   // if the vessel is on a table
  Real self_depth = 0;    // of a hand with spheres between its joints
  Wrist wrist;            // in a scene with an arm
  int advance_steps = 0;  // steps of the longest stage of a finger (pose articulated)
};

// Kernels 5 and 4 for a closed hand; with spheres between joints or a table also 8, and with an arm 11. `closing`: the hand's place; its reason must
// be none. Allocates nothing.
void rest_hand(const Hand& hand, const Vessel& vessel, PoseKind pose, const Closing& closing, Real friction, Wanted wanted,
               GripAnswer& answer);
// The largest overlap of any two bones of the phalanges of two digits, m; negative if all are apart. `scale`: of the placed hand.
Real digits_overlap(const Hand& hand, const std::array<Vec3, JOINTS>& posed, Real scale);
// Computes everything. Allocates nothing. Fields as in wholehand::GripResult; unwanted ones stay zero. `friction` decides `antipodal`.
void evaluate_grip(const Hand& hand, const Vessel& vessel, PoseKind pose, Grip grip, Real friction, Wanted wanted,
                   GripAnswer& answer);

}  // namespace CORE_NS

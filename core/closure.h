// SPDX-License-Identifier: MIT
// Kernel 3: closes the two tracked fingers on the vessel and places the hand at them.
#pragma once

#include "core/hand.h"
#include "core/sdf.h"
#include "core/trig.h"

namespace CORE_NS {

// A grip as the kernels use it: m and rad; hand_scale multiplies the scene's own scale.
struct Grip {
  Real height = 0, azimuth = 0, obliquity = 0, roll = 0, offset = 0, hand_scale = 1;
};

// Maps hand-frame coordinates (scaled) to the vessel frame: x = rotation * (scale * p) + translation.
struct Placement {
  Mat3 rotation{1};
  Vec3 translation{};
  Real scale = 1;
};

// The sphere tracing of one side: the coordinate along the line; REASON_NONE, REASON_NOT_CONVERGED or REASON_MISSES; at a hit, the outward normal and
// the element touched (-1: a lattice).
struct Trace {
  Real t = 0;
  int reason = 0;
  Vec3 normal{};
  int element = -1;
  int steps = 0;  // steps taken; for evidence, the shaders do not count
};

// The result of closing. t, gap and midpoint are set from REASON_TOO_WIDE on, the rest only if the reason is REASON_NONE.
struct Closing {
  int reason = 0;
  Vec3 direction{};                        // thumb to index, unit
  Real t_index = 0, t_thumb = 0, gap = 0;  // m
  Vec3 midpoint{};
  Real closure = 0;
  Real thumb_angle = 0, index_angle = 0;  // between the outward normal and the line, rad
  bool grazing = false;
  Placement placement;
  int steps = 0;  // of the longer trace
};

// First t along `direction` from `origin`, coming from outside, at which the distance is `radius`. `heading` is +1 for the index (from +infinity) and
// -1 for the thumb.
Trace trace_tip(const Vessel& vessel, Vec3 origin, Vec3 direction, Real heading, Real radius);
// The hand at `closure`, with its tip-to-tip line along `direction`, turned by `roll`, and its tips' middle at `midpoint`. e1_x: the lateral part of
// the line in the hand frame, which must stay below LARGEST_E1_X.
Placement place_hand(const Hand& hand, Real closure, Vec3 direction, Real roll, Vec3 midpoint, Real scale, Real& e1_x);
// Transforms a finger's frame.
FingerFrame placed_frame(const Placement& placement, FingerFrame frame);
// The whole kernel.
Closing close_fingers(const Hand& hand, const Vessel& vessel, Grip grip);

}  // namespace CORE_NS

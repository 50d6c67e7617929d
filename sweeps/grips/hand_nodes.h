// SPDX-License-Identifier: MIT
// The hand of a grip as nodes of a scene graph: OpenXR's joints with its orientations (XR_EXT_hand_tracking).
#pragma once

#include <array>

#include "core/hand.h"
#include "core/joints.h"
#include "core/quaternion.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand::sweeps {

// A joint of the hand in the vessel frame. Its rotation is OpenXR's, for either hand: +z along the bone away from the tip, +y out of the back of the
// hand (for a thumb: of its nail); a tip has the rotation of the bone that it ends. A joint's bone runs to the finger's next joint, along -z.
struct HandNode {
  const char* name = "";    // WebXR's name, which matches hand rigs in glTF: "thumb-metacarpal" .. "pinky-finger-tip"
  const char* openxr = "";  // OpenXR's enumerant of the same joint: "XR_HAND_JOINT_THUMB_METACARPAL_EXT"
  int parent = -1;          // parent joint, towards the wrist; -1: the wrist
  Triple position{};        // m
  Quaternion rotation{0, 0, 0, 1};
  double radius = 0;  // of the skin around it, m
};

struct HandNodes {
  HandNode wrist;  // origin of the hand frame; radius 0
  std::array<HandNode, JOINT_COUNT> joints;
};

// Nodes of the posed hand of a feasible grip: positions are result.posed.
HandNodes hand_nodes(const HandData& hand, const GripInput& grip, const GripResult& result);
// The nodes of any hand, in the frame of `points`: the hand frame's origin lies at `wrist` and is turned by `rotation` (of a left hand, whose frame
// has the mirrored +y and +z, as in the nodes). `ready`: the same hand, loaded; `scale` multiplies its own. Allocates nothing.
HandNodes hand_nodes(const HandData& hand, const core_f64::Hand& ready, const Triple& wrist, const Rotation& rotation,
                     const std::array<Triple, JOINT_COUNT>& points, double scale = 1);

// A node's transform relative to another, as needed to write it as that node's child.
Triple relative_position(const HandNode& parent, const Triple& position);
Quaternion relative_rotation(const HandNode& parent, const Quaternion& rotation);

}  // namespace wholehand::sweeps

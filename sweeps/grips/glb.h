// SPDX-License-Identifier: MIT
// A grip as one glTF binary: the hand as OpenXR's joints, the glass, the liquid.
#pragma once

#include <string>
#include <string_view>

#include "sweeps/grips/report.h"

namespace wholehand::sweeps {

// The number of flat faces around the glass and other round surfaces.
constexpr int GLB_SEGMENTS = 64;

// A ball's radius as a share of the joint's: large enough to show above the bones, whose flat faces lie up to 1.2 % inside the round surface.
constexpr double GLB_BALL_SHARE = 1.03;

// Identifies files drawn by this program.
inline constexpr std::string_view GRIP_GLB_MARK = "\"generator\":\"wholehand";

// The bytes of a .glb (glTF 2.0: m, +y up). Nodes, each the child of the one before it where it is indented:
//   pivot      at the middle between the tips; its rotation is animated over the report's tilts where there are two or more
//     grip     the vessel frame; its `extras` are grip_json's object
//       vessel, liquid   meshes; the liquid of the first of the report's states that has any, its level surface in the upright vessel
//       wrist  and the 24 joints of the posed hand by hand_nodes' names, nested along each finger, each with its bone, the rounded
//              cone through the radii of both joints; its child `<joint> contact` is a ball a little larger than the joint, colored by
//              its state, which is in `extras`
// While the animation runs the liquid is shown at its own tilt and hidden at others. Radii below 1.5 mm are drawn as 1.5 mm.
// Throws Error: (usage) where the grip is not feasible, (failure) where the vessel's mesh has not been read.
std::string grip_glb(const Scene& scene, std::size_t vessel, const GripReport& report, int segments = GLB_SEGMENTS);

}  // namespace wholehand::sweeps

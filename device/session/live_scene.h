// SPDX-License-Identifier: MIT
// A scene prepared for a live session: everything that no tick changes.
#pragma once

#include <vector>

#include "core/force.h"
#include "core/hand.h"
#include "core/liquid.h"
#include "core/scene.h"
#include "core/sdf.h"

namespace wholehand {

// A vessel prepared for a session, in the world of the right hand.
struct LiveVessel {
  core_f64::Vessel vessel;
  core_f64::ForceScale force;
  core_f64::Load largest;                // upright at the scene's largest fill, or its own if larger
  std::vector<core_f64::Vec3> guidance;  // on its outer surface, vessel frame
  core_f64::Vec3 home{};                 // its place at the start
  double radius = 0;                     // at its widest, m
  double volume = 0;                     // at the start, m3
};

// All constant data of a session. Throws Error (usage): no vessel or more than LIVE_VESSELS, a hand or a vessel that is physically impossible,
// vessels that overlap.
struct LiveScene {
  explicit LiveScene(const Scene& scene);
  Scene scene;
  core_f64::Hand hand;
  core_f64::Quadrature quadrature;
  std::vector<LiveVessel> vessels;
  int tutorial = -1;  // the vessel to carry to the destination: the first without liquid, if there is a task; -1: none
};

}  // namespace wholehand

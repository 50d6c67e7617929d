// SPDX-License-Identifier: MIT
// A scene prepared for a live session: everything that no tick changes.
#pragma once

#include <vector>

#include "core/force.h"
#include "core/hand.h"
#include "core/liquid.h"
#include "core/mirror.h"
#include "core/scene.h"
#include "core/sdf.h"
#include "device/session/vessel_tracker.h"

namespace wholehand::device {

// A vessel's pose in the world of the right hand, as kernels take it.
struct Stance {
  core_f64::Vec3 place{};
  core_f64::Mat3 rotation{1};
  core_f64::Vec3 inward(core_f64::Vec3 p) const { return glm::transpose(rotation) * (p - place); }
  core_f64::Vec3 outward(core_f64::Vec3 p) const { return place + rotation * p; }
};

// A vessel prepared for a session, in the world of the right hand.
struct LiveVessel {
  core_f64::Vessel vessel;
  core_f64::ForceScale force;
  core_f64::Load largest;                // upright at the scene's largest fill, or its own if larger
  std::vector<core_f64::Vec3> guidance;  // on its outer surface, vessel frame
  core_f64::Vec3 home{};                 // its place at the start
  double radius = 0;                     // at its widest, m
  double volume = 0;                     // at the start, m3
  core_f64::Mat3 inertia{0};             // of the wall about its center, kg m2
};

// All constant data of a session. Throws Error (usage): no vessel or more than LIVE_VESSELS, a hand or a vessel that is physically impossible,
// vessels that overlap.
struct LiveScene {
  explicit LiveScene(const Scene& scene);
  Stance stance(const VesselPose& pose) const { return {mirror.in(pose.place), mirror.in(pose.rotation)}; }
  Scene scene;
  Mirror mirror;  // to the world of its right hand
  core_f64::Hand hand;
  core_f64::Quadrature quadrature;
  std::vector<LiveVessel> vessels;
  int tutorial = -1;  // the vessel to carry to the destination: the first without liquid, if there is a task; -1: none
};

}  // namespace wholehand::device

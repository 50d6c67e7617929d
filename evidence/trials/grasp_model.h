// SPDX-License-Identifier: MIT
// The hand as a physics engine takes it: what it is made of, and which torques stand for which forces. All in the frame of the
// vessel as it is gripped; a left hand is made ready mirrored.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/effort.h"
#include "core/evaluator.h"
#include "core/prepared.h"
#include "core/result.h"
#include "core/scene.h"
#include "evidence/trials/trial.h"

namespace wholehand {

// For each joint, times the square of its distance from the tip along the bones. Three joints in a row give a tip a third of each:
// 500 N/m, 8 N s/m, 17 g, within what people have (200 to 800 N/m, 1 to 8 N s/m, 4 to 20 g; Hajian & Howe 1997). A slide is a tip
// by itself and has a third. A lighter or less damped finger that leaves the vessel for a step strikes it in the next one.
constexpr double JOINT_STIFFNESS = 1500, JOINT_DAMPING = 24, JOINT_INERTIA = 50e-3;  // N/m, N s/m, kg
constexpr double FLESH = 1100;                                                       // kg/m3
constexpr double THINNEST = 0.5e-3;                                                  // m: a bare point is a body too

// Where contacts press, and what they can do; in the frame of the model.
struct GraspContacts {
  std::vector<core_f64::ContactPoint> points;
  std::vector<int> joints, between;  // as of GripContact
  core_f64::HandStrength strength;
};

// A hinge, or a slide of the model `contacts`, that turns or moves at a torque or a force.
struct GraspJoint {
  int digit = 0;
  double stiffness = 0;  // N m/rad or N/m
  double most = 0;       // the largest torque (N m), of either sign, or force (N), never a pull
  bool is_slide = false;
  double reach = 1;  // m: of the farthest point that a hinge moves; 1 of a slide
};

// A body of the hand that touches: its geoms have its name.
struct GraspModel {
  std::string bodies;              // XML, for <worldbody>
  std::vector<std::string> geoms;  // names of what touches the vessel
  std::vector<GraspJoint> joints;  // in the order of the engine's, after the vessel's
  std::vector<std::string> bones;  // names of the bodies of TrialFrame::joints; empty where these stay as posed
  double roughness = 0;            // m: of the capsules from the bones that they stand for

  // Torques or forces of the joints with which the contacts press so.
  std::vector<double> drives(std::span<const core_f64::ContactForce> forces) const;

  // What `drives` is made of: entry [joint * contacts + contact] takes a force and a torsion to a torque.
  struct Lever {
    core_f64::Vec3 force{};  // N to N m or N
    double torsion = 0;
  };
  std::vector<Lever> levers;
  std::size_t contacts = 0;
};

// An articulated hand of capsules. `hand` is the scene's, `posed` and `rigged` the joints of the grip's hand.
GraspModel articulated_hand(const PreparedHand& hand, const HandData& data, const PosedHand& rigged, const PosedHand& posed,
                            double scale, const GraspContacts& contacts);

// Each contact a sphere of its joint's size on a slide along its normal.
GraspModel sliding_contacts(std::span<const double> radii, const GraspContacts& contacts);

// The joints of a posed hand as an articulated one has moved them. `place` and `rotation` (rows): where a body is.
struct BonePlace {
  Triple place{};
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
};
// `bones` as those of the model; of the hand as it was posed.
PosedHand moved_joints(const PosedHand& posed, std::span<const BonePlace> bones);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The hand as a model for a physics engine: its parts, and the torques that stand for forces. Everything is in the frame of the vessel as it is
// gripped; a left hand is prepared mirrored.
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

// For each joint, multiplied by the square of its distance from the tip along the bones. Three joints in a row give a tip a third of each: 500 N/m, 8
// N s/m, 17 g, within the human range (200 to 800 N/m, 1 to 8 N s/m, 4 to 20 g; Hajian & Howe 1997). A slide is a tip by itself and has a third. A
// lighter or less damped finger that leaves the vessel for one step strikes it in the next.
constexpr double JOINT_STIFFNESS = 1500, JOINT_DAMPING = 24, JOINT_INERTIA = 50e-3;  // N/m, N s/m, kg
constexpr double FLESH = 1100;                                                       // kg/m3
constexpr double THINNEST = 0.5e-3;                                                  // m: a bare point also needs a size

// Where contacts press, and what they can do; in the model's frame.
struct GraspContacts {
  std::vector<core_f64::ContactPoint> points;
  std::vector<int> joints, between;  // as of GripContact
  core_f64::HandStrength strength;
};

// A hinge, or a slide of the model `contacts`, driven by a torque or a force.
struct GraspJoint {
  int digit = 0;
  double stiffness = 0;  // N m/rad or N/m
  double most = 0;       // the largest torque (N m), of either sign, or force (N), never a pull
  bool is_slide = false;
  double reach = 1;  // m, to the farthest point that a hinge moves; 1 for a slide
};

// A body of the hand that touches: its geoms have its name.
struct GraspModel {
  std::string bodies;              // XML, for <worldbody>
  std::vector<std::string> geoms;  // names of what touches the vessel
  std::vector<GraspJoint> joints;  // in the engine's order, after the vessel's
  std::vector<std::string> bones;  // names of the bodies of TrialFrame::joints; empty if these stay as posed
  double roughness = 0;            // m: from the capsules to the bones that they stand for

  // Torques or forces of the joints that produce these contact forces.
  std::vector<double> drives(std::span<const core_f64::ContactForce> forces) const;

  // The matrix of `drives`: entry [joint * contacts + contact] maps a force and a torsion to a torque.
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

// Each contact becomes a sphere of its joint's size on a slide along its normal.
GraspModel sliding_contacts(std::span<const double> radii, const GraspContacts& contacts);

// The joints of a posed hand as an articulated one has moved them. `place` and `rotation` (rows): pose of a body.
struct BonePlace {
  Triple place{};
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
};
// `bones` as those of the model; for the hand as it was posed.
PosedHand moved_joints(const PosedHand& posed, std::span<const BonePlace> bones);

}  // namespace wholehand

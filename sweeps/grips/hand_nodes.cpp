// SPDX-License-Identifier: MIT
#include "sweeps/grips/hand_nodes.h"

#include <cmath>

#include "core/closure.h"
#include "core/joints.h"
#include "core/load.h"
#include "core/mirror.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "shaders/layout.h"

namespace wholehand::sweeps {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

constexpr double NO_BONE = 1e-9;  // m: shorter ones have no direction

// The joint's frame from the direction towards its finger's base and the axis about which the finger bends. If a bone lies along that axis (a point
// that moved on its own, pose paper), the back of the hand replaces the axis.
Mat3 joint_rotation(Vec3 backward, Vec3 bend_axis, Vec3 back) {
  Vec3 x = bend_axis - glm::dot(bend_axis, backward) * backward;
  if (glm::length(x) < 1e-6) x = glm::cross(back, backward);
  x = glm::normalize(x);
  return Mat3(x, glm::cross(backward, x), backward);
}

// Where the kernel placed the hand, recovered from the result. All in the scene of the right hand.
core_f64::Placement find_placement(const HandData& hand, const core_f64::Hand& ready, const GripInput& grip,
                                   const GripResult& result) {
  const Vec3 thumb = to_vec3(mirrored(result.posed[THUMB_TIP], hand.handedness));
  const Vec3 index = to_vec3(mirrored(result.posed[INDEX_TIP], hand.handedness));
  double e1_x = 0;
  return core_f64::place_hand(ready, result.closure, glm::normalize(index - thumb), grip.roll, 0.5 * (thumb + index),
                              hand.scale * grip.hand_scale, e1_x);
}

}  // namespace

HandNodes hand_nodes(const HandData& hand, const GripInput& grip, const GripResult& result) {
  const core_f64::Hand ready = core_f64::load_hand(prepare_hand(hand), hand);
  const core_f64::Placement placement = find_placement(hand, ready, grip, result);
  // its +y and +z are the mirrored ones; +x follows
  const Mat3 rotation = mirrored(placement.rotation, hand.handedness);
  return hand_nodes(hand, ready, mirrored(to_triple(placement.translation), hand.handedness), to_rotation(rotation), result.posed,
                    grip.hand_scale);
}

HandNodes hand_nodes(const HandData& hand, const core_f64::Hand& ready, const Triple& wrist, const Rotation& rotation,
                     const std::array<Triple, JOINT_COUNT>& points, double scale) {
  const core_f64::Placement placement{mirrored(to_mat3(rotation), hand.handedness), to_vec3(mirrored(wrist, hand.handedness)),
                                      hand.scale * scale};
  HandNodes nodes;
  nodes.wrist.name = "wrist";
  nodes.wrist.openxr = "XR_HAND_JOINT_WRIST_EXT";
  nodes.wrist.position = wrist;
  nodes.wrist.rotation = quaternion_of(to_mat3(rotation));
  for (int f = 0; f < FINGER_COUNT; ++f) {
    const core_f64::FingerFrame frame = core_f64::placed_frame(placement, ready.frame[f]);
    // the thumb's chain leaves the palm and bends back towards it (core/hand.cpp): its pad is on the other side
    const Vec3 back = f == 0 ? frame.palmward : -frame.palmward;
    const Vec3 bend_axis = glm::cross(frame.forward, back);
    Vec3 backward = -frame.forward;
    for (int k = 0; k < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      const bool is_tip = k + 1 == finger_joints(f);
      if (!is_tip) {
        const Vec3 bone = to_vec3(mirrored(points[j], hand.handedness)) - to_vec3(mirrored(points[j + 1], hand.handedness));
        if (glm::length(bone) > NO_BONE) backward = glm::normalize(bone);
      }
      HandNode& node = nodes.joints[j];
      node.name = JOINT_NAMES[j].webxr;
      node.openxr = JOINT_NAMES[j].openxr;
      node.parent = k == 0 ? -1 : j - 1;
      node.position = points[j];
      node.rotation = quaternion_of(mirrored(joint_rotation(backward, bend_axis, back), hand.handedness));
      node.radius = hand.scale * scale * hand.fingers[f].radii[k];
    }
  }
  return nodes;
}

Triple relative_position(const HandNode& parent, const Triple& position) {
  return to_triple(glm::conjugate(to_quat(parent.rotation)) * (to_vec3(position) - to_vec3(parent.position)));
}

Quaternion relative_rotation(const HandNode& parent, const Quaternion& rotation) {
  return to_quaternion(glm::normalize(glm::conjugate(to_quat(parent.rotation)) * to_quat(rotation)));
}

}  // namespace wholehand::sweeps

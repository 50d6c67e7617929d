// SPDX-License-Identifier: MIT
#include "core/contacts.h"

#include "core/body.h"
#include "core/contact.h"
#include "core/joints.h"

namespace CORE_NS {

using wholehand::finger_of;
using wholehand::finger_start;

int find_contacts(const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, std::uint32_t touch_mask,
                  std::array<PressingJoint, JOINTS>& pressing) {
  int count = 0;
  for (int joint = 0; joint < JOINTS; ++joint) {
    if ((touch_mask >> joint & 1) == 0) continue;
    ContactPoint contact;
    if (!presses_at(vessel, posed[joint], contact.place, contact.normal)) continue;
    const int finger = finger_of(joint);
    PressingJoint& found = pressing[count++];
    found.joint = joint;
    found.contact = contact;
    found.contact.digit = joint == finger_start(finger) ? PALM : finger;
    found.contact.is_tip = joint == THUMB_TIP || joint == INDEX_TIP;
  }
  return count;
}

int find_contacts(const Hand& hand, const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, Real scale,
                  std::uint32_t touch_mask, std::array<PressingJoint, JOINTS>& pressing) {
  int count = find_contacts(vessel, posed, touch_mask, pressing);
  for (int f = 0; hand.between > 0 && f < FINGERS; ++f) {
    const int start = finger_start(f);
    int palm_room = 1 - static_cast<int>(touch_mask >> start & 1), room = 0;
    for (int k = 1; k < wholehand::finger_joints(f); ++k) room += 1 - static_cast<int>(touch_mask >> (start + k) & 1);
    for (int bone = 0; bone + 1 < wholehand::finger_joints(f); ++bone) {
      int& left = bone == 0 ? palm_room : room;
      for (int k = 1; k <= hand.between && left > 0; ++k) {
        const Ball ball = ball_between(posed[start + bone], posed[start + bone + 1], scale * hand.radius[f][bone],
                                       scale * hand.radius[f][bone + 1], Real(k) / Real(hand.between + 1));
        if (!(separation_at(vessel, ball.place, ball.radius) <= hand.contact_tolerance)) continue;
        ContactPoint contact;
        if (!presses_at(vessel, ball.place, contact.place, contact.normal)) continue;
        contact.digit = bone == 0 ? PALM : f;
        pressing[count++] = {start + bone + 1, k, contact};
        --left;
      }
    }
  }
  return count;
}

Real placed_scale(const Hand& hand, const std::array<Vec3, JOINTS>& posed) {
  return glm::length(posed[1] - posed[0]) / hand.length[0][0];
}

}  // namespace CORE_NS

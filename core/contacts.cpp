// SPDX-License-Identifier: MIT
#include "core/contacts.h"

#include "core/body.h"
#include "core/contact.h"
#include "core/joints.h"

namespace CORE_NS {

using wholehand::finger_of;
using wholehand::finger_start;

namespace {

// Where a touching point presses: the nearest point of the surface and the inward unit normal there, q = x - sdf(x) grad sdf(x) and n = -grad sdf(x),
// because an exact distance has the same gradient at x and at its nearest point. False: on the lid that closes the mouth of a solid vessel, where
// there is nothing.
bool presses_at(const Vessel& vessel, Vec3 p, Vec3& place, Vec3& normal) {
  int element = -1;
  const Vec3 outward = distance_gradient(vessel, p, element);
  place = p - signed_distance(vessel, p) * outward;
  normal = -outward;
  return vessel.lid < 0 || element != vessel.lid;
}

}  // namespace

Contact contact_at(const Vessel& vessel, Vec3 p, Real radius) {
  Contact contact;
  contact.separation = separation_at(vessel, p, radius);
  contact.proxy = p;
  if (contact.separation < 0) contact.proxy = proxy_of(vessel, p, radius, contact.settled);
  return contact;
}

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

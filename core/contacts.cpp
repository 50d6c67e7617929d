// SPDX-License-Identifier: MIT
#include "core/contacts.h"

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
  }
  return count;
}

}  // namespace CORE_NS

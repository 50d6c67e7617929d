// SPDX-License-Identifier: MIT
#include "core/contacts.h"

#include "core/joints.h"

namespace CORE_NS {

using wholehand::finger_of;
using wholehand::finger_start;

// q = x - sdf(x) grad sdf(x); n = -grad sdf(x): with an exact distance its gradient at the nearest point is that at x.
int find_contacts(const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, std::uint32_t touch_mask,
                  std::array<PressingJoint, JOINTS>& pressing) {
  int count = 0;
  for (int joint = 0; joint < JOINTS; ++joint) {
    if ((touch_mask >> joint & 1) == 0) continue;
    int element = -1;
    const Vec3 outward = distance_gradient(vessel, posed[joint], element);
    if (vessel.lid >= 0 && element == vessel.lid) continue;
    const int finger = finger_of(joint);
    PressingJoint& found = pressing[count++];
    found.joint = joint;
    found.contact.place = posed[joint] - signed_distance(vessel, posed[joint]) * outward;
    found.contact.normal = -outward;
    found.contact.digit = joint == finger_start(finger) ? PALM : finger;
  }
  return count;
}

}  // namespace CORE_NS

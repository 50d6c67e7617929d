// SPDX-License-Identifier: MIT
// Kernel 9: where the posed hand presses on the vessel.
#pragma once

#include <array>
#include <cstdint>

#include "core/effort.h"
#include "core/hand.h"
#include "core/sdf.h"

namespace CORE_NS {

// A point's contact: separation sdf - radius (m), and its proxy.
struct Contact {
  Real separation = 0;
  Vec3 proxy{};         // the point itself where it does not penetrate
  bool settled = true;  // false: the proxy took all its steps
};

// A joint that presses, or a sphere of the bone that ends at it, and where and how.
struct PressingJoint {
  int joint = 0;
  int between = 0;  // number of the sphere on the bone, from 1; 0: the joint itself
  ContactPoint contact;
};

// The contact of a point of `radius` m at p.
Contact contact_at(const Vessel& vessel, Vec3 p, Real radius);
// The joints of `touch_mask` (kernel 4: thumb and index tips always, the others within the contact tolerance) in their order: each at the
// surface's nearest point, along the inward normal there. A metacarpal base belongs to the palm. A joint on the lid that closes the mouth of a
// solid vessel presses on nothing. Returns how many there are.
int find_contacts(const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, std::uint32_t touch_mask,
                  std::array<PressingJoint, JOINTS>& pressing);
// The same, and after them the touching spheres between the joints. A digit presses with as many spheres of its phalanges as it has joints
// that do not touch, from the palm outwards; a metacarpal bone with one, where its base does not touch, as a part of the palm. So no hand
// has more contacts than joints, and what is left out can only make an effort larger. `scale`: of the placed hand.
int find_contacts(const Hand& hand, const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, Real scale,
                  std::uint32_t touch_mask, std::array<PressingJoint, JOINTS>& pressing);
// The scale at which a hand is placed, from where it is: no pose moves a metacarpal bone.
Real placed_scale(const Hand& hand, const std::array<Vec3, JOINTS>& posed);

}  // namespace CORE_NS

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
  Vec3 proxy{};         // the point itself if it does not penetrate
  bool settled = true;  // false: the proxy used up its steps
};

// A pressing joint, or a pressing sphere of the bone that ends at it, with the place and direction.
struct PressingJoint {
  int joint = 0;
  int between = 0;  // number of the sphere on the bone, from 1; 0: the joint itself
  ContactPoint contact;
};

// The contact of a point of `radius` m at p.
Contact contact_at(const Vessel& vessel, Vec3 p, Real radius);
// The contacts of `touch_mask`'s joints (kernel 4: thumb and index tips always, the others within the contact tolerance), in order: each at the
// nearest point of the surface, along the inward normal there. A metacarpal base belongs to the palm. A joint on the lid that closes the mouth of a
// solid vessel makes no contact. Returns the number of contacts.
int find_contacts(const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, std::uint32_t touch_mask,
                  std::array<PressingJoint, JOINTS>& pressing);
// The same, followed by the touching spheres between joints. A digit gets at most as many sphere contacts as its phalanges have joints that do not
// touch, from the palm outward. A metacarpal bone gets one, as part of the palm, if its base does not touch. So no hand has more contacts than
// joints, and omissions can only make an effort larger. `scale`: of the placed hand.
int find_contacts(const Hand& hand, const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, Real scale,
                  std::uint32_t touch_mask, std::array<PressingJoint, JOINTS>& pressing);
// The scale of a placed hand, recovered from its joints: no pose moves a metacarpal bone.
Real placed_scale(const Hand& hand, const std::array<Vec3, JOINTS>& posed);

}  // namespace CORE_NS

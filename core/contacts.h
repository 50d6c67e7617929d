// SPDX-License-Identifier: MIT
// Kernel 9: where the posed hand presses on the vessel.
#pragma once

#include <array>
#include <cstdint>

#include "core/effort.h"
#include "core/sdf.h"

namespace CORE_NS {

// A joint that presses, and where and how.
struct PressingJoint {
  int joint = 0;
  ContactPoint contact;
};

// The joints of `touch_mask` (kernel 4: thumb and index tips always, the others within the contact tolerance) in their order: each at the
// surface's nearest point, along the inward normal there. A metacarpal base belongs to the palm. A joint on the lid that closes the mouth of a
// solid vessel presses on nothing. Returns how many there are.
int find_contacts(const Vessel& vessel, const std::array<Vec3, JOINTS>& posed, std::uint32_t touch_mask,
                  std::array<PressingJoint, JOINTS>& pressing);

}  // namespace CORE_NS

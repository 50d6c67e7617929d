// SPDX-License-Identifier: MIT
// Where two tips on a line touch a vessel that has moved a little between them.
#pragma once

#include <array>
#include <optional>

#include "core/sdf.h"

namespace wholehand::device {

// Centers of thumb and index tip that rest on the vessel, and whether both normals lie within the friction cone about the line. Vessel frame, m.
struct LineContacts {
  std::array<core_f64::Vec3, 2> places{};
  bool is_antipodal = false;
};

// Contacts on the line through `point` along `direction` (unit, from the thumb to the index finger). `near`: where they were along the line, m from
// `point`. Nothing where a contact is lost: the line passes the vessel, meets it at a grazing angle, or meets its lid.
std::optional<LineContacts> line_contacts(const core_f64::Vessel& vessel, core_f64::Vec3 point, core_f64::Vec3 direction,
                                          const std::array<double, 2>& near, const std::array<double, 2>& radii,
                                          double friction) noexcept;

}  // namespace wholehand::device

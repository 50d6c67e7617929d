// SPDX-License-Identifier: MIT
#include "core/absent.h"

#include <cmath>
#include <limits>
#include <vector>

#include "core/counted_tilts.h"
#include "core/fields.h"

namespace wholehand {

Misplaced misplaced_values(const Scene& scene, std::size_t vessel, const FieldSet& fields, std::size_t count, std::size_t stride,
                           const double* reals, const std::uint32_t* uints, bool overflows) {
  Misplaced found;
  const bool unheld = !(scene.force.friction > 0 && scene.force.torsion > 0);
  const std::vector<std::size_t> counted = counted_tilts(scene, vessel);
  const std::uint32_t* status = uints + fields.plane[FIELD_STATUS] * stride;
  for (int field = 0; field < REAL_FIELDS; ++field) {
    const Field& row = field_row(field);
    if (!fields.has(field) || fields.plane[field] >= fields.real_kept) continue;
    const int planes = field_planes(field, scene_fills(scene), scene.tilts.size());
    const bool is_hold = field == FIELD_HOLD_FORCE || field == FIELD_LARGEST_HOLD;
    const bool of_effort = row.of_strength || ((is_hold || field == FIELD_SAFE_TILT) && has_effort(scene));
    for (int p = 0; p < planes; ++p) {
      const bool is_left_out = row.shape == FieldShape::states && p % scene.tilts.size() >= counted[p / scene.tilts.size()];
      const double* plane = reals + (fields.plane[field] + p) * stride;
      for (std::size_t i = 0; i < count; ++i) {
        const double value = plane[i];
        const std::uint32_t reason = status[i] & STATUS_REASON_MASK;
        bool fits = std::isfinite(value);
        if (row.absent == FieldAbsent::never) {
          fits = fits && (reason == REASON_NONE || value == 0);
        } else if (of_effort && !(status[i] & STATUS_PLAUSIBLE)) {
          fits = std::isnan(value);
        } else if (is_left_out ||
                   (reason != REASON_NONE && !(row.absent == FieldAbsent::not_closed && reason >= REASON_TOO_WIDE))) {
          fits = std::isnan(value);
        } else if (row.range == FieldRange::may_be_missing) {
          fits = fits || std::isnan(value);
        } else if (row.range == FieldRange::may_be_infinite) {
          const bool may = of_effort || unheld || overflows || (status[i] & STATUS_ANTIPODAL) == 0;
          fits = fits || (may && value == std::numeric_limits<double>::infinity());
        }
        if (fits) continue;
        if (found.count++ == 0) found = {1, field, p, i, value};
      }
    }
  }
  return found;
}

std::string describe(const Misplaced& misplaced) {
  if (misplaced.count == 0) return "";
  return "field " + std::to_string(misplaced.field) + ", plane " + std::to_string(misplaced.plane) + " of grip " +
         std::to_string(misplaced.grip) + " is " + std::to_string(misplaced.value) + " (" + std::to_string(misplaced.count) +
         " such values)";
}

}  // namespace wholehand

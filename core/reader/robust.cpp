// SPDX-License-Identifier: MIT
// [robust]: how far a person grips from where the plan says.
#include <algorithm>
#include <array>

#include "core/reader/parts.h"

namespace wholehand {

namespace {

constexpr std::array SPREADS{"height_mm", "azimuth_deg", "obliquity_deg", "roll_deg", "offset_mm", "friction", "hand_scale"};

// The scatter of a person who aims at a grip that is shown; docs/people.md has the reasons.
RobustData aimed_grasp() {
  RobustData data;
  data.height = data.offset = 3e-3;
  data.obliquity = data.roll = radians(5);
  return data;
}

}  // namespace

void read_robust(const SceneTable& root, std::optional<RobustData>& robust) {
  const auto table = root.table(
      "robust", {"height_mm", "azimuth_deg", "obliquity_deg", "roll_deg", "offset_mm", "friction", "hand_scale", "count", "seed"});
  if (!table) return;
  const bool names_spread = std::any_of(SPREADS.begin(), SPREADS.end(), [&](const char* key) { return table->has(key); });
  RobustData& data = robust.emplace(names_spread ? RobustData{} : aimed_grasp());
  table->read("height_mm", ranges::LENGTH_DEVIATION, data.height);
  table->read("azimuth_deg", ranges::ANGLE_DEVIATION, data.azimuth);
  table->read("obliquity_deg", ranges::ANGLE_DEVIATION, data.obliquity);
  table->read("roll_deg", ranges::ANGLE_DEVIATION, data.roll);
  table->read("offset_mm", ranges::LENGTH_DEVIATION, data.offset);
  table->read("friction", ranges::FRICTION_DEVIATION, data.friction);
  table->read("hand_scale", ranges::SCALE_DEVIATION, data.hand_scale);
  std::int64_t count = data.count, seed = static_cast<std::int64_t>(data.seed);
  table->read("count", ranges::DEVIATION_COUNT, count);
  table->read("seed", ranges::SEED, seed);
  data.count = static_cast<int>(count);
  data.seed = static_cast<std::uint64_t>(seed);
  const bool has_spread = data.height > 0 || data.azimuth > 0 || data.obliquity > 0 || data.roll > 0 || data.offset > 0 ||
                          data.friction > 0 || data.hand_scale > 0;
  if (!has_spread) {
    root.file().refuse(table->place(), "[robust] has no standard deviation",
                       "allowed: at least one of height_mm, azimuth_deg, obliquity_deg, roll_deg, offset_mm, friction and "
                       "hand_scale, above 0");
  }
}

}  // namespace wholehand

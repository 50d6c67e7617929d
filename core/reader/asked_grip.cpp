// SPDX-License-Identifier: MIT
#include "core/reader/asked_grip.h"

#include <algorithm>

#include "core/reader/ranges.h"

namespace wholehand {

const std::array<const char*, GRIP_NUMBERS> GRIP_NUMBER_NAMES{"height", "azimuth", "obliquity", "roll", "offset", "hand_scale"};
const std::array<const char*, GRIP_NUMBERS> GRIP_NUMBER_UNITS{"m", "rad", "rad", "rad", "m", "1"};

AskedGrips::AskedGrips(const Scene& scene) {
  const std::array<Quantity, GRIP_NUMBERS> quantities{ranges::GRIP_HEIGHT, ranges::ROTATION, ranges::OBLIQUITY,
                                                      ranges::ROTATION,    ranges::OFFSET,   ranges::SCALE};
  for (std::size_t k = 0; k < GRIP_NUMBERS; ++k) {
    low[k] = to_si(quantities[k].low, quantities[k].unit);
    high[k] = to_si(quantities[k].high, quantities[k].unit);
  }
  const bool has_mesh =
      std::any_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& v) { return v.mesh.has_value(); });
  if (!has_mesh) return;
  const std::vector<double>& scales = scene.grips.hand_scale.values;
  high.back() = *std::max_element(scales.begin(), scales.end());
}

std::optional<std::size_t> grip_fault(const AskedGrips& allowed, const GripInput& grip) noexcept {
  const auto numbers = grip_numbers(grip);
  for (std::size_t k = 0; k < GRIP_NUMBERS; ++k)
    if (!(numbers[k] >= allowed.low[k] && numbers[k] <= allowed.high[k])) return k;
  return std::nullopt;
}

}  // namespace wholehand

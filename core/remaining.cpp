// SPDX-License-Identifier: MIT
#include "core/remaining.h"

#include <algorithm>
#include <cmath>

#include "core/scene.h"

namespace CORE_NS {

Real remaining_volume(const Vessel& vessel, const Quadrature& quadrature, Real filled, double tilt, Real sine_tilt,
                      Real cosine_tilt) {
  Real volume = std::min(filled, lip_capacity(vessel, quadrature, sine_tilt, cosine_tilt));
  const int before = std::clamp(static_cast<int>(std::floor(wholehand::degrees(tilt) * (1 + 1e-15))), 0, WHOLE_DEGREES - 1);
  for (int degree = 0; degree <= before; ++degree) volume = std::min(volume, vessel.lip_capacity[degree]);
  return volume;
}

}  // namespace CORE_NS

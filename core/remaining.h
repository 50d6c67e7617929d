// SPDX-License-Identifier: MIT
// How much of a fill remains in a tilted vessel: the least that its lip held back on the way.
#pragma once

#include "core/liquid.h"

namespace CORE_NS {

// What remains of `filled` m3 at a tilt (rad, 0..pi, with its sine and cosine), m3. What poured at any smaller whole degree is gone. The vessel has a
// cavity and was loaded with liquid.
Real remaining_volume(const Vessel& vessel, const Quadrature& quadrature, Real filled, double tilt, Real sine_tilt,
                      Real cosine_tilt);

}  // namespace CORE_NS

// SPDX-License-Identifier: MIT
#include "core/fills.h"

#include <cstddef>

#include "core/planes.h"

namespace wholehand {

bool have_like_fills(const Scene& a, const Scene& b) {
  if (a.liquid.has_value() != b.liquid.has_value() || a.vessels.size() != b.vessels.size()) return false;
  for (std::size_t v = 0; a.liquid && v < a.vessels.size(); ++v)
    if (vessel_fills(a, a.vessels[v]).size() != vessel_fills(b, b.vessels[v]).size()) return false;
  return true;
}

void take_fills(Scene& scene, const Scene& from) {
  if (!scene.liquid) return;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) scene.vessels[v].fills = vessel_fills(from, from.vessels[v]);
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/counted_tilts.h"

#include "core/load.h"
#include "core/planes.h"
#include "core/prepare.h"
#include "core/remaining.h"
#include "core/trig.h"

namespace wholehand {
namespace {

// `filled`: m3, more than 0.
std::size_t tilts_until_poured(const Scene& scene, const core_f64::Vessel& vessel, const core_f64::Quadrature& rule,
                               double filled) {
  std::size_t count = 0;
  for (const double tilt : scene.tilts) {
    ++count;
    const double left = core_f64::remaining_volume(vessel, rule, filled, tilt, core_f64::sine(tilt), core_f64::cosine(tilt));
    if (filled - left >= *scene.until_poured * filled) break;
  }
  return count;
}

}  // namespace

std::vector<std::size_t> counted_tilts(const Scene& scene, std::size_t vessel, const std::vector<double>& fills) {
  std::vector<std::size_t> counts(fills.size(), scene.tilts.size());
  const VesselData& data = scene.vessels[vessel];
  if (!scene.until_poured || !scene.liquid || !data.has_cavity()) return counts;
  const core_f64::Quadrature rule = core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS));
  const core_f64::Vessel loaded = core_f64::load_vessel(prepare_vessel(data, true), data, rule, true, scene.hand.handedness);
  for (std::size_t f = 0; f < fills.size(); ++f) {
    const double filled = fills[f] * loaded.capacity;
    if (filled > 0) counts[f] = tilts_until_poured(scene, loaded, rule, filled);
  }
  return counts;
}

std::vector<std::size_t> counted_tilts(const Scene& scene, std::size_t vessel) {
  return counted_tilts(scene, vessel, scene.liquid ? vessel_fills(scene, scene.vessels[vessel]) : std::vector<double>{0});
}

std::vector<double> last_tilts(const Scene& scene, std::size_t vessel) {
  std::vector<double> last;
  if (scene.tilts.empty()) return last;
  for (const std::size_t count : counted_tilts(scene, vessel)) last.push_back(scene.tilts[count - 1]);
  return last;
}

}  // namespace wholehand

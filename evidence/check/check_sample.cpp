// SPDX-License-Identifier: MIT
#include "evidence/check/check_sample.h"

#include <algorithm>
#include <limits>

#include "core/domain.h"

namespace wholehand {
namespace {

// Grips spread evenly over the plan; a step that shares no factor with the axes' lengths, so that every axis varies.
std::uint64_t own_index(const sweeps::Plan& plan, std::size_t i) {
  const std::uint64_t all = plan.grips();
  return all <= MOST_CHECKED_GRIPS ? i : (i * 2654435761u + 12345u) % all;
}

// The range from the axis' smallest value to its largest; about a single one by `reach` to either side, within low..high.
Axis range_around(const Axis& axis, double reach, double low, double high) {
  const auto [least, most] = std::minmax_element(axis.values.begin(), axis.values.end());
  if (*least < *most) return {{*least, *most}, true};
  return {{std::max(low, *least - reach), std::min(high, *most + reach)}, true};
}

// The scene with `count` Sobol grips in the box about the vessel's own.
Scene scene_around(const Scene& scene, std::size_t vessel, std::size_t count) {
  constexpr double ANY = std::numeric_limits<double>::infinity();
  constexpr double SHARE = 0.05;
  Scene around = scene;
  const GripsData& own = scene.grips;
  GripsData& grips = around.grips;
  const VesselData& data = scene.vessels[vessel];
  grips.height = own.height_is_fraction ? range_around(own.height, SHARE, 0, 1)
                                        : range_around(own.height, SHARE * (data.height - data.base), -ANY, ANY);
  grips.azimuth = range_around(own.azimuth, radians(15), -ANY, ANY);
  grips.obliquity = range_around(own.obliquity, radians(5), -PI / 2, PI / 2);
  grips.roll = range_around(own.roll, radians(15), -ANY, ANY);
  grips.offset = range_around(own.offset, SHARE * 0.1 * scene.hand.scale, -ANY, ANY);
  // lattices of meshes are made for the scene's largest hand; and float is not asked for more than its domain
  const double hand = own.hand_scale.values.front();
  const bool has_mesh =
      std::any_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& v) { return v.mesh.has_value(); });
  grips.hand_scale = range_around(own.hand_scale, SHARE * hand, std::min(hand, float_domain::SMALLEST_HAND / scene.hand.scale),
                                  has_mesh ? hand : std::max(hand, float_domain::LARGEST_HAND / scene.hand.scale));
  grips.sampling = Sampling::sobol;
  grips.count = count;
  grips.seed = own.seed + 1;  // other points than a scene's own
  return around;
}

}  // namespace

CheckSample check_sample(const Scene& scene, const sweeps::Plan& plan, std::size_t vessel) {
  CheckSample sample;
  sample.own = static_cast<std::size_t>(std::min<std::uint64_t>(plan.grips(), MOST_CHECKED_GRIPS));
  for (std::size_t i = 0; i < sample.own; ++i) sample.grips.push_back(plan.grip(vessel, own_index(plan, i)));
  if (sample.own >= FEWEST_CHECKED_GRIPS) return sample;
  const std::size_t missing = FEWEST_CHECKED_GRIPS - sample.own;
  const sweeps::Plan between(scene_around(scene, vessel, missing), true);
  sample.grips.resize(FEWEST_CHECKED_GRIPS);
  between.fill(vessel, 0, missing, sample.grips.data() + sample.own);
  return sample;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/load.h"
#include "core/mesh_body.h"
#include "core/prepare.h"

namespace wholehand {
namespace {

// The largest coordinate, arc's center or arc's radius of an outline from [0, 0] on, m.
double farthest(const std::vector<OutlineElement>& outline) {
  double largest = 0;
  std::array<double, 2> start{};
  for (const OutlineElement& element : outline) {
    largest = std::max({largest, std::abs(element.end[0]), std::abs(element.end[1])});
    if (element.is_arc) {
      largest = std::max({largest, std::abs(element.center[0]), std::abs(element.center[1]),
                          std::hypot(start[0] - element.center[0], start[1] - element.center[1])});
    }
    start = element.end;
  }
  return largest;
}

// The same of a vessel's surface.
double farthest(const VesselData& vessel) {
  double largest = 0;
  if (vessel.mesh) {
    for (int k = 0; k < 3; ++k)
      largest = std::max({largest, std::abs(vessel.mesh->body->facts.low[k]), std::abs(vessel.mesh->body->facts.high[k])});
  }
  largest = std::max(largest, farthest(vessel.outline));
  if (vessel.surface == Surface::shell) largest = std::max(largest, farthest(vessel.inner));  // a part of the surface then
  return largest;
}

core_f64::Vessel made_ready(const Scene& scene, const VesselData& data, const core_f64::Quadrature& rule) {
  return core_f64::load_vessel(prepare_vessel(data, data.has_cavity()), data, rule, false, scene.hand.handedness);
}

// The lightest of the glasses, with its weight, N.
std::pair<const VesselData*, double> lightest(const Scene& scene) {
  const core_f64::Quadrature rule = core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS));
  std::pair<const VesselData*, double> light{nullptr, 0};
  for (const VesselData& data : scene.vessels) {
    const double weight = made_ready(scene, data, rule).mass * scene.gravity;
    if (!light.first || weight < light.second) light = {&data, weight};
  }
  return light;
}

// The force that holds a vessel at its heaviest, with the longest lever about a line within its height, N; 0 if no force does.
double largest_hold(const Scene& scene, const VesselData& data) {
  const ForceData& force = scene.force;
  if (scene.tilts.empty() || !(force.friction > 0)) return 0;
  const core_f64::Quadrature rule = core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS));
  const core_f64::Vessel vessel = made_ready(scene, data, rule);
  double mass = vessel.mass;
  if (scene.liquid && data.has_cavity())
    mass += scene.liquid->density * vessel_fills(scene, data).back() * core_f64::lip_capacity(vessel, rule, 0, 1);
  const auto& center = vessel.center_of_mass;
  const double lever = std::max(std::abs(center.y - data.base), std::abs(data.height - center.y)) + std::hypot(center.x, center.z);
  const double twist = force.torsion > 0 ? lever / (2 * force.torsion) : 0;  // without torsion infinite, or nothing
  return mass * scene.gravity * (twist + 0.5) / force.friction;
}

std::string beyond(const std::string& what, const std::string& limit) {
  return fmt::format("{}: beyond {} float may be more than 10 um or 10 mN from double", what, limit);
}

}  // namespace

std::vector<std::string> domain_warnings(const Scene& scene, Precision precision) {
  using namespace float_domain;
  std::vector<std::string> warnings;
  if (precision == Precision::full) return warnings;
  const std::vector<double>& scales = scene.grips.hand_scale.values;
  const auto [least, most] = std::minmax_element(scales.begin(), scales.end());
  const double smallest = scene.hand.scale * *least, largest = scene.hand.scale * *most;
  const double rounding = 1e-12;  // of the products and conversions: the limits themselves are inside
  if (smallest < SMALLEST_HAND * (1 - rounding))
    warnings.push_back(beyond(fmt::format("hand scale {:.3g}", smallest), fmt::format("a smallest of {}", SMALLEST_HAND)));
  if (largest > LARGEST_HAND * (1 + rounding))
    warnings.push_back(beyond(fmt::format("hand scale {:.3g}", largest), fmt::format("a largest of {}", LARGEST_HAND)));
  const VesselData* far = nullptr;
  const VesselData* heavy = nullptr;
  double far_most = LARGEST_COORDINATE, hold_most = LARGEST_HOLD;
  for (const VesselData& vessel : scene.vessels) {
    if (const double reach = farthest(vessel); reach > far_most) {
      far = &vessel;
      far_most = reach;
    }
    if (const double hold = largest_hold(scene, vessel); hold > hold_most) {
      heavy = &vessel;
      hold_most = hold;
    }
  }
  if (far) {
    warnings.push_back(beyond(fmt::format("vessel '{}' has coordinates of {:.3g} m", far->name, far_most),
                              fmt::format("{} m", LARGEST_COORDINATE)));
  }
  if (heavy) {
    warnings.push_back(
        beyond(fmt::format("vessel '{}' is held by up to {:.2g} N", heavy->name, hold_most), fmt::format("{} N", LARGEST_HOLD)));
  }
  if (has_effort(scene)) {
    const auto [weakest, strongest] = std::minmax_element(scene.strength->digits.begin(), scene.strength->digits.end());
    if (*strongest > LARGEST_STRENGTH_RATIO * *weakest * (1 + rounding)) {
      warnings.push_back(
          fmt::format("digits have strengths of {:.3g} and {:.3g} N: beyond a ratio of {} efforts in float may be wrong", *weakest,
                      *strongest, LARGEST_STRENGTH_RATIO));
    }
    if (const auto [light, weight] = lightest(scene);
        weight > 0 && *strongest > LARGEST_STRENGTH_OF_WEIGHT * weight * (1 + rounding)) {
      warnings.push_back(fmt::format(
          "a digit has a strength of {:.3g} N and vessel '{}' weighs {:.3g} N: beyond a ratio of {} push and friction_needed in "
          "float may be wrong",
          *strongest, light->name, weight, LARGEST_STRENGTH_OF_WEIGHT));
    }
    if (scene.force.torsion > 0 && scene.force.torsion < SMALLEST_TORSION * (1 - rounding)) {
      warnings.push_back(fmt::format("torsion is {:.3g} mm: below {} mm and above 0 efforts in float may be wrong",
                                     scene.force.torsion * 1e3, SMALLEST_TORSION * 1e3));
    }
  }
  return warnings;
}

}  // namespace wholehand

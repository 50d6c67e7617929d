// SPDX-License-Identifier: MIT
#include "evidence/check/load_floors.h"

#include <algorithm>
#include <cmath>

#include "core/gather.h"
#include "core/planes.h"
#include "core/vectors.h"
#include "shaders/layout.h"

namespace wholehand {

LoadFloors::LoadFloors(const Scene& scene, const Evaluator& core, std::size_t vessel, double volume, double rounding,
                       const GatheredPlanes& truth)
    : scene_(scene) {
  const std::size_t states = scene.tilts.size() * static_cast<std::size_t>(scene_fills(scene));
  center_.assign(states, 0.0);
  force_per_torque_.assign(truth.count, 0.0);
  if (scene.tilts.empty()) return;
  const VesselConstants constants = core.constants(vessel);
  const double height = scene.vessels[vessel].height, reach = height + 0.1 * scene.hand.scale;
  const double mass = scene.liquid ? scene.liquid->density * volume : 0;
  const Triple& center = constants.center_of_mass;
  const double lever = reach + norm(center);
  const ForceData& force = scene.force;
  const double liquid_torque = scene.gravity * mass * (3 * height + reach);
  torque_ = liquid_torque + rounding * scene.gravity * constants.largest_mass * lever;
  const double twist = force.torsion > 0 ? liquid_torque / (2 * force.torsion) : 0;
  if (force.friction > 0) hold_ = (scene.gravity * mass / 2 + twist) / force.friction + scene.gravity * mass / 2;
  for (std::size_t s = 0; scene.liquid && s < states; ++s) {
    const double fill = vessel_fills(scene, scene.vessels[vessel])[s / scene.tilts.size()],
                 tilt = scene.tilts[s % scene.tilts.size()];
    center_[s] = 3 * mass * height / (constants.mass + core.liquid(vessel, fill, tilt).mass);
  }
  set_forces(constants, vessel, truth);
}

// A grip's tau_ref shows in where its force is largest: normal - base = range tau / tau_ref. Where that is not kept, or nothing but
// rounding, range / tau_ref is the vessel's, or for a pivot of SMALLEST_PIVOT.
void LoadFloors::set_forces(const VesselConstants& constants, std::size_t vessel, const GatheredPlanes& truth) {
  const FieldSet& fields = truth.fields;
  const ForceData& force = scene_.force;
  const double range = scene_.vessels[vessel].force_range.value_or(force.range);
  const double reference = force.reference == TorqueReference::per_grip ? constants.largest_mass * scene_.gravity * SMALLEST_PIVOT
                                                                        : constants.torque_reference;
  if (reference > 0) std::fill(force_per_torque_.begin(), force_per_torque_.end(), 2 * range / reference);  // tau <= tau_ref
  const int field = force.torque == Torque::exact ? FIELD_EXACT_TORQUE : FIELD_TORQUE;
  if (!fields.has(FIELD_NORMAL_FORCE) || !fields.has(field)) return;
  for (std::size_t i = 0; i < truth.count; ++i) {
    double largest = 0, risen = 0;
    for (std::size_t s = 0; s < center_.size(); ++s) {
      const double torque = std::abs(truth.real(fields.plane[field] + static_cast<int>(s), i));
      if (!(torque > largest)) continue;
      largest = torque;
      risen = truth.real(fields.plane[FIELD_NORMAL_FORCE] + static_cast<int>(s), i) - force.base;
    }
    if (largest > torque_ && range > 0) force_per_torque_[i] = risen / largest * (1 + risen / range);
  }
}

double LoadFloors::of(int field, std::size_t plane, std::size_t grip) const {
  const double force = torque_ * force_per_torque_[grip];
  const double force_term = scene_.force.max > 0 ? force / scene_.force.max : 0;
  const double by_strength = scene_.force.grip_strength > 0 ? hold_ / scene_.force.grip_strength : 0;
  const double hold_term = has_effort(scene_) ? 0 : by_strength;  // of efforts the search is far more
  switch (field) {
    case FIELD_PIVOT_LENGTH:
      return center_[plane];
    case FIELD_TORQUE:
    case FIELD_EXACT_TORQUE:
      return torque_;
    case FIELD_NORMAL_FORCE:
    case FIELD_FEEDBACK_FORCE:
    case FIELD_PEAK_FORCE:
      return force;
    case FIELD_HOLD_FORCE:
    case FIELD_LARGEST_HOLD:
      return hold_;
    case FIELD_TERMS:
      return plane == 4 ? force_term : plane == 5 ? hold_term : 0;
    case FIELD_SCORE:
      return scene_.score.force * force_term + scene_.score.hold * hold_term;
    default:
      return 0;
  }
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// How far forces may differ because of the load: the liquid's level is solved to a tolerance, and tilts and levers are rounded.
#pragma once

#include <cstddef>
#include <vector>

#include "core/evaluator.h"
#include "core/scene.h"

namespace wholehand {

struct GatheredPlanes;

// For the states and grips of one vessel. The liquid's volume may differ by `volume` m3 between two evaluations and its moments by
// `volume` times twice the vessel's height H, and a number by the share `rounding` of what it is the sum or product of; density rho,
// gravity g, total mass M of a state and M_max of the heaviest:
//   mass           dm = rho volume
//   center of mass 3 dm H / M          moments twice, and the mass they are divided by once
//   torque         g dm (3 H + L)      L: H and the hand's reach, which no pivot exceeds
//                  + rounding g M_max (L + the center of mass's way off)   however small the tilt's sine makes the torque itself
//   normal force   range (torque's + tau / tau_ref times the same for tau_ref) / tau_ref
//   hold force     (g dm / 2 + the liquid's torque / (2 gamma)) / mu + g dm / 2
//                  where gamma = 0 without the liquid's torque: contacts hold none, or the force is infinite
// and the score's terms and the score by what they divide these by.
class LoadFloors {
 public:
  LoadFloors(const Scene& scene, const Evaluator& core, std::size_t vessel, double volume, double rounding,
             const GatheredPlanes& truth);

  // The floor of plane `plane` of the field, in the field's unit.
  double of(int field, std::size_t plane, std::size_t grip) const;

 private:
  void set_forces(const VesselConstants& constants, std::size_t vessel, const GatheredPlanes& truth);

  const Scene& scene_;
  double torque_ = 0, hold_ = 0;          // N m, N
  std::vector<double> center_;            // m, by state
  std::vector<double> force_per_torque_;  // 1/m, by grip
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Grips with their contacts and the loads of all states, as the kernels of efforts take them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/evaluator.h"
#include "core/grip_effort.h"

namespace wholehand {

// A grip's contacts and the loads of all its states.
struct LoadedGrip {
  std::vector<core_f64::ContactPoint> contacts, tips;
  core_f64::HandStrength hand;
  std::vector<core_f64::Load> states;
  std::vector<core_f64::StateTilt> tilts;
  std::vector<std::size_t> counted;
  core_f64::Vec3 pour{};
  double gravity = 0;

  core_f64::GripLoads loads() const { return {states, tilts, counted, pour, gravity}; }
  std::size_t fills() const { return counted.size(); }
};

// The scene has [strength]; `result` is that of the grip, which is feasible.
LoadedGrip held_grip(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripInput& grip,
                     const GripResult& result);

// Plausible grips at random of each vessel of the shipped scene in turn; the same ones for a seed.
std::vector<LoadedGrip> random_loaded_grips(std::size_t count, Handedness handedness, std::uint64_t seed);

}  // namespace wholehand

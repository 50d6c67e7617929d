// SPDX-License-Identifier: MIT
// Gathers all planes of some grips from any backend, to compare or to look up.
#pragma once

#include <cstdint>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"

namespace wholehand {

// Every plane of some grips of one vessel; reals[plane * count + i].
struct GatheredPlanes {
  FieldSet fields;
  std::size_t count = 0;
  std::vector<double> reals;
  std::vector<std::uint32_t> uints;
  double real(int plane, std::size_t i) const { return reals[plane * count + i]; }
  std::uint32_t uint(int field, std::size_t i) const { return uints[fields.plane[field] * count + i]; }
};

// Every field that the scene has.
FieldSet all_fields(const Scene& scene);
GatheredPlanes gather(Backend& backend, std::size_t vessel, const std::vector<GripInput>& grips);
GatheredPlanes gather(const Evaluator& core, const FieldSet& fields, std::size_t vessel, const std::vector<GripInput>& grips);

// Liquid of a vessel over the scene's fills and tilts by the core, fill-major, as in Backend::liquid; empty without liquid.
std::vector<LiquidResult> core_liquid(const Scene& scene, const Evaluator& core, std::size_t vessel);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The reference answers for all variants, on the same grips and states, and a variant's distance from them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/evaluator.h"
#include "core/gather.h"
#include "evidence/check/error_row.h"

namespace wholehand {

// The compared fields of a grip. With `brackets` also both bounds of each state's effort.
FieldSet reference_fields(const Scene& scene, bool brackets = false);

struct ReferenceOptions {
  int threads = 1;
  std::uint64_t seed = 1;  // of points about the glass
};

class ErrorReference {
 public:
  // Throws Error as the evaluators do. The scene outlives it.
  ErrorReference(const Scene& scene, const std::vector<std::vector<GripInput>>& grips, const ReferenceOptions& options);

  std::uint64_t feasible() const { return feasible_; }
  std::uint64_t grazing() const { return grazing_; }

  // Planes and liquid by vessel; `core` has the variant's constants. Fills in the row's errors and flips.
  void compare(const std::vector<GatheredPlanes>& planes, const Evaluator& core, ErrorRow& row) const;
  void compare_liquid(const std::vector<std::vector<LiquidResult>>& liquid, const Evaluator& core, ErrorRow& row) const;
  ErrorFigures compare_distance(const Evaluator& core) const;

 private:
  double nearby_distance_error(const Evaluator& core) const;

  const Scene& scene_;
  std::uint64_t seed_;
  std::shared_ptr<const Evaluator> reference_;
  std::vector<GatheredPlanes> truth_;
  std::vector<std::vector<LiquidResult>> true_liquid_;
  // by vessel: whether the reference has joints whose skin is within LATTICE_BAND of the surface
  std::vector<std::vector<Triple>> nearby_;
  std::uint64_t feasible_ = 0, grazing_ = 0;
};

}  // namespace wholehand

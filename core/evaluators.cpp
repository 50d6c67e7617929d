// SPDX-License-Identifier: MIT
// Each precision's library has its own namespace; this is where the product names them.
#include "core/evaluator.h"

namespace core_f64 {
std::unique_ptr<wholehand::Evaluator> make_evaluator(const wholehand::Scene&, const wholehand::EvaluatorOptions&);
}
namespace core_f32 {
std::unique_ptr<wholehand::Evaluator> make_evaluator(const wholehand::Scene&, const wholehand::EvaluatorOptions&);
}

namespace wholehand {

const PreparedLattice* Evaluator::lattice(std::size_t) const { return nullptr; }

std::vector<GripContact> Evaluator::contacts(std::size_t, const GripResult&) const { return {}; }

std::optional<PosedHand> Evaluator::posed(std::size_t vessel, const GripInput& input) const {
  GripResult result;
  grip(vessel, input, result);
  if (result.reason != Reason::none) return std::nullopt;
  return result.posed;
}

std::unique_ptr<Evaluator> make_core_evaluator(const Scene& scene, const EvaluatorOptions& options) {
  return core_f64::make_evaluator(scene, options);
}

std::unique_ptr<Evaluator> make_core_float_evaluator(const Scene& scene, const EvaluatorOptions& options) {
  return core_f32::make_evaluator(scene, options);
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The core in long double, as a wider reference; test executables without sanitizers link it.
#pragma once

#include <memory>

#include "core/evaluator.h"

namespace core_ld {

std::unique_ptr<wholehand::Evaluator> make_evaluator(const wholehand::Scene& scene, const wholehand::EvaluatorOptions& options);

}  // namespace core_ld

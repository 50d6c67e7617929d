// SPDX-License-Identifier: MIT
// The core that counts its operations (tests/support/counted.h): what executables see of it that link core_counted.
#pragma once

#include <memory>

#include "core/evaluator.h"
#include "core/wall_case.h"

namespace core_counted {

std::unique_ptr<wholehand::Evaluator> make_evaluator(const wholehand::Scene& scene, const wholehand::EvaluatorOptions& options);
double late_energy(const wholehand::WallCase& wall_case, int samples, int late);

}  // namespace core_counted

// SPDX-License-Identifier: MIT
// The parts with which a sweep computes.
#pragma once

#include <functional>
#include <memory>

#include "core/backend.h"
#include "core/evaluator.h"
#include "sweeps/result/output_bytes.h"
#include "sweeps/run/auto_backend.h"

namespace wholehand {

// What a sweep gets from elsewhere. Tests supply their own.
struct SweepParts {
  std::function<std::unique_ptr<Backend>(const BackendChoice&, const FieldSet&)> open_backend;
  std::function<std::unique_ptr<Evaluator>()> open_evaluator;  // for vessel facts that no grip changes
  // Slow work after all checks that can be made at once (meshes); may be empty. Answers where the sweep goes on, as with_core_fallback does.
  std::function<BackendChoice(const BackendChoice&)> prepare = {};
  // Opens the core for the sweep's scene, or for one that differs from it only in its friction. It evaluates listed grips and their deviations, so
  // that lists are the same on every device.
  std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)> open_core = {};
  OpenOutput open_output = {};  // writes the values; empty: the system's own calls
};

}  // namespace wholehand

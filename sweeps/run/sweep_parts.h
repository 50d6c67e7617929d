// SPDX-License-Identifier: MIT
// What a sweep computes with.
#pragma once

#include <functional>
#include <memory>

#include "core/backend.h"
#include "core/evaluator.h"
#include "sweeps/result/output_bytes.h"

namespace wholehand {

// What a sweep gets from elsewhere. Tests put in their own.
struct SweepParts {
  std::function<std::unique_ptr<Backend>(const FieldSet&)> open_backend;
  std::function<std::unique_ptr<Evaluator>()> open_evaluator;  // for what is known of a vessel whatever the grip
  std::function<void()> prepare = {};  // what takes long and comes after all that can be refused at once (meshes); may be empty
  // Opens the core for the sweep's scene, or for one that differs from it in its friction alone. It evaluates listed grips and their deviations, so
  // that lists are the same on every device.
  std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)> open_core = {};
  OpenOutput open_output = {};  // what values are written with; empty: the system's own calls
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// What a sweep leaves out because its scene does not need it, and the time saved, measured on the spot with one sample both ways.
#pragma once

#include <string>

#include "core/backend.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

constexpr std::size_t EXPLAIN_GRIPS = 4096;

struct ExplainOptions {
  std::string on;
  Precision precision = Precision::single;
  int threads = 0;
  std::size_t best = 0;               // grips that the sweep lists, of each vessel and hand scale
  std::size_t grips = EXPLAIN_GRIPS;  // of the first vessel, in each variant
};

// Lines for the terminal. Each variant evaluates the same grips of the scene's first vessel; takes the shortest of five runs after one warm-up.
// Throws Error as open_backend does.
std::string explain_sweep(const Scene& scene, const Plan& plan, const FieldSet& fields, const ExplainOptions& options);

}  // namespace wholehand::sweeps

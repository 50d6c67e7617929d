// SPDX-License-Identifier: MIT
// The core's leaf functions behind rows of plain doubles, in either precision: what the probes of tests/shaders are compared with.
#pragma once

#include <memory>
#include <vector>

#include "core/evaluator.h"
#include "core/scene.h"

namespace wholehand {

class Leaves {
 public:
  virtual ~Leaves() = default;
  // `probe` is a PROBE_* of tests/shaders/probe_table.h; `given` holds its numbers, `answer` has room for what it gives.
  virtual void evaluate(int probe, const double* given, double* answer) const = 0;
};

// For a scene's hand and one of its vessels; lattice_samples > 0: the vessel's outline sampled on a lattice.
std::unique_ptr<Leaves> make_double_leaves(const Scene& scene, std::size_t vessel, int lattice_samples = 0, int lattice_bits = 32);
std::unique_ptr<Leaves> make_float_leaves(const Scene& scene, std::size_t vessel, int lattice_samples = 0, int lattice_bits = 32);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The shaders' leaf functions on a device, row by row, beside the core's (leaf_facade.h): what tests/shaders/parity_leaf_test.cpp
// compares.
#pragma once

#include <string_view>
#include <vector>

#include "core/backend.h"
#include "host/run_once.h"
#include "host/scene_arrays.h"
#include "host/shaders.h"

namespace wholehand {

// A scene's hand and one vessel of it on a device, in one precision.
class LeafProbe {
 public:
  // `source`: how the outline is read by those shaders that read it. lattice_samples > 0: its distance sampled on a lattice.
  LeafProbe(const host::Device& device, const Scene& scene, std::size_t vessel, Precision precision, OutlineSource source,
            int lattice_samples = 0, int lattice_bits = 32);

  // `rows` rows of `given` (inputs numbers each) through a probe of tests/shaders/`shader`; outputs numbers each.
  std::vector<double> run(std::string_view shader, int probe, const std::vector<double>& given, std::size_t rows, int inputs,
                          int outputs) const;

 private:
  const host::Device& device_;
  Precision precision_;
  OutlineSource source_;
  std::vector<host::Constant> constants_;
  host::Buffer parameters_, hand_, outline_, lattice_;
};

}  // namespace wholehand

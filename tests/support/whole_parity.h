// SPDX-License-Identifier: MIT
// Whole grips on a device against the core: scenes, grips and what is done with their planes.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "evidence/check/compare.h"
#include "host/grip_backend.h"
#include "sweeps/plan/variables.h"
#include "tests/support/scenes.h"

namespace wholehand {

// A belly of straight pieces: more elements than a pipeline's constants hold, and more pieces of cavity than the device integrates.
VesselData facets();
Scene wet_scene(std::vector<VesselData> vessels, Pose pose, const HandData& hand = paper_hand());

constexpr int COUNT = 203;  // no multiple of a work group
// Hands of several sizes; the first along the axis.
std::vector<GripInput> grips_of(const Scene& scene, std::size_t vessel, int count);

std::unique_ptr<host::GripBackend> backend_of(const Scene& scene, const FieldSet& fields, Precision precision,
                                              host::GripBackendOptions options = {});
std::unique_ptr<Evaluator> core_of(const Scene& scene, Precision precision);

std::string table_of(const Comparer& comparer);
// Device against core of the same precision and against core double, in each precision.
void expect_parity(const Scene& scene, const std::string& name, int count = COUNT);

}  // namespace wholehand

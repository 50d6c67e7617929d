// SPDX-License-Identifier: MIT
// The contents of a sweep's result file, and its definition as NetCDF-4.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "sweeps/plan/vessel_facts.h"

namespace wholehand::sweeps {

// Everything in a result file except the grips' own values. Refers to the scene and the plan.
struct ResultContents {
  const Scene& scene;
  const Plan& plan;
  std::vector<const Variable*> variables;
  std::vector<VesselFacts> facts;
  BackendInfo info;
  std::string version;
  std::size_t best = 0;  // ranks of the best grips
};

// Dimensions of the grips: those of the plan's axes, or "point" for Sobol points.
std::vector<std::string> grip_dimensions(const Plan& plan);

// Height of the thumb-index line in the vessel's frame, m: an axis, or over (vessel, height's axis) if that has fractions.
constexpr const char* HEIGHT = "height";

// Variables of the best grips over (vessel, rank), or (vessel, hand scale, rank) if the plan has several hand scales: index in the grips' dimensions,
// score, and the axes (heights always in m); for refined grips score and axes, except the hand scale, which stays; with [robust] their robust scores.
constexpr const char* BEST_GRIP = "best_grip";
constexpr const char* BEST_SCORE = "best_score";
std::string best_axis_name(const PlanAxis& axis);
constexpr const char* REFINED_SCORE = "best_refined_score";
constexpr const char* ROBUST_MEAN = "best_robust_mean";
constexpr const char* ROBUST_LOW = "best_robust_low";
constexpr const char* ROBUST_SHARE = "best_robust_share";
std::string refined_axis_name(const PlanAxis& axis);
bool is_refined_axis(const PlanAxis& axis);
std::string best_scale_dimension(const Plan& plan);  // of the hand scales; Sobol points have a variable of the plain name

// Attributes of a scene with meshes: where the search for relative mesh files starts, and what identifies them (core/meshes/vessel.h).
constexpr const char* SCENE_FILE = "scene_file";
constexpr const char* MESHES = "meshes";
constexpr const char* MESH_KEYS = "mesh_keys";
constexpr const char* MESH_LATTICES = "mesh_lattices";

// Attributes whose value is known only at the end; NaN until then.
constexpr const char* WALL_TIME = "wall_time_s";
constexpr const char* KERNEL_TIME = "kernel_time_s";

// Upper bound of the file's bytes. Needs no facts, and only the precision of the info; the bound then leaves out the bytes of the texts that are
// missing.
std::uint64_t result_size(ResultContents contents);

// Creates the file `path` with every dimension, attribute and variable, all values that need no grip, and room for the others: every variable of the
// grips is one contiguous block, allocated and not filled. Throws Error (failure).
void define_result_file(const std::string& path, const ResultContents& contents);

}  // namespace wholehand::sweeps

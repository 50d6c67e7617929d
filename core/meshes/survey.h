// SPDX-License-Identifier: MIT
// Surveys a mesh file: what it is, and with which keys of a scene it becomes a vessel.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/meshes/cavity_finder.h"
#include "core/meshes/check.h"
#include "core/meshes/lattice.h"
#include "core/meshes/parts.h"
#include "core/reader/new_scene.h"
#include "core/scene.h"

namespace wholehand {

constexpr double SUPPOSED_THICKNESS = 2e-3;  // m, of a sheet without one

// What is known of the file; all else is found.
struct SurveyRequest {
  std::string file;
  std::optional<double> scale;      // of the file's unit, m; 1e-6 to 1e6
  std::optional<bool> z_is_up;      // else y
  std::vector<int> parts;           // from 1
  std::optional<double> thickness;  // m, of a sheet; 0.05e-3 to 0.1
};

// A choice, and why it was made: a clause.
struct SurveyReasons {
  std::string unit, up, parts, holes;  // empty: there was nothing to choose
};

struct MeshSurvey {
  // The keys of [[vessel]] with which the mesh stands upright, as large as it is, with the cavity's axis at x = z = 0.
  MeshData data;
  SurveyReasons reasons;
  CheckedMesh mesh;             // so placed
  std::vector<MeshPart> parts;  // in the file's frame and unit
  CavitySearch cavity;          // of it, in the vessel frame
  LatticePlan lattice;          // for a hand of the default size
};

// Reads, checks and searches the file. Throws Error (usage), one line, for what read_mesh, check_mesh and thickened refuse, for a part that is not
// there, and for a request out of range.
MeshSurvey survey_mesh(const SurveyRequest& request);

// The findings as lines for people, without the outline.
std::vector<std::string> survey_lines(const MeshSurvey& survey);
// As JSON: lengths in mm, volumes in mL.
std::string survey_json(const MeshSurvey& survey);

// The keys of [[vessel]] that make the vessel of it, without `mesh`.
std::vector<SceneKey> scene_keys(const MeshSurvey& survey);
// The text of a scene with these keys, except for those that `wanted.numbers` gives; `wanted.mesh` is the path as the scene is to name it. Throws as
// new_scene.
std::string scene_of_mesh(NewScene wanted, const MeshSurvey& survey);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Writes a new scene of one vessel, complete and commented, as TOML.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/reader/ranges.h"

namespace wholehand {

// A key of a scene's table, its value as TOML, and a comment.
struct SceneKey {
  std::string key, value, comment;
};

struct NewScene {
  std::string name;                                     // of scene and vessel
  std::string shape = "cylinder";                       // docs/scene.md, [[vessel]]
  std::string mesh;                                     // replaces the shape: the file's path from the scene's folder
  std::vector<SceneKey> mesh_keys;                      // that make a vessel of the mesh (core/meshes/survey.h)
  std::vector<std::pair<std::string, double>> numbers;  // keys of [[vessel]] with their values, in the order of the text
  std::optional<double> fill;                           // mL; without it, fractions of what the vessel holds

  // Whether liquid has a place in it.
  bool has_cavity() const;
};

// A numeric key of [[vessel]]: its range, its comment in the text, and its description for users of the command.
struct NewSceneKey {
  const char* name;
  Quantity range;
  const char* comment;
  const char* help;
};

// The numbers that may be given.
std::span<const NewSceneKey> new_scene_keys();

// The text: vessel, table, liquid (not in a mesh without a cavity), hand's strength, grips, tilts, deviations and output. parse_scene reads it. Throws Error (usage),
// which names the key and what is allowed, if parse_scene would refuse it.
std::string new_scene(const NewScene& wanted);

}  // namespace wholehand

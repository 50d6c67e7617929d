// SPDX-License-Identifier: MIT
// A new scene of one vessel, complete and commented, as TOML.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wholehand {

struct NewScene {
  std::string name;                                     // of scene and vessel
  std::string shape = "cylinder";                       // docs/scene.md, [[vessel]]
  std::string mesh;                                     // instead of a shape: the file's path from the scene's folder
  std::vector<std::pair<std::string, double>> numbers;  // keys of [[vessel]] with their values, in their order in the text
  std::optional<double> fill;                           // mL; without it, fractions of what the vessel holds
};

// The numbers that may be given, with their ranges in scene/ranges.h: keys of [[vessel]].
const std::vector<std::string>& new_scene_keys();

// The text: vessel, table, liquid (not in a mesh), hand's strength, grips, tilts, deviations and output. parse_scene reads it. Throws
// Error (usage), which names the key and what is allowed, where parse_scene would refuse it.
std::string new_scene(const NewScene& wanted);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Where the program finds the scenes that it ships.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

inline constexpr const char* DEFAULT_SCENE = "three_beakers";

// Folder of the shipped scenes: share/wholehand/scenes beside the program, library or module with this code, or of the prefix in whose
// bin/, lib/ or Python packages that is; else examples/scenes above a build folder; else share/wholehand/scenes of /usr/local
// or /usr. Empty where none of them exists.
std::string scenes_dir();

// Names of the shipped scenes, without .toml, in order.
std::vector<std::string> shipped_scenes();

// The extreme scenes (the folder `extreme` beside scenes_dir()), as paths in order; none where there is no such folder.
std::vector<std::string> extreme_scene_files();

// A path that exists stays; a bare name may be that of a shipped scene, with or without .toml; empty: the default scene. Throws Error
// (usage) where there is no such scene, naming the shipped ones, and Error (failure) where the default one is gone.
std::string find_scene(const std::string& name);

}  // namespace wholehand

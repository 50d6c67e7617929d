// SPDX-License-Identifier: MIT
// Finds the scenes that ship with the program.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

inline constexpr const char* DEFAULT_SCENE = "three_beakers";

// Folder of the shipped scenes: share/wholehand/scenes beside the program, library or module that contains this code, or of the prefix whose bin/,
// lib/ or Python packages contain it; else examples/scenes above a build folder; else share/wholehand/scenes of /usr/local or /usr. Empty if none
// exists.
std::string scenes_dir();

// Names of the shipped scenes, without .toml, in order.
std::vector<std::string> shipped_scenes();

// The extreme scenes (the folder `extreme` beside scenes_dir()), as paths in order; none where there is no such folder.
std::vector<std::string> extreme_scene_files();

// An existing path stays; a bare name may be a shipped scene's, with or without .toml; empty: the default scene. Throws Error: (usage) no such scene,
// with the shipped ones; (failure) the default one is missing.
std::string find_scene(const std::string& name);

}  // namespace wholehand

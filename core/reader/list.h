// SPDX-License-Identifier: MIT
// What scene files are for, in a line each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wholehand {

// The first sentence of the comment that a scene's text begins with, on one line and without its full stop; "" where it begins with none.
std::string purpose_of_scene(std::string_view text);

// A line a file: its name without .toml, the vessels of the scene, its purpose; in columns. Throws Error (usage) where a file is no scene.
std::string list_scenes(const std::vector<std::string>& files);

}  // namespace wholehand

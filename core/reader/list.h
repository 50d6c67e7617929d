// SPDX-License-Identifier: MIT
// Lists scene files with their purpose, a line each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wholehand {

// The first sentence of a scene text's leading comment, on one line and without its full stop; "" if there is no such comment.
std::string purpose_of_scene(std::string_view text);

// One line per file: its name without .toml, the vessels of the scene, its purpose; in columns. Throws Error (usage) if a file is not a scene.
std::string list_scenes(const std::vector<std::string>& files);

}  // namespace wholehand

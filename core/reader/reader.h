// SPDX-License-Identifier: MIT
// Reads scene files: TOML with exactly the keys of docs/scene.md into core/scene.h's plain data, in SI units.
#pragma once

#include <string>
#include <string_view>

#include "core/scene.h"

namespace wholehand {

// The scene that `text` (TOML, at most 1 MiB) describes; `name` stands for it in messages and in Scene::file. Throws Error (usage) for anything not
// allowed, in one line: `name:line:column: what was found; what is allowed`. Throws nothing else, whatever the text.
Scene parse_scene(std::string_view text, const std::string& name);

// The same from a file. Also throws Error (usage) if it is missing, unreadable or larger than 1 MiB.
Scene read_scene_file(const std::string& path);

}  // namespace wholehand

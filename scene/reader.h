// SPDX-License-Identifier: MIT
// Reads scene files: TOML with exactly the keys of docs/scene.md into core/scene.h's plain data, in SI units.
#pragma once

#include <string>
#include <string_view>

#include "core/scene.h"

namespace wholehand {

// What a scene has that its text does not name.
struct SceneDefaults {
  ScoreWeights score;
  std::string version;         // as Scene::version
  bool is_before_0_4 = false;  // then the paper's hand; no strengths without [strength], and with it the same at every opening
};

// Those of a version of the program, "0.2.1".
SceneDefaults defaults_of(const std::string& version);

// The scene that `text` (TOML, at most 1 MiB) describes; `name` stands for it in messages and in Scene::file. Throws Error (usage) for
// whatever is not allowed, in one line: `name:line:column: what was found; what is allowed`. Nothing else is thrown, whatever the text.
Scene parse_scene(std::string_view text, const std::string& name, const SceneDefaults& unnamed = {});

// The same from a file. Throws Error (usage) too where it is missing, unreadable or larger than 1 MiB.
Scene read_scene_file(const std::string& path);

}  // namespace wholehand

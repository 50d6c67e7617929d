// SPDX-License-Identifier: MIT
// The default scene of `live` for tests that keep to a clock and do not ask whether ticks are late: a busy machine ends no session.
#pragma once

#include <string>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "tests/support/files.h"

namespace wholehand {

// The scene's file, in `folder`, by the scene's name.
inline std::string patient_board(const TemporaryFolder& folder) {
  const std::string file = folder / "mixing_board.toml";
  write_file(file, read_scene_file(find_scene("mixing_board")).text + "\n[live]\nlate_steps = 1000\n");
  return file;
}

}  // namespace wholehand

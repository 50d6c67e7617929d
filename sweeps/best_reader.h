// The best grips of a sweep, from its result file.
#pragma once

#include <string>
#include <vector>

#include "core/result.h"

namespace wholehand {

struct RecordedBest {
  struct Ranked {
    GripInput grip;
    double score = 0;  // as the sweep found it
  };
  std::string scene_text, scene_file;        // the file is named only where the scene has meshes
  std::vector<std::vector<Ranked>> vessels;  // the best first
};

// Throws Error (usage), one line with the file: it cannot be read, is no finished result of a sweep, or was told to keep no best grips.
RecordedBest read_best(const std::string& path);

}  // namespace wholehand

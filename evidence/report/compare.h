// SPDX-License-Identifier: MIT
// Two results of sweeps side by side: what an edit of a scene changed. `wholehand compare` prints it and writes it as a page.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

struct CompareTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

// A section: sentences, changed lines of the scenes ("- " only in A, "+ " only in B), tables. The first is about how both were judged, and each
// other one about a vessel of both.
struct ComparePart {
  std::string title;
  std::vector<std::string> sentences, changes;
  std::vector<CompareTable> tables;
};

// Goes through both files in blocks, so that memory does not depend on the number of grips. Each scene is what its result's text describes; its
// meshes need not be there. Throws Error (usage) where a file is damaged or does not fit its scene.
std::vector<ComparePart> compare_results(SweepResult& a, const Scene& scene_a, SweepResult& b, const Scene& scene_b);

// Lines for a terminal.
std::string comparison_text(const std::vector<ComparePart>& parts);

// One self-contained file of HTML, well-formed XML too.
std::string comparison_page(const std::vector<ComparePart>& parts);

}  // namespace wholehand

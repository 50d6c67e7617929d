// SPDX-License-Identifier: MIT
// Compares two results of sweeps, to show what an edit of a scene changed. `wholehand compare` prints it and writes it as a page.
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

// A section: sentences, changed lines of the scenes ("- " only in A, "+ " only in B), tables. The first is about how both were judged; each other one
// is about a vessel that both have.
struct ComparePart {
  std::string title;
  std::vector<std::string> sentences, changes;
  std::vector<CompareTable> tables;
};

// Goes through both files in blocks, so that memory does not depend on the number of grips. Each result's text describes its scene; the meshes need
// not exist. Throws Error (usage) if a file is damaged or does not fit its scene.
std::vector<ComparePart> compare_results(sweeps::SweepResult& a, const Scene& scene_a, sweeps::SweepResult& b,
                                         const Scene& scene_b);

// Lines for a terminal.
std::string comparison_text(const std::vector<ComparePart>& parts);

// One self-contained HTML file that is also well-formed XML.
std::string comparison_page(const std::vector<ComparePart>& parts);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// study.html: one page with a study's results. Each experiment adds sections.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/charts/markup.h"
#include "core/scene.h"
#include "evidence/studies/row.h"
#include "evidence/studies/statistic_tables.h"

namespace wholehand {

// Shown in this order: the words, what `write` makes of the rows, the charts.
struct StudySection {
  std::string id;  // in the page
  std::string title;
  std::vector<std::string> words;     // paragraphs
  std::vector<StudyRow> rows;         // may be empty
  std::vector<std::string> charts{};  // each a caption and SVG
  void (*write)(MarkupWriter& html, std::span<const StudyRow> rows) = write_statistic_tables;
};

struct StudyPage {
  std::string title;
  std::string lead;  // one line under the title
  std::vector<StudySection> sections;
  std::uint64_t seed = 1;
};

// "How do people grasp small?"
std::string study_title(const Scene& scene);

// Self-contained HTML, also well-formed XML.
std::string study_page(const StudyPage& page);

}  // namespace wholehand

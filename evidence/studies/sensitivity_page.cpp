// SPDX-License-Identifier: MIT
#include "evidence/studies/sensitivity_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "base/charts/html.h"
#include "evidence/studies/sensitivity.h"

namespace wholehand {
namespace {

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

void write_strongest(MarkupWriter& html, std::span<const StudyRow> rows) {
  HtmlTable table(html, "The traits that move each answer most", {"experiment", "answer", "first", "second", "third"},
                  {1, 2, 3, 4});
  for (const OutputIndices& output : strongest_inputs(rows)) {
    std::vector<std::string> cells{output.experiment, spaced(output.output)};
    for (const InputIndex& one : output.inputs)
      cells.push_back(
          fmt::format("{}: {:.2f} ({:.2f} to {:.2f})", one.input, one.index, std::max(0.0, one.interval.low), one.interval.high));
    cells.resize(5, "\u2013");
    table.row(cells);
  }
  table.end();
}

}  // namespace

StudySection sensitivity_section(std::vector<StudyRow> rows) {
  StudySection section;
  section.id = "sensitivity";
  section.title = "What moves what";
  section.words = {
      "A first-order Sobol index is the share of an answer's variance, from person to person, that one trait of people accounts "
      "for "
      "by itself. The interval is one of 95 %. What is left is scatter from grasp to grasp, and traits together. A next experiment "
      "with people should measure the traits with the largest indices.",
      "An answer has a dash where no trait moves it measurably, or where there are too few people (160 are needed)."};
  section.rows = std::move(rows);
  section.write = write_strongest;
  return section;
}

}  // namespace wholehand

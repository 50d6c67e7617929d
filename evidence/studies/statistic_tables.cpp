// SPDX-License-Identifier: MIT
#include "evidence/studies/statistic_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "base/charts/html.h"
#include "evidence/studies/paper_sample.h"
#include "evidence/studies/statistic_words.h"

namespace wholehand {
namespace {

bool has_subjects(std::span<const StudyRow> rows) {
  return std::any_of(rows.begin(), rows.end(), [](const StudyRow& row) { return !row.subject.empty(); });
}

std::vector<std::string> vessels_of(std::span<const StudyRow> rows) {
  std::vector<std::string> vessels;
  for (const StudyRow& row : rows)
    if (std::find(vessels.begin(), vessels.end(), row.vessel) == vessels.end()) vessels.push_back(row.vessel);
  return vessels;
}

std::string caption_of(const std::string& vessel) {
  if (vessel.empty()) return "The population";
  return vessel == ALL_VESSELS ? "All vessels of the sample together" : "The vessel " + vessel;
}

std::string paper_text(const StudyRow& row) { return row.paper ? statistic_value(row.statistic, *row.paper) : "-"; }

}  // namespace

std::string page_text(std::string text) {
  if (text == "-") return "\u2013";
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += 3)
    if (at + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[at + 1]))) text.replace(at, 1, "\u2212");
  return text;
}

std::string plain_table(const TextTable& lines, std::size_t names) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const auto& line : lines)
    for (std::size_t k = 0; k < line.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k)
      text +=
          k < names ? fmt::format("{}{:<{}}", k == 0 ? "" : "  ", line[k], widths[k]) : fmt::format("  {:>{}}", line[k], widths[k]);
    text += "\n";
  }
  return text;
}

void write_statistic_tables(MarkupWriter& html, std::span<const StudyRow> rows) {
  html.element("p", inside_sentence(rows));
  const bool with_subjects = has_subjects(rows);
  std::vector<std::string> columns{"statistic", "value", "95 % interval", "the paper", "inside"};
  if (with_subjects) columns.insert(columns.begin() + 1, "of");
  const std::vector<std::size_t> words = with_subjects ? std::vector<std::size_t>{1, 5} : std::vector<std::size_t>{4};
  for (const std::string& vessel : vessels_of(rows)) {
    HtmlTable table(html, caption_of(vessel), columns, words);
    for (const StudyRow& row : rows) {
      if (row.vessel != vessel || row.statistic == INSIDE_SHARE) continue;
      std::vector<std::string> cells{statistic_words(row.statistic)};
      if (with_subjects) cells.push_back(row.subject);
      for (const std::string& text : {statistic_value(row.statistic, row.value), interval_words(row), paper_text(row)})
        cells.push_back(page_text(text));
      cells.push_back(page_text(inside_words(row)));
      table.row(cells);
    }
    table.end();
  }
}

std::string statistic_table(std::span<const StudyRow> rows) {
  TextTable lines{{"vessel", "statistic", "value", "95 % interval", "paper", "inside"}};
  for (const StudyRow& row : rows) {
    if (row.statistic == INSIDE_SHARE) continue;
    const std::string of = row.subject.empty() ? "" : ", " + row.subject;
    lines.push_back({row.vessel, statistic_words(row.statistic) + of, statistic_value(row.statistic, row.value),
                     interval_words(row), paper_text(row), inside_words(row)});
  }
  return plain_table(lines, 2) + "\n" + inside_sentence(rows) + "\n";
}

}  // namespace wholehand

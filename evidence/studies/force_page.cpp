// SPDX-License-Identifier: MIT
#include "evidence/studies/force_page.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/charts/html.h"
#include "evidence/studies/force_statistics.h"
#include "evidence/studies/statistic_tables.h"
#include "evidence/studies/statistic_words.h"

namespace wholehand {
namespace {

const StudyRow* force_row(std::span<const StudyRow> rows, const std::string& statistic, const std::string& subject) {
  for (const StudyRow& row : rows)
    if (row.statistic == statistic && row.subject == subject) return &row;
  return nullptr;
}

std::string percent(double share) { return std::isnan(share) ? "-" : fmt::format("{:.0f} %", 100 * share); }

// "41 % (10 to 70)".
std::string share_text(const StudyRow* row) {
  if (!row) return "-";
  std::string text = percent(row->value);
  if (row->interval.low <= row->interval.high)
    text += fmt::format(" ({:.0f} to {:.0f})", 100 * row->interval.low, 100 * row->interval.high);
  return text;
}

// A line for each choice.
TextTable choices_table(std::span<const StudyRow> rows) {
  TextTable table{
      {"F, N", "lost often", "the paper", "inside", "oscillated", "held", "open 0.5 mm", "1 mm", "2 mm", "opening, mm"}};
  for (const ForceChoice& choice : PAPER_CHOICES) {
    const std::string name = choice_name(choice);
    const StudyRow* lost = force_row(rows, "lost_share", name);
    const StudyRow* opening = force_row(rows, "largest_opening_mean", name);
    std::vector<std::string> line{name, share_text(lost), lost && lost->paper ? percent(*lost->paper) : "-",
                                  lost ? inside_words(*lost) : "-"};
    for (const char* statistic :
         {"oscillated_share", "held_share", "opening_over_0.5mm_share", "opening_over_1mm_share", "opening_over_2mm_share"})
      line.push_back(share_text(force_row(rows, statistic, name)));
    line.push_back(opening && !std::isnan(opening->value) ? fmt::format("{:.2f}", opening->value * 1e3) : "-");
    table.push_back(line);
  }
  return table;
}

// "6.77 (4.38 to 9.21)".
std::string coefficient_text(const StudyRow* row) {
  if (!row || std::isnan(row->value)) return "-";
  std::string text = fmt::format("{:.2f}", row->value);
  if (row->interval.low <= row->interval.high) text += fmt::format(" ({:.2f} to {:.2f})", row->interval.low, row->interval.high);
  return text;
}

// What F_base and F_range do to the odds of each event.
TextTable odds_table(std::span<const StudyRow> rows) {
  TextTable table{{"event", "F_base, for each N", "F_range, for each N", "F_base ahead"}};
  for (const StudyRow& row : rows) {
    if (row.statistic != "coefficient_base") continue;
    const StudyRow* ahead = force_row(rows, "base_ahead_of_range", row.subject);
    const bool is_known = ahead && !std::isnan(ahead->value);
    std::string event = row.subject;
    for (char& c : event) c = c == '_' ? ' ' : c;
    table.push_back({event, coefficient_text(&row), coefficient_text(force_row(rows, "coefficient_range", row.subject)),
                     is_known ? (ahead->value > 0 ? "yes" : "no") : "-"});
  }
  return table;
}

void write_table(MarkupWriter& html, const std::string& caption, const TextTable& lines, const std::vector<std::size_t>& words) {
  HtmlTable table(html, caption, lines.front(), words);
  for (std::size_t k = 1; k < lines.size(); ++k) {
    std::vector<std::string> cells = lines[k];
    for (std::size_t c = 1; c < cells.size(); ++c) cells[c] = page_text(cells[c]);  // the first has names such as 0.8-3.8
    table.row(cells);
  }
  table.end();
}

void write_force_tables(MarkupWriter& html, std::span<const StudyRow> rows) {
  html.element("p", inside_sentence(rows));
  write_table(html, fmt::format("Choices of F_base and F_range on {}", rows.front().vessel), choices_table(rows), {3});
  write_table(html, "How the log odds of an event change", odds_table(rows), {3});
}

}  // namespace

StudySection force_section(std::vector<StudyRow> rows) {
  StudySection section;
  section.id = "forces";
  section.title = "Forces";
  section.words = {
      fmt::format(
          "People grip one vessel, lift it, tilt it and hold it still, under each choice of F_base and F_range: \u201c0.8\u201d is "
          "F_base alone, \u201c0.8-3.8\u201d is F_base to F_base + F_range, in N. The intervals are those of {} people, as many as "
          "in the paper.",
          FORCE_PEOPLE),
      fmt::format(
          "A person has {} attempts. Who loses the grip in {} of them has lost it often, as the paper counts. A grip oscillates "
          "if its force passes its mean from side to side within a second at rest. \u201cOpen 0.5 mm\u201d is the share of people "
          "whose "
          "gripper opened further than this beyond a grasp, and the last column is the mean of the largest such opening.",
          FORCE_ATTEMPTS, OFTEN)};
  section.rows = std::move(rows);
  section.write = write_force_tables;
  return section;
}

std::string force_summary(std::span<const StudyRow> rows) {
  return plain_table(choices_table(rows), 1) + "\n" + plain_table(odds_table(rows), 1) + "\n" + inside_sentence(rows) + "\n";
}

}  // namespace wholehand

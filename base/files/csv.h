// SPDX-License-Identifier: MIT
// Cells of CSV files (RFC 4180).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace wholehand {

// The cell of a text. It is quoted if it has a comma, a quote or a line break. A text that begins (after any apostrophes) with = + - @ or a tab gets
// an apostrophe in front, since a spreadsheet would compute it. Characters that control a terminal are removed (base/text/printable.h), except line
// feeds and tabs. Do not use it for numbers.
std::string csv_text(const std::string& text);

// The cell of a number in nine digits, over `unit`; empty if it is not finite.
std::string csv_number(double value, double unit = 1);

// A row of a file, and the line number (from 1) at which it begins.
struct CsvRow {
  std::size_t line = 1;
  std::vector<std::string> cells;
};

// The rows of a file's text, without empty ones. Accepts either line ending, with or without a byte order mark, and removes csv_text's apostrophe. An
// unclosed quote ends at the end of the text.
std::vector<CsvRow> parse_csv(const std::string& text);

}  // namespace wholehand

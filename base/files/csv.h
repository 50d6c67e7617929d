// SPDX-License-Identifier: MIT
// Cells of CSV files (RFC 4180).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace wholehand {

// The cell of a text: in quotes where a comma, a quote or a line break would end it; with an apostrophe before it where a spreadsheet would compute
// it, as it begins with = + - @ or a tab (after any apostrophes); without what steers a terminal (base/text/printable.h), but with its lines and
// tabs. A
// number is no text.
std::string csv_text(const std::string& text);

// A row of a file, and the line of the file in which it begins, from 1.
struct CsvRow {
  std::size_t line = 1;
  std::vector<std::string> cells;
};

// The rows of a file's text, empty ones left out; with either line end, with or without a byte order mark; without the apostrophe of csv_text. A
// quote that is not closed ends
// with the text.
std::vector<CsvRow> parse_csv(const std::string& text);

}  // namespace wholehand

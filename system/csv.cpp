// SPDX-License-Identifier: MIT
#include "system/csv.h"

namespace wholehand {

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::vector<CsvRow> parse_csv(const std::string& text) {
  std::vector<CsvRow> rows;
  CsvRow row;
  std::string cell;
  std::size_t line = 1;
  bool is_quoted = false;
  const auto end_row = [&] {
    row.cells.push_back(std::move(cell));
    cell.clear();
    if (row.cells.size() > 1 || !row.cells[0].empty()) rows.push_back(std::move(row));
    row = {line + 1, {}};
  };
  for (std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; at < text.size(); ++at) {
    const char c = text[at];
    if (is_quoted) {
      const bool is_doubled = c == '"' && at + 1 < text.size() && text[at + 1] == '"';
      at += is_doubled;
      is_quoted = c != '"' || is_doubled;
      if (is_quoted) cell += c;
    } else if (c == '"' && cell.empty()) {
      is_quoted = true;
    } else if (c == ',') {
      row.cells.push_back(std::move(cell));
      cell.clear();
    } else if (c == '\n') {
      end_row();
    } else if (c != '\r') {
      cell += c;
    }
    line += c == '\n';
  }
  end_row();
  return rows;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "base/files/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "base/text/printable.h"

namespace wholehand {
namespace {

// Whether a spreadsheet would compute what follows the apostrophes of `cell`.
bool is_formula(std::string_view cell) {
  const std::size_t begin = cell.find_first_not_of('\'');
  return begin != cell.npos && std::string_view("=+-@\t").find(cell[begin]) != std::string_view::npos;
}

}  // namespace

std::string csv_text(const std::string& text) {
  const std::string cell = (is_formula(text) ? "'" : "") + printable_lines(text);
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_number(double value, double unit) { return std::isfinite(value) ? fmt::format("{:.9g}", value / unit) : ""; }

std::vector<CsvRow> parse_csv(const std::string& text) {
  std::vector<CsvRow> rows;
  CsvRow row;
  std::string cell;
  std::size_t line = 1;
  bool is_quoted = false;
  const auto end_cell = [&] {
    if (cell.starts_with('\'') && is_formula(cell)) cell.erase(0, 1);
    row.cells.push_back(std::move(cell));
    cell.clear();
  };
  const auto end_row = [&] {
    end_cell();
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
      end_cell();
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

// SPDX-License-Identifier: MIT
// Tables of statistics with their intervals and the paper's values, for any experiment: on the page and on the terminal.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/charts/markup.h"
#include "evidence/studies/row.h"

namespace wholehand {

// Lines of cells; the first has the heads.
using TextTable = std::vector<std::vector<std::string>>;

// For the terminal: the first `names` columns are left-aligned, the others right-aligned.
std::string plain_table(const TextTable& lines, std::size_t names);

// A cell as on the page: a dash of the page's width, and minus signs.
std::string page_text(std::string text);

// The line of inside_sentence, then a table for each vessel in the order of the rows. A column names the subjects if there are any. The row
// inside_share is not shown, because the line states it.
void write_statistic_tables(MarkupWriter& html, std::span<const StudyRow> rows);

// The same for the terminal, in one table.
std::string statistic_table(std::span<const StudyRow> rows);

}  // namespace wholehand

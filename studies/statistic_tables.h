// SPDX-License-Identifier: MIT
// Tables of statistics with their intervals and the paper's values, for any experiment: on the page and on the terminal.
#pragma once

#include <span>
#include <string>

#include "charts/markup.h"
#include "studies/row.h"

namespace wholehand {

// The line of inside_sentence, then a table for each vessel in the order of the rows. A column names the subjects where there are
// any. The row inside_share is not shown, since the line says it.
void write_statistic_tables(MarkupWriter& html, std::span<const StudyRow> rows);

// The same for the terminal, in one table.
std::string statistic_table(std::span<const StudyRow> rows);

}  // namespace wholehand

// Cells of CSV files (RFC 4180).
#pragma once

#include <string>

namespace wholehand {

// In quotes where a comma, a quote or a line break would end the cell.
std::string csv_text(const std::string& text);

}  // namespace wholehand

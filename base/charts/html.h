// SPDX-License-Identifier: MIT
// Parts of an HTML page: tables, and pictures as addresses.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/charts/markup.h"

namespace wholehand {

// A table with header cells of their own scope. Wide ones scroll in a frame of their own, which a keyboard reaches, and not the page.
class HtmlTable {
 public:
  // `caption`: what the table holds, printed above it; `words`: columns that hold words and not numbers.
  HtmlTable(MarkupWriter& html, const std::string& caption, const std::vector<std::string>& columns,
            const std::vector<std::size_t>& words = {});
  // The first cell is the row's header.
  void row(const std::vector<std::string>& cells);
  void end();

 private:
  MarkupWriter::Attributes cell_attributes(std::size_t column, const char* scope) const;

  MarkupWriter& html_;
  std::vector<std::size_t> words_;
};

// An address that is the picture itself.
std::string svg_address(std::string_view svg);

}  // namespace wholehand

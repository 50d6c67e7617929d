// SPDX-License-Identifier: MIT
// Parts of an HTML page: tables, and pictures as data URLs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/charts/markup.h"

namespace wholehand {

// A table whose header cells have a scope. A wide table scrolls in its own frame, which the keyboard can reach; the page does not scroll.
class HtmlTable {
 public:
  // `caption`: the text above the table; `words`: columns that hold words instead of numbers.
  HtmlTable(MarkupWriter& html, const std::string& caption, const std::vector<std::string>& columns,
            const std::vector<std::size_t>& words = {});
  // The first cell is the row header.
  void row(const std::vector<std::string>& cells);
  void end();

 private:
  MarkupWriter::Attributes cell_attributes(std::size_t column, const char* scope) const;

  MarkupWriter& html_;
  std::vector<std::size_t> words_;
};

// A data URL that contains the picture.
std::string svg_address(std::string_view svg);

}  // namespace wholehand

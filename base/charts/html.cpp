// SPDX-License-Identifier: MIT
#include "base/charts/html.h"

#include <algorithm>

#include "base/text/text.h"

namespace wholehand {

HtmlTable::HtmlTable(MarkupWriter& html, const std::string& caption, const std::vector<std::string>& columns,
                     const std::vector<std::size_t>& words)
    : html_(html), words_(words) {
  html_.open("div", {{"class", "wide"}, {"role", "region"}, {"tabindex", "0"}, {"aria-label", caption}});
  html_.open("table").element("caption", caption).open("thead").open("tr");
  for (std::size_t i = 0; i < columns.size(); ++i) html_.element("th", columns[i], cell_attributes(i, "col"));
  html_.close().close().open("tbody");
}

MarkupWriter::Attributes HtmlTable::cell_attributes(std::size_t column, const char* scope) const {
  MarkupWriter::Attributes attributes;
  if (scope) attributes.emplace_back("scope", scope);
  if (std::find(words_.begin(), words_.end(), column) != words_.end()) attributes.emplace_back("class", "word");
  return attributes;
}

void HtmlTable::row(const std::vector<std::string>& cells) {
  html_.open("tr");
  for (std::size_t i = 0; i < cells.size(); ++i)
    html_.element(i == 0 ? "th" : "td", cells[i], cell_attributes(i, i == 0 ? "row" : nullptr));
  html_.close();
}

void HtmlTable::end() { html_.close().close().close(); }

std::string svg_address(std::string_view svg) {
  constexpr std::string_view PLAIN = " !$'()*+,-./:;=?@_~{}|";
  std::string address = "data:image/svg+xml,";
  for (const char c : svg) {
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || PLAIN.find(c) != std::string_view::npos;
    if (is_plain) {
      address += c;
    } else {
      append_formatted(address, "%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return address;
}

}  // namespace wholehand

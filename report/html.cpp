// SPDX-License-Identifier: MIT
#include "report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace wholehand {
namespace {

constexpr const char* REPLACEMENT = "\uFFFD";

// Length of the UTF-8 character at the start of `text`; 0 where there is none, or one that XML does not know.
std::size_t character_length(std::string_view text) {
  const auto byte = [text](std::size_t i) { return i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0u; };
  const std::uint32_t lead = byte(0);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0) return 0;
  std::uint32_t code = length == 1 ? lead : lead & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  const bool is_shortest = length < 3 || code >= (length == 3 ? 0x800u : 0x10000u);
  const bool is_allowed = code == '\t' || code == '\n' || code == '\r' || (code >= 0x20 && code < 0x7F) ||
                          (code >= 0xA0 && code < 0xD800) || (code >= 0xE000 && code < 0xFFFE) ||
                          (code >= 0x10000 && code <= 0x10FFFF);
  return is_shortest && is_allowed ? length : 0;
}

// Whether white space after it would be seen.
bool is_in_line(std::string_view tag) {
  const auto tags = {"a", "b", "code", "span", "strong", "tspan"};
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

}  // namespace

std::string html_escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size() + text.size() / 8);
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    switch (length == 1 ? text.front() : '\0') {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      case '\r':  // both parsers make line feeds of it
        safe += "&#13;";
        break;
      default:
        if (length == 0) {
          safe += REPLACEMENT;
        } else {
          safe += text.substr(0, length);
        }
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return safe;
}

void HtmlWriter::tag(const char* tag, const Attributes& attributes, const char* end) {
  html_ += '<';
  html_ += tag;
  for (const auto& [name, value] : attributes) {
    html_ += ' ';
    html_ += name;
    html_ += "=\"";
    html_ += html_escaped(value);
    html_ += '"';
  }
  html_ += end;
}

HtmlWriter& HtmlWriter::open(const char* name, const Attributes& attributes) {
  tag(name, attributes, ">");
  open_.push_back(name);
  return *this;
}

HtmlWriter& HtmlWriter::close() {
  assert(!open_.empty());
  html_ += "</";
  html_ += open_.back();
  html_ += is_in_line(open_.back()) ? ">" : ">\n";
  open_.pop_back();
  return *this;
}

HtmlWriter& HtmlWriter::text(std::string_view text) {
  html_ += html_escaped(text);
  return *this;
}

HtmlWriter& HtmlWriter::element(const char* name, std::string_view content, const Attributes& attributes) {
  return open(name, attributes).text(content).close();
}

HtmlWriter& HtmlWriter::empty(const char* name, const Attributes& attributes) {
  tag(name, attributes, "/>\n");
  return *this;
}

HtmlWriter& HtmlWriter::markup(std::string_view markup) {
  html_ += markup;
  return *this;
}

HtmlTable::HtmlTable(HtmlWriter& html, const std::string& caption, const std::vector<std::string>& columns,
                     const std::vector<std::size_t>& words)
    : html_(html), words_(words) {
  html_.open("div", {{"class", "wide"}, {"role", "region"}, {"tabindex", "0"}, {"aria-label", caption}});
  html_.open("table").element("caption", caption).open("thead").open("tr");
  for (std::size_t i = 0; i < columns.size(); ++i) html_.element("th", columns[i], cell_attributes(i, "col"));
  html_.close().close().open("tbody");
}

HtmlWriter::Attributes HtmlTable::cell_attributes(std::size_t column, const char* scope) const {
  HtmlWriter::Attributes attributes;
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

std::string html_number(double value, int digits) {
  if (std::isnan(value)) return "\u2013";
  if (std::isinf(value)) return value > 0 ? "\u221E" : "\u2212\u221E";
  std::string text = fmt::format("{:.{}f}", std::abs(value), digits);
  const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !is_zero ? "\u2212" + text : text;
}

std::string html_plain(double value) {
  const std::string text = fmt::format("{:.6g}", std::abs(value));
  return value < 0 && text != "0" ? "\u2212" + text : text;
}

std::string svg_address(std::string_view svg) {
  constexpr std::string_view PLAIN = " !$'()*+,-./:;=?@_~{}|";
  std::string address = "data:image/svg+xml,";
  for (const char c : svg) {
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || PLAIN.find(c) != std::string_view::npos;
    if (is_plain) {
      address += c;
    } else {
      fmt::format_to(std::back_inserter(address), "%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return address;
}

}  // namespace wholehand

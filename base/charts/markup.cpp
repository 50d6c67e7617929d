// SPDX-License-Identifier: MIT
#include "base/charts/markup.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/text/printable.h"
#include "base/text/readable.h"

namespace wholehand {
namespace {

constexpr const char* REPLACEMENT = "\uFFFD";

// Length of the character at the start of `text`; 0 where it is none, or is not shown.
std::size_t character_length(std::string_view text) {
  const Utf8Character character = first_character(text);
  const bool is_layout = character.code == '\t' || character.code == '\n' || character.code == '\r';
  const bool is_known_to_xml = character.code != 0xFFFE && character.code != 0xFFFF;
  return character.is_whole && is_known_to_xml && (is_layout || !is_steering(character.code)) ? character.length : 0;
}

// Whether white space after it would be seen.
bool is_in_line(std::string_view tag) {
  const auto tags = {"a", "b", "code", "span", "strong", "tspan"};
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

}  // namespace

std::string markup_escaped(std::string_view text) {
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

void MarkupWriter::tag(const char* tag, const Attributes& attributes, const char* end) {
  text_ += '<';
  text_ += tag;
  for (const auto& [name, value] : attributes) {
    text_ += ' ';
    text_ += name;
    text_ += "=\"";
    text_ += markup_escaped(value);
    text_ += '"';
  }
  text_ += end;
}

MarkupWriter& MarkupWriter::open(const char* name, const Attributes& attributes) {
  tag(name, attributes, ">");
  open_.push_back(name);
  return *this;
}

MarkupWriter& MarkupWriter::close() {
  assert(!open_.empty());
  text_ += "</";
  text_ += open_.back();
  text_ += is_in_line(open_.back()) ? ">" : ">\n";
  open_.pop_back();
  return *this;
}

MarkupWriter& MarkupWriter::text(std::string_view text) {
  text_ += markup_escaped(text);
  return *this;
}

MarkupWriter& MarkupWriter::element(const char* name, std::string_view content, const Attributes& attributes) {
  return open(name, attributes).text(content).close();
}

MarkupWriter& MarkupWriter::empty(const char* name, const Attributes& attributes) {
  tag(name, attributes, "/>\n");
  return *this;
}

MarkupWriter& MarkupWriter::markup(std::string_view markup) {
  text_ += markup;
  return *this;
}

namespace {

// With a real minus.
std::string with_minus(const std::string& number) { return number.starts_with('-') ? "\u2212" + number.substr(1) : number; }

}  // namespace

std::string shown_number(double value, int digits) {
  if (std::isnan(value)) return "\u2013";
  return with_minus(std::isinf(value) ? (value > 0 ? "\u221E" : "-\u221E") : fixed_text(value, digits));
}

std::string plain_number(double value) { return with_minus(plain_text(value)); }

}  // namespace wholehand

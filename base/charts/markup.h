// SPDX-License-Identifier: MIT
// Writes SVG, and HTML that is also well-formed XML: this file alone closes every element and escapes every text and attribute.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wholehand {

// Escapes text for an element or a quoted attribute: markup characters become references, and what XML cannot hold (control characters, invalid
// UTF-8) becomes U+FFFD.
std::string markup_escaped(std::string_view text);

// Writes elements in order, HTML's and, within an SVG, SVG's. The caller closes what it opens, innermost first.
class MarkupWriter {
 public:
  using Attributes = std::vector<std::pair<const char*, std::string>>;

  MarkupWriter& open(const char* tag, const Attributes& attributes = {});
  MarkupWriter& close();
  MarkupWriter& text(std::string_view text);
  // An element that contains only text.
  MarkupWriter& element(const char* tag, std::string_view text, const Attributes& attributes = {});
  // An element without content, closed in its own tag.
  MarkupWriter& empty(const char* tag, const Attributes& attributes = {});
  // What is markup already.
  MarkupWriter& markup(std::string_view markup);

  const std::string& written() const { return text_; }
  // No element is open.
  bool is_closed() const { return open_.empty(); }

 private:
  void tag(const char* tag, const Attributes& attributes, const char* end);

  std::string text_;
  std::vector<const char*> open_;
};

// "-12.3" with a minus sign as wide as a plus; an en dash for NaN, "∞" for infinity.
std::string shown_number(double value, int digits);

// As short as six digits allow: "0.8", "1,000".
std::string plain_number(double value);

}  // namespace wholehand

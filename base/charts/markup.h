// SPDX-License-Identifier: MIT
// Writes SVG, and HTML that is well-formed XML too: every element is closed, every text and attribute escaped, in this one place.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wholehand {

// Text for an element or a quoted attribute: markup's characters as references; what XML cannot hold (control characters, bytes
// that are no UTF-8) as U+FFFD.
std::string markup_escaped(std::string_view text);

// Elements in their order, HTML's and, in an SVG, SVG's. What is opened must be closed, innermost first.
class MarkupWriter {
 public:
  using Attributes = std::vector<std::pair<const char*, std::string>>;

  MarkupWriter& open(const char* tag, const Attributes& attributes = {});
  MarkupWriter& close();
  MarkupWriter& text(std::string_view text);
  // An element with nothing but text in it.
  MarkupWriter& element(const char* tag, std::string_view text, const Attributes& attributes = {});
  // One that never has anything in it: closed in its own tag.
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

// As short as six figures allow: "0.8", "1,000".
std::string plain_number(double value);

}  // namespace wholehand

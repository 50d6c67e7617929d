// SPDX-License-Identifier: MIT
// Writes HTML that is well-formed XML too: every element is closed, every text and attribute escaped, in this one place.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wholehand {

// Text for an element or a quoted attribute: markup's characters as references; what XML cannot hold (control characters, bytes that are no
// UTF-8) as U+FFFD.
std::string html_escaped(std::string_view text);

// Elements in their order, HTML's and, in an SVG, SVG's. What is opened must be closed, innermost first.
class HtmlWriter {
 public:
  using Attributes = std::vector<std::pair<const char*, std::string>>;

  HtmlWriter& open(const char* tag, const Attributes& attributes = {});
  HtmlWriter& close();
  HtmlWriter& text(std::string_view text);
  // An element with nothing but text in it.
  HtmlWriter& element(const char* tag, std::string_view text, const Attributes& attributes = {});
  // One that never has anything in it: closed in its own tag.
  HtmlWriter& empty(const char* tag, const Attributes& attributes = {});
  // What is markup already.
  HtmlWriter& markup(std::string_view markup);

  const std::string& html() const { return html_; }
  // No element is open.
  bool is_closed() const { return open_.empty(); }

 private:
  void tag(const char* tag, const Attributes& attributes, const char* end);

  std::string html_;
  std::vector<const char*> open_;
};

// A table with header cells of their own scope. Wide ones scroll in a frame of their own, which a keyboard reaches, and not the page.
class HtmlTable {
 public:
  // `caption`: what the table holds, said above it; `words`: columns that hold words and not numbers.
  HtmlTable(HtmlWriter& html, const std::string& caption, const std::vector<std::string>& columns,
            const std::vector<std::size_t>& words = {});
  // The first cell is the row's header.
  void row(const std::vector<std::string>& cells);
  void end();

 private:
  HtmlWriter::Attributes cell_attributes(std::size_t column, const char* scope) const;

  HtmlWriter& html_;
  std::vector<std::size_t> words_;
};

// "-12.3" with a minus sign as wide as a plus; an en dash for NaN, "∞" for infinity.
std::string html_number(double value, int digits);

// As short as six figures allow: "0.8", "1000".
std::string html_plain(double value);

// An address that is the picture itself.
std::string svg_address(std::string_view svg);

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Text from outside that steers nothing.
// sanitizers: address
#include "base/text/printable.h"

#include <gtest/gtest.h>

#include <string>

namespace wholehand {
namespace {

TEST(Printable, NothingThatSteersIsLeft) {
  const std::pair<std::string, std::string> cases[] = {
      {std::string("a\0b", 3), "a\\x00b"},
      {"\x1b[31mred\x1b[0m", "\\x1b[31mred\\x1b[0m"},
      {"a\rb\x7f", "a\\x0db\\x7f"},
      {"\xc2\x80 \xc2\x9b\x33\x31m \xc2\x9f", "\\u0080 \\u009b31m \\u009f"},
      {"\u061c\u200e\u200f\u2028\u2029\u202a\u202e\u2066\u2069", "\\u061c\\u200e\\u200f\\u2028\\u2029\\u202a\\u202e\\u2066\\u2069"},
      {"\x9b", "\\x9b"},                             // of a terminal that takes bytes
      {"\xc3", "\\xc3"},                             // cut off
      {"\xc0\x9b", "\\xc0\\x9b"},                    // longer than it need be
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // half of a pair
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // beyond the last
  };
  for (const auto& [text, shown] : cases) {
    EXPECT_EQ(one_line(text), shown);
    EXPECT_EQ(printable_lines(text), shown);
  }
}

TEST(Printable, WhatIsSeenStays) {
  for (const char* text :
       {"", "a \\x1b", "µ é \u00a0 \u00a1", "漢字", "עברית", "\u2027\u202f\u2065\u206a", "\U0001F95B", "\U0010FFFD"}) {
    EXPECT_EQ(one_line(text), text);
    EXPECT_EQ(printable_lines(text), text);
  }
}

TEST(Printable, LinesStayWhereThereMayBeSome) {
  EXPECT_EQ(printable_lines("a\n\tb\r\n"), "a\n\tb\\x0d\n");
  EXPECT_EQ(one_line("a\n\tb"), "a\\x0a\\x09b");
}

}  // namespace
}  // namespace wholehand

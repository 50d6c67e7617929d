// SPDX-License-Identifier: MIT
#include "base/text/text.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace wholehand {
namespace {

TEST(Text, IsJoined) {
  EXPECT_EQ(joined(std::vector<std::string>(), ", "), "");
  EXPECT_EQ(joined(std::vector<std::string>{"one"}, ", "), "one");
  EXPECT_EQ(joined(std::vector<std::string>{"one", "", "three"}, ", "), "one, , three") << "an empty word is a word";
  EXPECT_EQ(joined(std::array<std::string_view, 2>{"one", "two"}, ""), "onetwo");
  EXPECT_EQ(joined(std::vector<const char*>{"one", "two"}, " and "), "one and two");
  EXPECT_EQ(joined(std::set<std::string>{"b", "a"}, "|"), "a|b");
}

TEST(Text, IsAppended) {
  std::string text = "a";
  append_formatted(text, "b");
  append_formatted(text, " {} {:.2f} {:>4}|", 1, 2.5, "c");
  EXPECT_EQ(text, "ab 1 2.50    c|");
  append_formatted(text, "{}", text);
  EXPECT_EQ(text, "ab 1 2.50    c|ab 1 2.50    c|") << "the text itself may be appended";
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Whether a text is well-formed XML, as far as our own writers go.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace wholehand {

// name, then name="value" any number of times, then perhaps a slash.
inline bool is_tag(const std::string& tag) {
  std::size_t at = 0;
  const auto name = [&] {
    const std::size_t from = at;
    while (at < tag.size() && (std::isalnum(static_cast<unsigned char>(tag[at])) || tag[at] == '-' || tag[at] == ':')) ++at;
    return at > from;
  };
  if (!name()) return false;
  while (at < tag.size() && tag[at] == ' ') {
    ++at;
    if (!name() || tag.compare(at, 2, "=\"") != 0) return false;
    const std::size_t end = tag.find('"', at + 2);
    if (end == std::string::npos || tag.find_first_of("<", at) < end) return false;
    at = end + 1;
  }
  return at == tag.size() || (tag[at] == '/' && at + 1 == tag.size());
}

// Every tag is closed in its order, attributes are quoted, there is no bare '&' and no control character, and there is no number
// that is none.
inline void expect_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  std::size_t at = 0;
  while ((at = xml.find('<', at)) != std::string::npos) {
    const std::size_t end = xml.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag[0] == '?') {
      EXPECT_EQ(at, 0u) << "a declaration stands first";
      at = end;
      continue;
    }
    at = end;
    if (tag[0] == '/') {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(tag.substr(1), open.back());
      open.pop_back();
      continue;
    }
    EXPECT_TRUE(is_tag(tag)) << tag;
    for (const char* number : {"nan", "inf", "-0.00"}) EXPECT_EQ(tag.find(number), std::string::npos) << tag;
    if (!tag.ends_with('/')) open.push_back(tag.substr(0, tag.find(' ')));
  }
  EXPECT_TRUE(open.empty());
  for (std::size_t amp = xml.find('&'); amp != std::string::npos; amp = xml.find('&', amp + 1)) {
    const std::string reference = xml.substr(amp, xml.find(';', amp) - amp + 1);
    const auto known = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;", "&#13;"};
    EXPECT_NE(std::find(known.begin(), known.end(), reference), known.end()) << reference;
  }
  for (const char c : xml) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t');
}

// How often a text has a part.
inline int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace wholehand

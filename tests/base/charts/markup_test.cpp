// SPDX-License-Identifier: MIT
// Markup that cannot be broken by what is written into it.
// sanitizers: address
#include "base/charts/markup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wholehand {
namespace {

TEST(MarkupEscaped, TakesMarkupsCharactersAsText) {
  EXPECT_EQ(markup_escaped("a < b && c > \"d\" 'e'"), "a &lt; b &amp;&amp; c &gt; &quot;d&quot; &#39;e&#39;");
  EXPECT_EQ(markup_escaped("</script><!--"), "&lt;/script&gt;&lt;!--");
  EXPECT_EQ(markup_escaped("&amp;"), "&amp;amp;");
  EXPECT_EQ(markup_escaped(""), "");
}

TEST(MarkupEscaped, KeepsLinesAndEveryCharacterOfUtf8) {
  EXPECT_EQ(markup_escaped("a\n\tb"), "a\n\tb");
  EXPECT_EQ(markup_escaped("a\r\n"), "a&#13;\n");
  for (const char* text : {"µ", "é", "\u00a0", "漢字", "\U0001F95B", "\uE000", "\uFFFD"}) EXPECT_EQ(markup_escaped(text), text);
}

TEST(MarkupEscaped, ReplacesWhatXmlCannotHold) {
  const std::string replacement = "\uFFFD";
  const std::pair<std::string, std::string> cases[] = {
      {std::string("a\0b", 3), "a" + replacement + "b"},
      {"\x01\x1f\x7f", replacement + replacement + replacement},
      {"\xff", replacement},
      {"\xc3", replacement},                    // cut off
      {"\xc3<", replacement + "&lt;"},          // and no markup swallowed
      {"\xc0\x80", replacement + replacement},  // longer than it need be
      {"\xe0\x80\x80", replacement + replacement + replacement},
      {"\xed\xa0\x80", replacement + replacement + replacement},  // half of a pair
      {"\xef\xbf\xbf", replacement + replacement + replacement},  // U+FFFF
      {"\xf5\x80\x80\x80", replacement + replacement + replacement + replacement},
      {"\xc2\x85", replacement + replacement},              // a control character of two bytes
      {"\u202e", replacement + replacement + replacement},  // which turns a line round
  };
  for (const auto& [text, safe] : cases) EXPECT_EQ(markup_escaped(text), safe);
}

TEST(MarkupWriter, ClosesWhatItOpens) {
  MarkupWriter html;
  html.open("div", {{"class", "a \"b\""}}).element("p", "x < y").empty("br").text("&").close();
  EXPECT_EQ(html.written(), "<div class=\"a &quot;b&quot;\"><p>x &lt; y</p>\n<br/>\n&amp;</div>\n");
  EXPECT_TRUE(html.is_closed());
  EXPECT_FALSE(MarkupWriter().open("p").is_closed());
}

TEST(MarkupWriter, PutsNoSpaceAfterWhatStandsInALine) {
  MarkupWriter html;
  html.open("p").text("see ").element("a", "this", {{"href", "#x"}}).text(".").close();
  EXPECT_EQ(html.written(), "<p>see <a href=\"#x\">this</a>.</p>\n");
}

TEST(ShownNumber, HasAMinusSignAndNoNegativeZero) {
  EXPECT_EQ(shown_number(1.25, 1), "1.2");
  EXPECT_EQ(shown_number(-12.34, 1), "\u221212.3");
  EXPECT_EQ(shown_number(-0.04, 1), "0.0");
  EXPECT_EQ(shown_number(-0.0, 0), "0");
  EXPECT_EQ(shown_number(std::nan(""), 2), "\u2013");
  EXPECT_EQ(shown_number(std::numeric_limits<double>::infinity(), 2), "\u221E");
  EXPECT_EQ(shown_number(-std::numeric_limits<double>::infinity(), 2), "\u2212\u221E");
  EXPECT_EQ(plain_number(0.8), "0.8");
  EXPECT_EQ(plain_number(1000), "1,000");
  EXPECT_EQ(plain_number(-90), "\u221290");
  EXPECT_EQ(plain_number(-0.0), "0");
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Markup that cannot be broken by what is written into it.
// sanitizers: address
#include "report/html.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wholehand {
namespace {

TEST(HtmlEscaped, TakesMarkupsCharactersAsText) {
  EXPECT_EQ(html_escaped("a < b && c > \"d\" 'e'"), "a &lt; b &amp;&amp; c &gt; &quot;d&quot; &#39;e&#39;");
  EXPECT_EQ(html_escaped("</script><!--"), "&lt;/script&gt;&lt;!--");
  EXPECT_EQ(html_escaped("&amp;"), "&amp;amp;");
  EXPECT_EQ(html_escaped(""), "");
}

TEST(HtmlEscaped, KeepsLinesAndEveryCharacterOfUtf8) {
  EXPECT_EQ(html_escaped("a\n\tb"), "a\n\tb");
  EXPECT_EQ(html_escaped("a\r\n"), "a&#13;\n");
  for (const char* text : {"µ", "é", "\u00a0", "漢字", "\U0001F95B", "\uE000", "\uFFFD"}) EXPECT_EQ(html_escaped(text), text);
}

TEST(HtmlEscaped, ReplacesWhatXmlCannotHold) {
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
      {"\xc2\x85", replacement + replacement},  // a control character of two bytes
  };
  for (const auto& [text, safe] : cases) EXPECT_EQ(html_escaped(text), safe);
}

TEST(HtmlWriter, ClosesWhatItOpens) {
  HtmlWriter html;
  html.open("div", {{"class", "a \"b\""}}).element("p", "x < y").empty("br").text("&").close();
  EXPECT_EQ(html.html(), "<div class=\"a &quot;b&quot;\"><p>x &lt; y</p>\n<br/>\n&amp;</div>\n");
  EXPECT_TRUE(html.is_closed());
  EXPECT_FALSE(HtmlWriter().open("p").is_closed());
}

TEST(HtmlWriter, PutsNoSpaceAfterWhatStandsInALine) {
  HtmlWriter html;
  html.open("p").text("see ").element("a", "this", {{"href", "#x"}}).text(".").close();
  EXPECT_EQ(html.html(), "<p>see <a href=\"#x\">this</a>.</p>\n");
}

TEST(HtmlTable, HeadersHaveTheirScope) {
  HtmlWriter html;
  HtmlTable table(html, "of <things>", {"thing", "number", "word"}, {2});
  table.row({"a", "1", "x"});
  table.end();
  EXPECT_TRUE(html.is_closed());
  EXPECT_EQ(html.html(),
            "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"of &lt;things&gt;\"><table><caption>of "
            "&lt;things&gt;</caption>\n"
            "<thead><tr><th scope=\"col\">thing</th>\n<th scope=\"col\">number</th>\n<th scope=\"col\" "
            "class=\"word\">word</th>\n</tr>\n</thead>\n"
            "<tbody><tr><th scope=\"row\">a</th>\n<td>1</td>\n<td class=\"word\">x</td>\n</tr>\n</tbody>\n</table>\n</div>\n");
}

TEST(HtmlNumber, HasAMinusSignAndNoNegativeZero) {
  EXPECT_EQ(html_number(1.25, 1), "1.2");
  EXPECT_EQ(html_number(-12.34, 1), "\u221212.3");
  EXPECT_EQ(html_number(-0.04, 1), "0.0");
  EXPECT_EQ(html_number(-0.0, 0), "0");
  EXPECT_EQ(html_number(std::nan(""), 2), "\u2013");
  EXPECT_EQ(html_number(std::numeric_limits<double>::infinity(), 2), "\u221E");
  EXPECT_EQ(html_number(-std::numeric_limits<double>::infinity(), 2), "\u2212\u221E");
  EXPECT_EQ(html_plain(0.8), "0.8");
  EXPECT_EQ(html_plain(1000), "1000");
  EXPECT_EQ(html_plain(-90), "\u221290");
  EXPECT_EQ(html_plain(-0.0), "0");
}

TEST(SvgAddress, DecodesToTheSvg) {
  std::string svg = "<svg a=\"1\">100 % #c µ\n'x' & more</svg>";
  for (int byte = 1; byte < 128; ++byte) svg += static_cast<char>(byte);
  const std::string address = svg_address(svg), head = "data:image/svg+xml,";
  ASSERT_EQ(address.rfind(head, 0), 0u);
  std::string decoded;
  for (std::size_t i = head.size(); i < address.size(); ++i) {
    EXPECT_EQ(std::string("<>\"#\n").find(address[i]), std::string::npos) << "a browser would end or change it here";
    if (address[i] != '%') {
      decoded += address[i];
      continue;
    }
    decoded += static_cast<char>(std::stoi(address.substr(i + 1, 2), nullptr, 16));
    i += 2;
  }
  EXPECT_EQ(decoded, svg);
}

}  // namespace
}  // namespace wholehand

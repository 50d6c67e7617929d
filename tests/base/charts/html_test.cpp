// SPDX-License-Identifier: MIT
// Tables and pictures of a page.
// sanitizers: address
#include "base/charts/html.h"

#include <gtest/gtest.h>

namespace wholehand {
namespace {

TEST(HtmlTable, HeadersHaveTheirScope) {
  MarkupWriter html;
  HtmlTable table(html, "of <things>", {"thing", "number", "word"}, {2});
  table.row({"a", "1", "x"});
  table.end();
  EXPECT_TRUE(html.is_closed());
  EXPECT_EQ(html.written(),
            "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"of &lt;things&gt;\"><table><caption>of "
            "&lt;things&gt;</caption>\n"
            "<thead><tr><th scope=\"col\">thing</th>\n<th scope=\"col\">number</th>\n<th scope=\"col\" "
            "class=\"word\">word</th>\n</tr>\n</thead>\n"
            "<tbody><tr><th scope=\"row\">a</th>\n<td>1</td>\n<td class=\"word\">x</td>\n</tr>\n</tbody>\n</table>\n</div>\n");
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

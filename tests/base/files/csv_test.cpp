// SPDX-License-Identifier: MIT
#include "base/files/csv.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace wholehand {
namespace {

TEST(Csv, CellsAreQuotedWhereTheyMustBe) {
  EXPECT_EQ(csv_text("g++ 12.2.0"), "g++ 12.2.0");
  EXPECT_EQ(csv_text(""), "");
  EXPECT_EQ(csv_text("core, 2 threads"), "\"core, 2 threads\"");
  EXPECT_EQ(csv_text("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csv_text("two\nlines"), "\"two\nlines\"");
}

TEST(Csv, RowsAreReadAsTheyWereWritten) {
  const std::vector<std::string> cells{"a", "", "core, 2 threads", "a \"b\"", "two\nlines", "é", "=1", "-", "'@x"};
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + csv_text(cell);
  for (const std::string& text : {line, line + "\n", "\xEF\xBB\xBF" + line + "\r\n\r\n"}) {
    const auto rows = parse_csv(text);
    ASSERT_EQ(rows.size(), 1u) << text;
    EXPECT_EQ(rows[0].cells, cells) << text;
  }
}

TEST(Csv, NoTextIsAFormula) {
  for (const char* text : {"=1+1", "+1", "-1", "@SUM(A1)", "\tx", "'=1", "''-1"}) {
    EXPECT_EQ(csv_text(text), "'" + std::string(text));
    EXPECT_EQ(parse_csv(csv_text(text))[0].cells[0], text) << "the reader takes it off again";
  }
  EXPECT_EQ(csv_text("=\"a\",b"), "\"'=\"\"a\"\",b\"");
  for (const char* text : {"a=1", "'a", "'", "1-2", " =1"}) EXPECT_EQ(csv_text(text), text);
  EXPECT_EQ(parse_csv("-1.5,'a,+2")[0].cells, (std::vector<std::string>{"-1.5", "'a", "+2"})) << "numbers and others stay";
}

TEST(Csv, NoTextSteersATerminal) { EXPECT_EQ(csv_text("a\x1b[31m\xc2\x9b\xe2\x80\xae\r"), "a\\x1b[31m\\u009b\\u202e\\x0d"); }

TEST(Csv, RowsKnowTheirLines) {
  const auto rows = parse_csv("a,b\n\n\"two\nlines\",c\r\nd");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].line, 1u);
  EXPECT_EQ(rows[1].line, 3u);
  EXPECT_EQ(rows[2].line, 5u);
  EXPECT_TRUE(parse_csv("").empty());
  EXPECT_EQ(parse_csv("\"open,\nend")[0].cells, std::vector<std::string>{"open,\nend"});
}

}  // namespace
}  // namespace wholehand

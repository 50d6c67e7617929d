#include "sweeps/csv.h"

#include <gtest/gtest.h>

namespace wholehand {
namespace {

TEST(Csv, CellsAreQuotedWhereTheyMustBe) {
  EXPECT_EQ(csv_text("g++ 12.2.0"), "g++ 12.2.0");
  EXPECT_EQ(csv_text(""), "");
  EXPECT_EQ(csv_text("core, 2 threads"), "\"core, 2 threads\"");
  EXPECT_EQ(csv_text("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csv_text("two\nlines"), "\"two\nlines\"");
}

}  // namespace
}  // namespace wholehand

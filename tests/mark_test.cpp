#include "sweeps/mark.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

SweepMark some_mark() {
  SweepMark mark;
  mark.identity = {{"scene", "text with \"quotes\"\nand lines"}, {"device", "a"}};
  mark.wall_seconds = 1.0 / 3;
  mark.kernel_seconds = 0.1;
  mark.vessels.resize(2);
  VesselProgress& vessel = mark.vessels[1];
  vessel.done = (std::uint64_t{1} << 40) + 1;
  vessel.best = {{0.1 + 0.2, 7}, {1e-17, ~std::uint64_t{0}}};
  vessel.counts = {11, {1, 2, 3, 4, 5, 6, 7}, 8, 9, 10};
  vessel.heat_map = {1.0 / 7, NAN, 0};
  return mark;
}

TEST(Mark, ComesBackBitForBit) {
  const TemporaryFolder folder;
  save_mark(folder / "m", some_mark());
  SweepMark mark;
  ASSERT_TRUE(load_mark(folder / "m", mark));
  const SweepMark expected = some_mark();
  EXPECT_EQ(mark.identity, expected.identity);
  EXPECT_EQ(mark.wall_seconds, expected.wall_seconds);
  ASSERT_EQ(mark.vessels.size(), 2u);
  EXPECT_EQ(mark.vessels[0].done, 0u);
  const VesselProgress &a = mark.vessels[1], &b = expected.vessels[1];
  EXPECT_EQ(a.done, b.done);
  ASSERT_EQ(a.best.size(), 2u);
  EXPECT_EQ(a.best[0].score, b.best[0].score);
  EXPECT_EQ(a.best[1].score, b.best[1].score);
  EXPECT_EQ(a.best[1].index, b.best[1].index);
  EXPECT_EQ(a.counts.by_reason, b.counts.by_reason);
  EXPECT_EQ(a.counts.blocked, 10u);
  ASSERT_EQ(a.heat_map.size(), 3u);
  EXPECT_EQ(a.heat_map[0], b.heat_map[0]);
  EXPECT_TRUE(std::isnan(a.heat_map[1]));
}

TEST(Mark, MissingIsNoneAndDamagedIsAnError) {
  const TemporaryFolder folder;
  SweepMark mark;
  EXPECT_FALSE(load_mark(folder / "m", mark));
  for (const char* text : {"", "{", "{}", "[1]", R"({"format":2})", R"({"format":1,"identity":3})"}) {
    std::ofstream(folder / "m") << text;
    EXPECT_THROW(load_mark(folder / "m", mark), Error) << text;
  }
}

TEST(Mark, DifferenceIsNamed) {
  const SweepMark mark = some_mark();
  EXPECT_NO_THROW(check_identity("x.partial", mark, mark.identity));
  auto other = mark.identity;
  other["device"] = "b";
  try {
    check_identity("x.partial", mark, other);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_STREQ(error.what(),
                 "--resume: x.partial was begun with another device (\"a\", now \"b\"); ask for the same, or start again "
                 "without --resume");
  }
  other = mark.identity;
  other["new thing"] = "c";
  EXPECT_THROW(check_identity("x.partial", mark, other), Error);
}

}  // namespace
}  // namespace wholehand

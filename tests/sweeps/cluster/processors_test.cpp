// SPDX-License-Identifier: MIT
// Threads of the ranks of a node: no processor counts twice.
#include "sweeps/cluster/processors.h"

#include <gtest/gtest.h>

#include <string>

namespace wholehand::sweeps {
namespace {

// A word a rank, a letter a processor: x may be used.
std::vector<int> dealt(const std::vector<std::string>& words) {
  std::vector<std::vector<bool>> allowed;
  for (const std::string& word : words) {
    allowed.emplace_back();
    for (const char letter : word) allowed.back().push_back(letter == 'x');
  }
  return deal_processors(allowed);
}

using Counts = std::vector<int>;

TEST(Processors, WhoIsBoundAloneHasAllOfThem) {
  EXPECT_EQ(dealt({"xxxx"}), Counts{4});
  EXPECT_EQ(dealt({"x.x."}), Counts{2});
  EXPECT_EQ(dealt({"xx..", "..xx"}), (Counts{2, 2}));
  EXPECT_EQ(dealt({"xxx.", "...x"}), (Counts{3, 1}));
}

TEST(Processors, WhoSharesThemHasAPart) {
  EXPECT_EQ(dealt({"xxxx", "xxxx"}), (Counts{2, 2}));
  EXPECT_EQ(dealt({"xxxx....", "xxxx....", "....xxxx", "....xxxx"}), (Counts{2, 2, 2, 2}));
  EXPECT_EQ(dealt({"xxxx", "xxxx", "xxxx"}), (Counts{2, 1, 1}));
  EXPECT_EQ(dealt({"xxxxxx..", "xxxxxx..", "......xx"}), (Counts{3, 3, 2}));
}

TEST(Processors, WhoMayRunAnywhereLeavesToOthersWhatTheyHaveAlone) {
  EXPECT_EQ(dealt({"xx..", "xxxx"}), (Counts{2, 2}));
  EXPECT_EQ(dealt({"x...", "xxxx"}), (Counts{1, 3}));
  EXPECT_EQ(dealt({"xxxx", "xx..", "..xx"}), (Counts{2, 1, 1}));
}

TEST(Processors, EverybodyHasOne) {
  EXPECT_EQ(dealt({"x", "x", "x"}), (Counts{1, 1, 1}));
  EXPECT_EQ(dealt({"..", "xx"}), (Counts{1, 2}));
  EXPECT_EQ(dealt({"", ""}), (Counts{1, 1}));
  EXPECT_EQ(dealt({}), Counts{});
}

}  // namespace
}  // namespace wholehand::sweeps

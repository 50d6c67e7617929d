// SPDX-License-Identifier: MIT
// Names and texts from outside, for messages.
#include "core/reader/text.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace wholehand {
namespace {

TEST(SceneText, QuotesOnOneLineAndCutsWholeCharacters) {
  EXPECT_EQ(in_quotes("a"), "'a'");
  EXPECT_EQ(in_quotes("a\tb"), "'a\\x09b'");
  EXPECT_EQ(in_quotes(std::string(61, 'a')), "'" + std::string(60, 'a') + "...'");
  EXPECT_EQ(in_quotes(std::string(59, 'a') + "\xc3\xa4"), "'" + std::string(59, 'a') + "...'");
}

TEST(SceneText, FindsTheNearestName) {
  const std::vector<std::string_view> names{"height_mm", "height_fraction", "roll_deg"};
  EXPECT_EQ(nearest_name("hieght_mm", names), "height_mm");
  EXPECT_EQ(nearest_name("roll", names), "roll_deg");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(SceneText, PlainNamesFitFiles) {
  for (const char* name : {"a", "beaker1", "A-b_c.d"}) EXPECT_TRUE(is_plain_name(name)) << name;
  for (const char* name : {"", "1a", "-a", ".a", "a b", "a/b", "\xc3\xa4", "a\n"}) EXPECT_FALSE(is_plain_name(name)) << name;
  EXPECT_TRUE(is_plain_name(std::string(64, 'a')));
  EXPECT_FALSE(is_plain_name(std::string(65, 'a')));
}

TEST(SceneText, GuessesSlipsAndBeginningsOnly) {
  const std::vector<std::string> names{"sweep", "stability", "three_beakers", "--tilt-deg"};
  EXPECT_EQ(did_you_mean("swep", names), " (did you mean 'sweep'?)");
  EXPECT_EQ(did_you_mean("stab", names), " (did you mean 'stability'?)");
  EXPECT_EQ(did_you_mean("--tilt-degs", names), " (did you mean '--tilt-deg'?)");
  EXPECT_EQ(did_you_mean("three-beaker", names), " (did you mean 'three_beakers'?)");
  for (const char* other : {"", "s", "xyzzy", "swoosh", "--roll"}) EXPECT_EQ(did_you_mean(other, names), "") << other;
  EXPECT_EQ(did_you_mean(std::string(1000, 's'), names), "");
  EXPECT_EQ(did_you_mean("swep", std::vector<std::string>()), "");
}

}  // namespace
}  // namespace wholehand

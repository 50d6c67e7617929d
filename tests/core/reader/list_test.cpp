// SPDX-License-Identifier: MIT
#include "core/reader/list.h"

#include <gtest/gtest.h>

#include "core/reader/shipped.h"

namespace wholehand {
namespace {

TEST(SceneList, TakesThePurposeFromTheFirstSentence) {
  EXPECT_EQ(purpose_of_scene("# One beaker of 1.5 mm glass,\n#   held. More is said here.\n[scene]\n"),
            "One beaker of 1.5 mm glass, held");
  EXPECT_EQ(purpose_of_scene("# One beaker.\n[scene]\n# not this"), "One beaker");
  EXPECT_EQ(purpose_of_scene("# One beaker\r\n#\r\n# A second paragraph\r\n"), "One beaker");
  EXPECT_EQ(purpose_of_scene("# one\ttab\n"), "one\\x09tab");
  for (const char* none : {"", "\n# late\n", "[scene]\n", "#\n# late\n", "# ...\n"}) EXPECT_EQ(purpose_of_scene(none), "") << none;
}

TEST(SceneList, HasALineForEachShippedScene) {
  std::vector<std::string> files;
  for (const std::string& name : shipped_scenes()) files.push_back(scenes_dir() + "/" + name + ".toml");
  ASSERT_GE(files.size(), 4u);
  const std::string list = list_scenes(files);
  EXPECT_NE(list.find("mixing_board   tutorial, beaker1, beaker2, beaker3  A live session as in the paper's experiment\n"),
            std::string::npos)
      << list;
  EXPECT_NE(list.find("small          tumbler "), std::string::npos) << list;
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The id of the code that computes, by the script that the build runs, on a copy of its sources.
// sanitizers: none
#include "sweeps/run/code_id.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/files.h"

namespace wholehand::sweeps {
namespace {

TEST(CodeId, ChangesWithEachSourceThatComputesAndWithTheSettings) {
  const TemporaryFolder folder;
  const std::string source = WHOLEHAND_SOURCE_DIR, script = source + "/cmake/code_id.cmake";
  for (const char* file :
       {"core/arm.h", "shaders/score.glsl", "shaders/contact.comp", "sweeps/plan/plan.cpp", "app/commands/main.cpp"}) {
    std::filesystem::create_directories(std::filesystem::path(folder / file).parent_path());
    std::filesystem::copy_file(source + "/" + file, folder / file);
  }
  const auto written = [&](const std::string& settings = "g++ -O3") {
    const std::string out = folder / "id.cpp";
    EXPECT_EQ(std::system(("cmake '-DSOURCE=" + folder.path() + "' -DFOLDERS=core:shaders:sweeps '-DSETTINGS=" + settings +
                           "' '-DOUTPUT=" + out + "' -P '" + script + "'")
                              .c_str()),
              0);
    return file_text(out);
  };
  const std::string before = written();
  EXPECT_NE(before.find("return \"sha1-"), std::string::npos) << before;
  EXPECT_EQ(written(), before);
  EXPECT_NE(written("g++ -O2"), before);
  for (const char* file :
       {"core/arm.h", "shaders/score.glsl", "shaders/contact.comp", "sweeps/plan/plan.cpp", "app/commands/main.cpp"}) {
    const std::string text = file_text(folder / file);
    std::ofstream(folder / file) << text << " ";
    EXPECT_EQ(written() == before, std::string(file).starts_with("app/")) << file;
    std::ofstream(folder / file) << text;
    EXPECT_EQ(written(), before) << file;
  }
  std::filesystem::rename(folder / "core/arm.h", folder / "core/leg.h");
  EXPECT_NE(written(), before) << "its name";
}

TEST(CodeId, IsADigest) {
  const std::string id = code_id();
  EXPECT_EQ(id.substr(0, 5), "sha1-");
  EXPECT_EQ(id.size(), 45u);
  EXPECT_EQ(id.find_first_not_of("0123456789abcdef", 5), std::string::npos) << id;
}

}  // namespace
}  // namespace wholehand::sweeps

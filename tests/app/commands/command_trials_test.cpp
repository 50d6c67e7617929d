// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// The built program with the real engine: one vessel, few grips.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/xml.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

constexpr const char* CUP = R"([scene]
name = "cup"

[[vessel]]
name = "cup"
shape = "cylinder"
diameter_mm = 70
height_mm = 100
wall_mm = 2

[grips]
height_mm = [40, 60]
roll_deg = [-60, -30, 0]

[strength]

[tilts]
deg = [0, 30, 60]
)";

class TrialsCommand : public testing::Test {
 protected:
  void SetUp() override { write_file(folder / "cup.toml", CUP); }

  std::string command(const std::string& scene, const std::string& name, const std::string& more = "") const {
    return "trials " + (folder / scene) + " -o " + (folder / name) + " --grips 3 --best 1 --tilt-deg 0 30 " + more;
  }
  Outcome try_grips(const std::string& scene, const std::string& name, const std::string& more = "") const {
    return run("PROGRAM " + command(scene, name, more) + " 2>&1");
  }
  std::string csv(const std::string& name) const { return file_text(folder / (name + "/trials.csv")); }

  TemporaryFolder folder;
};

TEST_F(TrialsCommand, SameBytesOnAnyThreadsAndResumed) {
  const Outcome one = try_grips("cup.toml", "one", "--threads 1");
  ASSERT_EQ(one.code, 0) << one.output;
  for (const char* name : {"one/trials.nc", "one/trials.html"}) EXPECT_TRUE(file_exists(folder / name)) << name;
  const std::string whole = csv("one");
  EXPECT_EQ(count_of(whole, "\n"), 1 + 4 * 2);
  EXPECT_EQ(count_of(whole, ",best,hand,"), 2);
  ASSERT_EQ(try_grips("cup.toml", "two", "--threads 2").code, 0);
  EXPECT_EQ(csv("two"), whole);

  // ended by a disk without room for trials.nc; and two grips were not tried
  const Outcome full = run("ulimit -f 40; PROGRAM " + command("cup.toml", "cut") + " 2>&1 >" + (folder / "out"));
  EXPECT_EQ(full.code, 3);
  EXPECT_TRUE(has(full.output, "trials.nc: cannot write it")) << full.output;
  EXPECT_EQ(count_of(full.output, "\n"), 1) << full.output;
  const std::string path = folder / "cut/trials.journal", journal = file_text(path);
  std::size_t end = 0;
  for (int line = 0; line < 4; ++line) end = journal.find('\n', end) + 1;
  write_file(path, journal.substr(0, end));
  const Outcome resumed = try_grips("cup.toml", "cut", "--resume --threads 2");
  EXPECT_EQ(resumed.code, 0) << resumed.output;
  EXPECT_TRUE(has(resumed.output, "goes on after 2 of 4 grips")) << resumed.output;
  EXPECT_EQ(csv("cut"), whole);
}

TEST_F(TrialsCommand, TakesTheGripsOfAResult) {
  const Outcome sweep = run("PROGRAM sweep " + (folder / "cup.toml") + " --on core -o " + (folder / "cup.nc") + " 2>&1");
  ASSERT_EQ(sweep.code, 0) << sweep.output;
  const Outcome tried = try_grips("cup.nc", "of_result");
  EXPECT_EQ(tried.code, 0) << tried.output;
  EXPECT_EQ(count_of(csv("of_result"), ",best,hand,"), 2);
  EXPECT_EQ(count_of(csv("of_result"), ",stratified,hand,"), 6);
}

// What a protocol would ignore is refused, and an option that lacks its value does not take the next one.
TEST_F(TrialsCommand, OptionsThatChangeNothingAreRefused) {
  const std::string start = "trials " + (folder / "cup.toml") + " -o " + (folder / "none") + " ";
  expect_error(start + "--protocol six-forces --tilt-deg 0 30", 2, "--tilt-deg: --protocol six-forces tilts nothing");
  expect_error(start + "--protocol six-forces --fill 0.5 1", 2, "--fill: 2 fills are given");
  expect_error(start + "--scatter 4", 2, "--scatter needs [robust], whose deviations it takes");
  expect_error(start + "--scatter 4 --protocol both", 2, "--scatter: pushes are not scattered");
  expect_error(start + "--scatter 4 --mass-kg 1", 2, "--scatter: robust scores are those of the scene's own masses");
  expect_error(start + "--scatter 0", 2, "--scatter");
  expect_error(start + "--fill --quick", 2, "--fill: its value is missing: '--quick' is an option");
  expect_error(start + "--vessel --quick", 2, "--vessel: its value is missing");
  expect_error("trials " + (folder / "cup.toml") + " -o --quick", 2, "its value is missing");
  expect_error(start + "--quick --fill", 2, "--fill");
  EXPECT_FALSE(file_exists(folder / "none"));
  expect_error("trials " + (folder / "cup.toml") + " -o " + (folder / "deep/a/b"), 2,
               (folder / "deep/a") + " is not a directory; create it or name another");
}

// trials.nc is neither what is tried nor what is viewed.
TEST_F(TrialsCommand, ItsAnswerIsNotAResultOfASweep) {
  ASSERT_EQ(try_grips("cup.toml", "one").code, 0);
  const std::string answer = folder / "one/trials.nc";
  for (const std::string& command : {"trials " + answer + " -o " + (folder / "again"), "view " + answer})
    expect_error(command, 2,
                 "is the answer of wholehand trials, and not a result of a sweep; give a result of wholehand sweep, or for "
                 "new trials a scene; wholehand view plays the disagreement-*.nc beside it");
  EXPECT_FALSE(file_exists(folder / "again"));
  EXPECT_TRUE(has(run("PROGRAM view --help 2>&1").output, "`wholehand trials`"));
}

TEST_F(TrialsCommand, WithoutTheEngineThereAreNoFiles) {
  setenv("WHOLEHAND_MUJOCO_LIBRARY", "/nope", 1);
  expect_error(command("cup.toml", "none"), 3, "/nope");
  unsetenv("WHOLEHAND_MUJOCO_LIBRARY");
  EXPECT_FALSE(file_exists(folder / "none"));
}

}  // namespace
}  // namespace wholehand

#endif

// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// wholehand study as it is typed.
#include <gtest/gtest.h>

#include <string>

#include "studies/output.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/xml.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

class StudyCommand : public testing::Test {
 protected:
  Outcome study(const std::string& name, const std::string& more) const {
    return run("PROGRAM study mixing_board -o " + (folder / name) + " --people 40 " + more + " 2>&1");
  }
  std::string csv(const std::string& name) const { return file_text(folder / (name + "/study.csv")); }
  TemporaryFolder folder;
};

TEST_F(StudyCommand, SameBytesOnAnyThreads) {
  const Outcome one = study("one", "--threads 1");
  ASSERT_EQ(one.code, 0) << one.output;
  EXPECT_TRUE(csv("one").starts_with(STUDY_CSV_START));
  EXPECT_TRUE(has(csv("one"), "\ncontacts,articulated,beaker2,point_biserial_height,middle_dip,")) << csv("one").substr(0, 2000);
  ASSERT_EQ(study("two", "--threads 2 --experiment contacts").code, 0);
  EXPECT_EQ(csv("two"), csv("one"));
  EXPECT_EQ(file_text(folder / "two/study.html"), file_text(folder / "one/study.html"));
  EXPECT_TRUE(file_exists(folder / "one/study.nc"));
  EXPECT_FALSE(file_exists(folder / "one/study.lock"));
  // its own files are replaced
  ASSERT_EQ(study("two", "--seed 2").code, 0);
  EXPECT_NE(csv("two"), csv("one"));
}

TEST_F(StudyCommand, ThePageIsWellFormed) {
  ASSERT_EQ(study("one", "").code, 0);
  const std::string page = file_text(folder / "one/study.html"), start = "<!DOCTYPE html>\n";
  ASSERT_TRUE(page.starts_with(start));
  expect_well_formed(page.substr(start.size()));
}

TEST_F(StudyCommand, WhatIsWrongIsOneLine) {
  const std::string start = "study mixing_board -o " + (folder / "none") + " ";
  expect_error(start + "--people 0", 2, "--people '0'; allowed: a whole number, 1 to 100000000");
  expect_error(start + "--people many", 2, "--people 'many'");
  expect_error(start + "--experiment forces", 2, "--experiment forces: this experiment is not there yet; ask for contacts");
  expect_error(start + "--experiment sessions", 2, "--experiment sessions: this experiment is not there yet; ask for contacts");
  expect_error(start + "--experiment 'x y'", 2, "--experiment 'x y'; allowed: contacts or all");
  expect_error("study three_beakers -o " + (folder / "none"), 2, "no vessel has guidance points");
  expect_error("study mixing_board", 2, "-o");
  expect_error("study nowhere.toml -o " + (folder / "none"), 2, "no scene file 'nowhere.toml'");
  EXPECT_FALSE(file_exists(folder / "none"));
  write_file(folder / "bad.toml",
             "[people]\nscatter = -1\n[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\n"
             "height_mm = 110\nwall_mm = 2\nguidance_mm = [[50, 0]]\n");
  expect_error("study " + (folder / "bad.toml") + " -o " + (folder / "none"), 2, "scatter");
}

// What is there and is not of a study stays.
TEST_F(StudyCommand, OverwritesOnlyItsOwn) {
  std::filesystem::create_directory(folder / "taken");
  write_file(folder / "taken/study.csv", "mine\n");
  expect_error("study mixing_board --people 2 -o " + (folder / "taken"), 2, "study.csv");
  EXPECT_EQ(csv("taken"), "mine\n");
}

}  // namespace
}  // namespace wholehand

#endif

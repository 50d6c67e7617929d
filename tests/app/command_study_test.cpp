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
    return run("PROGRAM study mixing_board -o " + (folder / name) + " --experiment contacts --people 40 " + more + " 2>&1");
  }
  std::string csv(const std::string& name) const { return file_text(folder / (name + "/study.csv")); }
  TemporaryFolder folder;
};

TEST_F(StudyCommand, SameBytesOnAnyThreads) {
  const Outcome one = study("one", "--threads 1");
  ASSERT_EQ(one.code, 0) << one.output;
  EXPECT_TRUE(csv("one").starts_with(STUDY_CSV_START));
  EXPECT_TRUE(has(csv("one"), "\ncontacts,articulated,beaker2,point_biserial_height,middle_dip,")) << csv("one").substr(0, 2000);
  ASSERT_EQ(study("two", "--threads 2").code, 0);
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

// One vessel that is poured from, so that a session takes a third of its time.
std::string one_beaker_file(const TemporaryFolder& folder) {
  const std::string path = folder / "one.toml";
  write_file(path,
             "[scene]\nname = \"one\"\n[[vessel]]\nname = \"beaker\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\n"
             "wall_mm = 1.5\nliquid = { name = \"red\", fill = 0.6 }\nguidance_mm = [[65, 0]]\n[liquid]\ndensity_kg_m3 = 1000\nfills = [0.6]\n"
             "[task]\ntarget = { place_mm = [0, 80, -280], diameter_mm = 120 }\namounts_ml = { red = 60 }\ntolerance_ml = 5\n");
  return path;
}

TEST_F(StudyCommand, ForcesAndSessionsAreTheSameOnAnyThreads) {
  const std::string start = "PROGRAM study " + one_beaker_file(folder) + " --people 4 --quick -o " + (folder / "");
  const Outcome one = run(start + "one --threads 1 2>&1");
  ASSERT_EQ(one.code, 0) << one.output;
  ASSERT_EQ(run(start + "two --threads 3 2>&1").code, 0);
  EXPECT_EQ(csv("one"), csv("two"));
  EXPECT_EQ(file_text(folder / "one/study.html"), file_text(folder / "two/study.html"));
  for (const char* row :
       {"\ncontacts,paper,beaker,held_share,", "\nforces,,beaker,lost_share,0.8-3.8,", "\nsessions,,all,response_time_mean,,",
        "\nsessions,,beaker,normal_increase_mean,,", "\nsessions,,all,first_order_of_response_time,reaction_s,"})
    EXPECT_TRUE(has(csv("one"), row)) << row;
  const std::string page = file_text(folder / "one/study.html"), doctype = "<!DOCTYPE html>\n";
  ASSERT_TRUE(page.starts_with(doctype));
  expect_well_formed(page.substr(doctype.size()));
  EXPECT_TRUE(has(page, "Increase of the normal force over the tilt"));
  EXPECT_FALSE(file_exists(folder / "one/study.journal")) << "it is done";
}

// Stopped when the journal has somebody: nothing is half written, and what is done is not done again.
TEST_F(StudyCommand, GoesOnWhereItWasInterrupted) {
  const std::string scene = one_beaker_file(folder), journal = folder / "cut/study.journal";
  const std::string start = "PROGRAM study " + scene + " --experiment sessions --quick --threads 1 ";
  ASSERT_EQ(run(start + "--people 3 -o " + (folder / "whole") + " 2>&1").code, 0);
  // a line for the format, one for what is asked, and one for the first person
  const Outcome cut = run(start + "--people 100000 -o " + (folder / "cut") + " 2>&1 & PID=$!; while [ \"$(wc -l <" + journal +
                          " 2>/dev/null || echo 0)\" -lt 3 ]; do sleep 0.05; done; kill -TERM $PID; wait $PID");
  EXPECT_EQ(cut.code, 130) << cut.output;
  EXPECT_TRUE(has(cut.output, "Go on with --resume")) << cut.output;
  EXPECT_FALSE(file_exists(folder / "cut/study.csv"));
  EXPECT_TRUE(file_exists(journal));
  expect_error("study " + scene + " --experiment sessions --seed 2 --people 3 --resume -o " + (folder / "cut"), 2, "another seed");
  const Outcome resumed = run(start + "--people 3 --resume -o " + (folder / "cut") + " 2>&1");
  ASSERT_EQ(resumed.code, 0) << resumed.output;
  EXPECT_TRUE(has(resumed.output, "goes on")) << resumed.output;
  EXPECT_EQ(csv("cut"), csv("whole"));
  EXPECT_FALSE(file_exists(journal));
}

TEST_F(StudyCommand, WhatIsWrongIsOneLine) {
  const std::string start = "study mixing_board -o " + (folder / "none") + " ";
  expect_error(start + "--people 0", 2, "--people '0'; allowed: a whole number, 1 to 100000000");
  expect_error(start + "--people many", 2, "--people 'many'");
  expect_error(start + "--experiment 'x y'", 2, "--experiment 'x y'; allowed: contacts, forces, sessions or all");
  expect_error(start + "--experiment sessions --people 100001", 2, "--people 100001; allowed: 1 to 100000 with forces or sessions");
  expect_error("study three_beakers -o " + (folder / "none"), 2, "no vessel has guidance points");
  expect_error("study three_beakers --experiment sessions -o " + (folder / "none"), 2, "sessions need a task");
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

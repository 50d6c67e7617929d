// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// wholehand session --study as it is typed.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/files/csv.h"
#include "device/recordings/recording.h"
#include "evidence/studies/output.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/xml.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

// The simulated user's session, at 500 and at 1000 Hz. Each is recorded once for all tests, as nothing changes them.
class SessionCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    recordings_ = new TemporaryFolder;
    for (const char* rate : {"500", "1000"}) {
      const Outcome live = run(std::string("PROGRAM live mixing_board --no-clock --device sim --rate ") + rate + " --record " +
                               recorded(rate) + " 2>&1");
      ASSERT_EQ(live.code, 0) << live.output;
    }
  }
  static void TearDownTestSuite() {
    delete recordings_;
    recordings_ = nullptr;
  }
  static std::string recorded(const std::string& rate) { return *recordings_ / ("at_" + rate + ".nc"); }
  static std::string both() { return recorded("500") + " " + recorded("1000"); }

  // A recording of two ticks.
  std::string small(const std::string& name, const std::string& vessel, const std::string& scene_text,
                    std::optional<std::uint64_t> person = {}) const {
    device::RecordingInfo info;
    info.person = person;
    info.scene_text = scene_text;
    info.device.name = "omega.7";
    info.vessels = {{vessel, "", 2}};
    const std::string path = folder / name;
    device::RecordingWriter writer(path, info);
    std::vector<device::Tick> ticks(2);
    ticks[1].number = 1;
    writer.append(ticks);
    writer.finish({});
    return path;
  }

  TemporaryFolder folder;

 private:
  static inline TemporaryFolder* recordings_ = nullptr;
};

const std::string GLASS_SCENE =
    "[[vessel]]\nname = \"glass\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n";

std::vector<std::string> cells_of(const std::string& csv, const std::string& start) {
  for (const CsvRow& row : parse_csv(csv)) {
    std::string line;
    for (const std::string& cell : row.cells) line += cell + ",";
    if (line.starts_with(start)) return row.cells;
  }
  ADD_FAILURE() << "no row " << start;
  return std::vector<std::string>(10);
}

TEST_F(SessionCommand, StudiesRecordings) {
  const std::string out = folder / "out";
  const Outcome study = run("PROGRAM session " + both() + " --study -o " + out + " 2>&1");
  ASSERT_EQ(study.code, 0) << study.output;
  EXPECT_TRUE(study.output.starts_with("2 recordings of people; grasps beaker1: 2, beaker2: 2, beaker3: 2\n")) << study.output;
  EXPECT_TRUE(has(study.output, "response time, mean (s)")) << study.output;
  EXPECT_TRUE(has(study.output, "Intervals need 3 recordings or more.\n")) << study.output;
  EXPECT_TRUE(has(study.output,
                  "needs 5 grasps in all beyond the first at each vessel and shown point, in one or more recordings of a person; "
                  "there are 0\n"))
      << "one grasp of each vessel";
  const std::string csv = file_text(out + "/study.csv");
  ASSERT_TRUE(csv.starts_with(STUDY_CSV_START));
  // the beaker's increase of the normal force, as `session` reports it of each recording: 0.158 N at 500 Hz
  const auto increase = cells_of(csv, "sessions,,beaker1,normal_increase_mean,");
  EXPECT_NEAR(std::stod(increase.at(5)), 0.158, 0.02) << "of two sessions at two rates";
  EXPECT_EQ(increase.at(6), "");
  EXPECT_EQ(increase.at(8), "0.56");
  EXPECT_EQ(cells_of(csv, "sessions,,all,tilt_time_mean,").at(8), "")
      << "both are of the simulated gripper, whose user tilts as fast as the paper's people";
  EXPECT_EQ(cells_of(csv, "sessions,,all,lost_share,").at(5), "0");
  EXPECT_FALSE(has(csv, "tutorial"));
  const std::string page = file_text(out + "/study.html"), start = "<!DOCTYPE html>\n";
  ASSERT_TRUE(page.starts_with(start));
  expect_well_formed(page.substr(start.size()));
  EXPECT_TRUE(has(page, "2 recorded sessions"));
  EXPECT_TRUE(has(page, "<h2 id=\"answer\">"));
  EXPECT_TRUE(file_exists(out + "/study.nc"));
  EXPECT_FALSE(file_exists(out + "/study.lock"));
  const std::vector<CsvRow> grasps = parse_csv(file_text(out + "/grasps.csv"));
  ASSERT_GE(grasps.size(), 7u) << "two people with three vessels each, and others";
  EXPECT_EQ(grasps[1].cells.at(4), "0");
  EXPECT_EQ(grasps.back().cells.at(4), "1");
  EXPECT_EQ(grasps.back().cells.at(5), "") << "the person's sex is not known";
  EXPECT_FALSE(file_exists(out + "/people.csv"));
  // over its own files
  EXPECT_EQ(run("PROGRAM session " + recorded("500") + " --study --seed 3 -o " + out + " 2>&1").code, 0);
  EXPECT_TRUE(has(file_text(out + "/study.html"), "1 recorded session,"));
}

TEST_F(SessionCommand, FourRecordingsHaveIntervals) {
  // two more people, who did the same
  std::filesystem::copy_file(recorded("500"), folder / "third.nc");
  std::filesystem::copy_file(recorded("500"), folder / "fourth.nc");
  const std::string four = both() + " " + (folder / "third.nc") + " " + (folder / "fourth.nc");
  const Outcome study = run("PROGRAM session " + four + " --study 2>&1");
  ASSERT_EQ(study.code, 0) << study.output;
  EXPECT_TRUE(study.output.starts_with("4 recordings")) << study.output;
  EXPECT_TRUE(has(study.output, " statistics of the paper are inside their intervals.")) << study.output;
  EXPECT_TRUE(has(study.output, "\nThe intervals of fewer than 50 people are too narrow")) << study.output;
  EXPECT_FALSE(has(study.output, "Intervals need")) << study.output;
  EXPECT_EQ(run("PROGRAM session " + four + " --study --seed 1 2>&1").output, study.output) << "seed 1 is the default";
}

// One grasp of each vessel in a recording tells no scatter, grasps of three recordings do.
TEST_F(SessionCommand, RecordingsOfOnePersonGiveTheirScatter) {
  std::string days = recorded("500");
  for (const std::string day : {"2", "3"}) {
    const std::string recording = folder / (day + ".nc");
    const Outcome live =
        run("PROGRAM live mixing_board --no-clock --device sim --rate 500 --seed " + day + " --record " + recording + " 2>&1");
    ASSERT_EQ(live.code, 0) << live.output;
    days += " " + recording;
    const Outcome scatter = run("PROGRAM session " + days + " 2>&1");
    ASSERT_EQ(scatter.code, 0) << scatter.output;
    if (day == "2") {
      EXPECT_TRUE(scatter.output.ends_with("; there are 4\n")) << scatter.output;
      continue;
    }
    EXPECT_TRUE(scatter.output.starts_with("[robust]  # scatter of 12 grasps of 4 vessels, with 95 % intervals")) << scatter.output;
    write_file(folder / "glass.toml", GLASS_SCENE + scatter.output);
    EXPECT_EQ(run("PROGRAM grip " + (folder / "glass.toml") + " --vessel glass --height-mm 60 2>&1").code, 0);
  }
}

// A recording that is not whole counts as far as it goes, with a note.
TEST_F(SessionCommand, NotesOfPartialRecordings) {
  const std::string cut = folder / "cut.nc";
  std::filesystem::copy_file(recorded("500"), cut);
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) - 1000);
  const Outcome notes = run("PROGRAM session " + recorded("500") + " " + cut + " --study 2>&1 >/dev/null");
  EXPECT_EQ(notes.code, 0);
  EXPECT_TRUE(notes.output.starts_with("wholehand: " + cut + " is cut off: ")) << notes.output;
}

TEST_F(SessionCommand, WhatIsWrongIsOneLine) {
  expect_error("session " + recorded("500") + " " + recorded("500") + " --study", 2, "is named twice");
  const std::string glass = small("glass.nc", "glass", GLASS_SCENE), jug = small("jug.nc", "jug", GLASS_SCENE);
  expect_error("session " + glass + " " + jug + " --study -o " + (folder / "none"), 2,
               jug + ": its vessels or their liquids are not those of " + glass);
  expect_error("session " + glass + " " + recorded("500") + " --study", 2, recorded("500") + ": its vessels");
  expect_error("session " + glass + " /nonexistent.nc --study -o " + (folder / "none"), 2, "/nonexistent.nc: cannot be read");
  expect_error("session --study", 2, "recording is required");
  expect_error("session " + glass + " " + jug, 2, jug + ": its vessels or their liquids are not those of " + glass);
  const std::string left = small("left.nc", "glass", GLASS_SCENE + "[hand]\nhandedness = \"left\"\n");
  expect_error("session " + glass + " " + left, 2, left + ": is of the other hand than " + glass);
  const std::string ann = small("ann.nc", "glass", GLASS_SCENE, 1), bob = small("bob.nc", "glass", GLASS_SCENE, 2);
  expect_error("session " + ann + " " + bob, 2, bob + ": is not of the same person as " + ann);
  expect_error("session " + both(), 2, recorded("1000") + ": is of the same session as " + recorded("500"));
  expect_error("session " + glass + " " + small("copy.nc", "glass", GLASS_SCENE, 1), 2,
               "copy.nc: is not of the same person as " + glass);
  expect_error("session " + glass + " " + glass, 2, "is named twice; each recording counts once");
  expect_error("session " + both() + " --json", 2, "several recordings, of one person, give the scatter of the grips alone");
  expect_error("session " + both() + " -o " + (folder / "none"), 2, "--json and -o go with one recording");
  expect_error("session " + glass + " --study --json", 2, "--json: goes without --study");
  expect_error("session " + glass + " --seed 2", 2, "--seed: goes with --study");
  expect_error("session " + glass + " --study --seed x", 2, "--seed 'x'");
  expect_error("session " + small("bare.nc", "glass", "") + " --study", 2, "bare.nc: the recording has no scene");
  expect_error("session " + small("bad.nc", "glass", "x = 1\n") + " --study", 2, "bad.nc:1:1");
  EXPECT_FALSE(file_exists(folder / "none"));
  std::filesystem::create_directory(folder / "taken");
  write_file(folder / "taken/study.csv", "mine\n");
  expect_error("session " + glass + " --study -o " + (folder / "taken"), 2, "study.csv");
  EXPECT_EQ(file_text(folder / "taken/study.csv"), "mine\n");
}

// Nobody grasped anything: no number, and no failure.
TEST_F(SessionCommand, WithoutGraspsThereAreNoNumbers) {
  const Outcome study = run("PROGRAM session " + small("glass.nc", "glass", GLASS_SCENE) + " --study 2>&1");
  EXPECT_EQ(study.code, 0) << study.output;
  EXPECT_TRUE(study.output.starts_with("1 recording of people; grasps glass: 0\n")) << study.output;
  EXPECT_TRUE(has(study.output, "No statistic has both an interval and a value of the paper.")) << study.output;
}

}  // namespace
}  // namespace wholehand

#endif

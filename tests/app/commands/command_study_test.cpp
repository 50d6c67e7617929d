// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// wholehand study as it is typed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/files/csv.h"
#include "evidence/studies/output.h"
#include "evidence/studies/words.h"
#include "sweeps/plan/variables.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/result_reader.h"
#include "tests/support/xml.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

class StudyCommand : public testing::Test {
 protected:
  Outcome study(const std::string& name, const std::string& more) const {
    const std::string people = has(more, "--people") ? "" : " --people 40";
    return run("PROGRAM study mixing_board -o " + (folder / name) + " --experiment contacts --quick " + more + people + " 2>&1");
  }
  std::string csv(const std::string& name) const { return file_text(folder / (name + "/study.csv")); }
  TemporaryFolder folder;
};

// 1,100 people: more than wait to be counted at a time.
TEST_F(StudyCommand, SameBytesOnAnyThreads) {
  const Outcome one = study("one", "--threads 1 --people 1100");
  ASSERT_EQ(one.code, 0) << one.output;
  EXPECT_TRUE(csv("one").starts_with(STUDY_CSV_START));
  EXPECT_TRUE(has(csv("one"), "\ncontacts,articulated,beaker2,point_biserial_height,middle_dip,")) << csv("one").substr(0, 2000);
  ASSERT_EQ(study("two", "--threads 2 --people 1100").code, 0);
  EXPECT_EQ(csv("two"), csv("one"));
  EXPECT_EQ(file_text(folder / "two/study.html"), file_text(folder / "one/study.html"));
  for (const std::string name : {"grasps.csv", "people.csv"})
    EXPECT_EQ(file_text(folder / ("two/" + name)), file_text(folder / ("one/" + name))) << name;
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
             "wall_mm = 1.5\nliquid = { name = \"red\", fill = 0.6 }\nguidance_mm = [[65, 0]]\n[liquid]\ndensity_kg_m3 = "
             "1000\nfills = [0.6]\n"
             "[task]\ntarget = { place_mm = [0, 80, -280], diameter_mm = 120 }\namounts_ml = { red = 60 }\ntolerance_ml = "
             "5\ndestination_mm = [0, 0, -280]\n");
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

// Two people with and without advice: results are the same on any threads, and one row of each number says what advice changes.
TEST_F(StudyCommand, AdviceIsTheSameOnAnyThreads) {
  const std::string scene = one_beaker_file(folder), weak = folder / "weak.toml";
  write_file(weak, file_text(scene) + "[strength]\nefforts = false\n");
  const std::string start = "PROGRAM study " + scene + " --experiment advice --people 2 --quick -o " + (folder / "");
  const Outcome one = run(start + "one --threads 1 2>&1");
  ASSERT_EQ(one.code, 0) << one.output;
  ASSERT_EQ(run(start + "two --threads 2 2>&1").code, 0);
  EXPECT_EQ(csv("one"), csv("two"));
  for (const char* row :
       {"\nadvice,,all,lost_share,difference,", "\nadvice,,all,effort_mean,with,", "\nadvice,,all,time_mean,without,"})
    EXPECT_TRUE(has(csv("one"), row)) << csv("one");
  EXPECT_TRUE(has(one.output, "Effort: ")) << one.output;
  const std::string page = file_text(folder / "one/study.html"), doctype = "<!DOCTYPE html>\n";
  ASSERT_TRUE(page.starts_with(doctype));
  expect_well_formed(page.substr(doctype.size()));
  expect_error("study " + weak + " --experiment advice -o " + (folder / "no"), 2, "leave efforts = false out");
}

// Stopped when the journal has somebody: nothing is half written, and what is done is not done again.
TEST_F(StudyCommand, GoesOnWhereItWasInterrupted) {
  const std::string scene = one_beaker_file(folder), journal = folder / "cut/study.journal";
  const std::string start = "PROGRAM study " + scene + " --experiment sessions --quick --threads 1 ";
  ASSERT_EQ(run(start + "--people 3 -o " + (folder / "whole") + " 2>&1").code, 0);
  // a line for the format, one for what is asked, and one for the first person
  const Outcome cut = run(start + "--people 100000 -o " + (folder / "cut") + " 2>&1 & PID=$!; while [ \"$(wc -l <" + journal +
                          " 2>/dev/null || echo 0)\" -lt 3 ] && kill -0 $PID; do sleep 0.05; done; kill -TERM $PID; wait $PID");
  EXPECT_EQ(cut.code, 130) << cut.output;
  EXPECT_TRUE(has(cut.output, "Go on with --resume")) << cut.output;
  EXPECT_TRUE(file_exists(journal));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cut"))
    EXPECT_EQ(entry.path().filename(), "study.journal") << "nothing is half written";
  expect_error("study " + scene + " --experiment sessions --seed 2 --people 3 --resume -o " + (folder / "cut"), 2, "another seed");
  const Outcome resumed = run(start + "--people 3 --resume -o " + (folder / "cut") + " 2>&1");
  ASSERT_EQ(resumed.code, 0) << resumed.output;
  EXPECT_TRUE(has(resumed.output, "goes on")) << resumed.output;
  for (const std::string name : {"study.csv", "grasps.csv", "people.csv"})
    EXPECT_EQ(file_text(folder / ("cut/" + name)), file_text(folder / ("whole/" + name))) << name;
  EXPECT_GT(parse_csv(file_text(folder / "cut/grasps.csv")).size(), 3u);
  EXPECT_FALSE(file_exists(journal));
}

// "" is a number that is not there.
double number_of_cell(const std::string& cell) { return cell.empty() ? std::nan("") : std::stod(cell); }

TEST_F(StudyCommand, TheDatasetHasTheRowsOfTheTable) {
  ASSERT_EQ(study("one", "--seed 3").code, 0);
  const std::string nc = folder / "one/study.nc";
  std::vector<CsvRow> rows = parse_csv(csv("one"));
  const std::vector<std::string> columns = rows.front().cells;
  rows.erase(rows.begin());
  ASSERT_GT(rows.size(), 800u);
  std::size_t empty = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const bool is_text = c < 5 || columns[c] == "unit", is_measured = columns[c] == "off" || (c >= 5 && c < 9);
    EXPECT_EQ(dimension_names(nc, columns[c]), std::vector<std::string>{"row"});
    if (is_measured) {
      EXPECT_EQ(read_text(nc, columns[c], "ancillary_variables"), "unit") << columns[c];
    }
    const std::vector<std::string> texts = is_text ? read_strings(nc, columns[c]) : std::vector<std::string>{};
    const std::vector<double> numbers = is_text ? std::vector<double>{} : read_values(nc, columns[c]);
    ASSERT_EQ(texts.size() + numbers.size(), rows.size()) << columns[c];
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const std::string& cell = rows[k].cells[c];
      empty += c >= 5 && c < 10 && cell.empty() ? 1 : 0;
      if (is_text) {
        EXPECT_EQ(texts[k], cell) << columns[c] << " " << k;
      } else if (columns[c] == "inside") {
        EXPECT_EQ(numbers[k], sweeps::MISSING) << "the paper's values are not known";
      } else if (cell.empty()) {
        EXPECT_TRUE(std::isnan(numbers[k])) << columns[c] << " " << k;
      } else {
        EXPECT_EQ(numbers[k], number_of_cell(cell)) << columns[c] << " " << k;
      }
    }
  }
  EXPECT_GT(empty, 2 * rows.size()) << "those of the paper, and some more";
  EXPECT_EQ(read_text(nc, "people", "units"), "1");
  EXPECT_EQ(read_text(nc, "grasps", "units"), "1");
  const std::vector<std::string> words = read_strings(nc, "word");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const bool is_correlation = has(rows[k].cells[3], "pearson") || has(rows[k].cells[3], "biserial");
    EXPECT_EQ(words[k], is_correlation ? word_of_correlation(number_of_cell(rows[k].cells[5])) : "") << k;
  }
  EXPECT_EQ(read_text(nc, "", "people_contacts"), "40");
  EXPECT_EQ(read_text(nc, "", "seed"), "3");
  EXPECT_TRUE(has(read_text(nc, "", "scene"), "guidance_mm"));
}

// The line of a table of the page: a row of study.csv, rounded, and in words.
TEST_F(StudyCommand, ThePageShowsTheNumbersOfTheTable) {
  ASSERT_EQ(study("one", "").code, 0);
  const std::string page = file_text(folder / "one/study.html");
  EXPECT_TRUE(has(page, "40 virtual people with 8 grasps each, and 200 samples of the paper")) << page.substr(0, 2000);
  EXPECT_TRUE(has(page, "The intervals of fewer than 50 people are too narrow"));
  const auto shown = [](double value) { return (value < 0 ? "\u2212" : "") + fmt::format("{:.2f}", std::abs(value)); };
  std::set<std::string> words;
  std::size_t found = 0;
  for (const CsvRow& row : parse_csv(csv("one"))) {
    if (!row.cells[3].starts_with("point_biserial") || row.cells[5].empty() || row.cells[6].empty()) continue;
    const double value = number_of_cell(row.cells[5]);
    if (std::abs(value) < 0.01) continue;  // "-0.00" is shown without the sign
    const std::string word = word_of_correlation(value);
    words.insert(word);
    const std::string text = (word == "-" ? "\u2013" : word) + ", " + shown(value) + " (";
    EXPECT_TRUE(has(page, text)) << text;
    ++found;
  }
  EXPECT_GT(found, 90u) << "of 40 people, some of whose samples have a correlation without value";
  EXPECT_GE(words.size(), 4u);
  EXPECT_TRUE(has(page, ">never touches<"));
  EXPECT_TRUE(has(page, ">always touches<"));
}

TEST_F(StudyCommand, WhatIsWrongIsOneLine) {
  const std::string start = "study mixing_board -o " + (folder / "none") + " ";
  expect_error(start + "--people 0", 2, "--people '0'; allowed: a whole number, 1 to 100000000");
  expect_error(start + "--people many", 2, "--people 'many'");
  expect_error(start + "--experiment 'x y'", 2, "--experiment 'x y'; allowed: contacts, forces, sessions, advice or all");
  expect_error(start + "--experiment contacts --resume", 2, "--resume: contacts take seconds");
  expect_error(start + "--experiment sessions --people 100001", 2,
               "--people 100001; allowed: 1 to 100000 with forces, sessions or advice");
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

// Files in the folder that are not of a study stay.
TEST_F(StudyCommand, OverwritesOnlyItsOwn) {
  for (const std::string name : {"study.csv", "study.nc", "study.html", "grasps.csv", "people.csv"}) {
    std::filesystem::create_directory(folder / ("of_" + name));
    write_file(folder / ("of_" + name + "/" + name), "mine\n");
    expect_error("study mixing_board --people 2 -o " + (folder / ("of_" + name)), 2, name);
    EXPECT_EQ(file_text(folder / ("of_" + name + "/" + name)), "mine\n");
    EXPECT_TRUE(name == "study.csv" || !file_exists(folder / ("of_" + name + "/study.csv")));
  }
}

// The samples have 17 people.
TEST_F(StudyCommand, FewPeopleHaveNoIntervals) {
  ASSERT_EQ(study("one", "--people 16").code, 0);
  for (const CsvRow& row : parse_csv(csv("one"))) EXPECT_TRUE(row.line == 1 || row.cells[6].empty()) << row.line;
}

}  // namespace
}  // namespace wholehand

#endif

// SPDX-License-Identifier: MIT
// sanitizers: address
#include <gtest/gtest.h>
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/files/csv.h"
#include "core/reader/reader.h"
#include "device/recordings/recording.h"
#include "evidence/trials/dataset.h"
#include "evidence/trials/disagreements.h"
#include "evidence/trials/run.h"
#include "tests/support/fake_trials.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

// One folder for all tests of this file, as it takes seconds to make.
class TrialsPage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    TrialOptions options = few_trials(*folder / "trials");
    options.six_forces = true;
    options.grips = 40;
    testing::internal::CaptureStdout();
    run_trials(shipped_scene_for_trials(), options, open_fake_engine([](FakeTrialEngine& engine) {
                 engine.discarded = 0.1;
                 engine.spread = 4;
               }));
    printed = testing::internal::GetCapturedStdout();
    page = file_text(*folder / "trials/trials.html");
  }
  static void TearDownTestSuite() { delete folder; }

  static TemporaryFolder* folder;
  static std::string page, printed;
};
TemporaryFolder* TrialsPage::folder = nullptr;
std::string TrialsPage::page, TrialsPage::printed;

TEST_F(TrialsPage, IsWholeAndSelfContained) {
  ASSERT_FALSE(page.empty());
  expect_well_formed(page.substr(page.find('\n') + 1));  // without the document type
  EXPECT_FALSE(has(page, "<script"));
  EXPECT_FALSE(has(page, "href=\"http"));
  EXPECT_FALSE(has(page, "src=\"http"));
  EXPECT_TRUE(has(page, "<html lang=\"en\""));
  for (const char* id : {"bars", "tried", "success", "predictors", "efforts", "weights", "disagreements", "words"}) {
    EXPECT_EQ(count_of(page, std::string("id=\"") + id + "\""), 1) << id;
    EXPECT_TRUE(has(page, std::string("href=\"#") + id + "\"")) << id;
  }
  EXPECT_EQ(count_of(page, "<img "), count_of(page, " alt=\"Front and side view of the hand on "));
}

TEST_F(TrialsPage, TellsSamplesAndProtocolsApart) {
  for (const char* part :
       {"stratified sample, fill-tilt", "best grips, fill-tilt", "mass and friction of DexGraspBench",
        "AUC of the worst effort, stratified sample, fill-tilt", "worst effort of the scene", "diverged", "passed by 60.5 %",
        "Grips that hold in all six directions", "slipped of those held", "left out: ", "intervals of AUCs are too narrow"})
    EXPECT_TRUE(has(page, part)) << part;
  const std::size_t bar = page.find("<th scope=\"row\">AUC of the worst effort");
  ASSERT_NE(bar, std::string::npos);
  const std::string row = page.substr(bar, page.find("</tr>", bar) - bar);
  const std::size_t verdict = std::min({row.find(">met<"), row.find(">missed<"), row.find(">too few to judge<")});
  EXPECT_LT(verdict, row.find("did not</td>")) << row;
  EXPECT_TRUE(has(printed, "AUC of the worst effort")) << printed;
  EXPECT_TRUE(has(
      printed, "in all six directions, at the largest fill: mass and friction of the scene | mass and friction of DexGraspBench"))
      << printed;
  EXPECT_TRUE(has(printed, "weights fitted to half of the grips change the AUC")) << printed;
  EXPECT_TRUE(has(printed, "recordings of disagreements")) << printed;
}

// One grip at one state shows no curve: neither a frame nor a caption is left of what cannot be drawn.
TEST(TrialsPageOfOneGrip, HasNoCaptionWithoutAChart) {
  const TemporaryFolder folder;
  TrialOptions options = few_trials(folder / "trials");
  options.grips = 1;
  options.best = 0;
  options.vessel = 0;
  options.fills = {1};
  options.tilts = {0};
  testing::internal::CaptureStdout();
  run_trials(scene_for_trials(), options, open_fake_engine());
  const std::string printed = testing::internal::GetCapturedStdout(), page = file_text(folder / "trials/trials.html");
  EXPECT_FALSE(has(page, "class=\"charts\""));
  EXPECT_FALSE(has(page, "<figcaption>Share of"));
  EXPECT_FALSE(has(page, "<figcaption>ROC"));
  EXPECT_TRUE(has(page, "not measured"));
}

// Every recording that the page links to is one that `wholehand view` reads.
TEST_F(TrialsPage, LinksToRecordings) {
  const int links = count_of(page, "href=\"disagreement-");
  ASSERT_GT(links, 0);
  for (int k = 1; k <= links; ++k) {
    const std::string name = TrialFiles::recording_name(static_cast<std::size_t>(k));
    EXPECT_TRUE(has(page, "href=\"" + name + "\"")) << name;
    const device::Recording recording = device::read_recording(*folder / ("trials/" + name));
    EXPECT_TRUE(recording.note.empty()) << recording.note;
    EXPECT_EQ(parse_scene(recording.info.scene_text, "").vessels.size(), 1u);
  }
  EXPECT_FALSE(file_exists(*folder / ("trials/" + TrialFiles::recording_name(static_cast<std::size_t>(links) + 1))));
}

TEST_F(TrialsPage, DatasetHasWhatTheTableHas) {
  int file = -1, id = -1;
  ASSERT_EQ(nc_open((*folder / "trials/trials.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  std::size_t trials = 0;
  ASSERT_EQ(nc_inq_dimid(file, "trial", &id), NC_NOERR);
  nc_inq_dimlen(file, id, &trials);
  const std::string table = file_text(*folder / "trials/trials.csv");
  EXPECT_EQ(static_cast<int>(trials), count_of(table, "\n") - 1);
  std::vector<int> held(trials);
  ASSERT_EQ(nc_inq_varid(file, "held", &id), NC_NOERR);
  nc_get_var_int(file, id, held.data());
  std::vector<double> effort(trials);
  ASSERT_EQ(nc_inq_varid(file, "effort", &id), NC_NOERR);
  nc_get_var_double(file, id, effort.data());
  std::size_t length = 0;
  EXPECT_EQ(nc_inq_attlen(file, id, "long_name", &length), NC_NOERR);
  EXPECT_EQ(nc_inq_attlen(file, id, "units", &length), NC_NOERR);
  EXPECT_EQ(nc_inq_attlen(file, id, "_FillValue", &length), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(file, "slipped", &id), NC_NOERR);
  std::vector<int> slipped(trials);
  nc_get_var_int(file, id, slipped.data());
  int missing = 0;
  EXPECT_EQ(nc_get_att_int(file, id, "_FillValue", &missing), NC_NOERR);
  const auto strings_of = [&](const char* name) {
    EXPECT_EQ(nc_inq_varid(file, name, &id), NC_NOERR) << name;
    std::vector<char*> read(trials);
    nc_get_var_string(file, id, read.data());
    const std::vector<std::string> strings(read.begin(), read.end());
    nc_free_string(trials, read.data());
    return strings;
  };
  const std::vector<std::string> details = strings_of("detail");
  for (const char* name : {"scene", "version", "engine", "seed"})
    EXPECT_EQ(nc_inq_attlen(file, NC_GLOBAL, name, &length), NC_NOERR) << name;
  nc_close(file);
  const std::vector<CsvRow> rows = parse_csv(table);
  ASSERT_EQ(rows.size(), trials + 1);
  EXPECT_EQ(rows[0].cells.back(), "detail");
  for (std::size_t k = 0; k < trials; ++k) {
    const std::vector<std::string>& cells = rows[k + 1].cells;
    EXPECT_EQ(std::stoi(cells[9]), held[k]) << k;
    EXPECT_EQ(std::stod(cells[5]), effort[k]) << k;
    EXPECT_EQ(cells[12] == "1", slipped[k] == missing) << k << ": only a discarded trial has none";
    EXPECT_EQ(cells.back(), details[k]) << k;
  }
}

// Every code of an integer says what it means, in the file and in the page about it.
TEST_F(TrialsPage, DatasetExplainsItsCodes) {
  int file = -1, id = -1;
  ASSERT_EQ(nc_open((*folder / "trials/trials.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  const auto meanings_of = [&](const char* name) {
    EXPECT_EQ(nc_inq_varid(file, name, &id), NC_NOERR) << name;
    std::size_t count = 0, length = 0;
    EXPECT_EQ(nc_inq_attlen(file, id, "flag_values", &count), NC_NOERR) << name;
    std::vector<int> values(count);
    nc_get_att_int(file, id, "flag_values", values.data());
    for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(values[k], static_cast<int>(k)) << name;
    EXPECT_EQ(nc_inq_attlen(file, id, "flag_meanings", &length), NC_NOERR) << name;
    std::string meanings(length, ' ');
    nc_get_att_text(file, id, "flag_meanings", meanings.data());
    EXPECT_EQ(count_of(meanings, " ") + 1, static_cast<int>(count)) << name << ": " << meanings;
    return meanings;
  };
  EXPECT_EQ(meanings_of("grip_sample"), "best stratified");
  EXPECT_EQ(meanings_of("protocol"), "fill-tilt six-forces");
  EXPECT_EQ(meanings_of("direction"), "+x -x +y -y +z -z");
  EXPECT_EQ(meanings_of("material"), "scene DexGraspBench");
  EXPECT_EQ(meanings_of("held"), "not_held held");
  EXPECT_EQ(meanings_of("discarded"), "not_discarded discarded");
  EXPECT_EQ(meanings_of("reason"), "held overlap buried diverged release turned moved earlier");
  EXPECT_EQ(meanings_of("slipped"), "not_slipped slipped");
  int missing = 0;
  for (const char* name : {"direction", "material", "slipped"}) {
    nc_inq_varid(file, name, &id);
    EXPECT_EQ(nc_get_att_int(file, id, "_FillValue", &missing), NC_NOERR) << name;
    EXPECT_EQ(missing, -1) << name;
  }
  nc_close(file);
}

// The text between backquotes, from `at` on, "attribute `model`" as "model".
std::string quoted(const std::string& text, std::size_t at) {
  const std::size_t start = text.find('`', at) + 1;
  return text.substr(start, text.find('`', start) - start);
}

// The table of docs/trials.md has the columns in their order, each with its variable, and what follows it has the other variables.
TEST_F(TrialsPage, ColumnsAndVariablesAreInTheDocumentation) {
  const std::string docs = file_text(WHOLEHAND_SOURCE_DIR "/docs/trials.md"), head = "\n### Columns and variables\n";
  const std::size_t begin = docs.find(head);
  ASSERT_NE(begin, std::string::npos);
  std::istringstream section(docs.substr(begin + head.size(), docs.find("\n##", begin + head.size()) - begin));
  std::vector<std::string> columns;
  std::set<std::string> variables, attributes;
  std::string rest;
  for (std::string line; std::getline(section, line);) {
    if (!line.starts_with("| `")) {
      rest += line + "\n";
      continue;
    }
    const std::size_t second = line.find(" | ");
    columns.push_back(quoted(line, 0));
    (line.substr(second).starts_with(" | attribute ") ? attributes : variables).insert(quoted(line, second));
  }
  EXPECT_EQ(columns, parse_csv(file_text(*folder / "trials/trials.csv"))[0].cells);
  int file = -1, count = 0, id = -1;
  ASSERT_EQ(nc_open((*folder / "trials/trials.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  for (const std::string& name : attributes) EXPECT_EQ(nc_inq_attid(file, NC_GLOBAL, name.c_str(), &id), NC_NOERR) << name;
  nc_inq_nvars(file, &count);
  std::set<std::string> of_file;
  for (int k = 0; k < count; ++k) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_inq_varname(file, k, name.data());
    of_file.insert(name.data());
  }
  nc_close(file);
  const std::size_t more = rest.find("`trials.nc` has three more variables.");
  ASSERT_NE(more, std::string::npos);
  for (const char* name : {"vessel", "term", "trial_grip"}) {
    EXPECT_NE(rest.find(std::string("`") + name + "`", more), std::string::npos) << name;
    EXPECT_TRUE(variables.insert(name).second) << name;
  }
  EXPECT_EQ(variables, of_file);
}

// A fault of the library, and not of the disk's room: a dimension without a length has no end.
TEST(TrialDataset, ErrorsOfTheLibraryNameTheRemedyAndLeaveNothing) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  EXPECT_EQ(refusal_line(
                [&] {
                  write_trials_dataset(path, scene_for_trials(), {}, {}, {"stand-in 1", "a"});
                },
                ExitCode::failure),
            path + ": cannot write the result file: NetCDF: Invalid argument; make room, then go on with --resume");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// As a check of the room is only worth something if the file is never larger; and a disk with room for it is not refused.
TEST(TrialDataset, RoomIsEnoughAndNotMuchMore) {
  const TemporaryFolder folder;
  Scene scene = scene_for_trials();
  TriedGrips tried;
  tried.cases.resize(scene.vessels.size());
  const auto expect_room = [&](std::size_t grips, std::size_t cases, const std::string& detail = "") {
    tried.cases[0].resize(cases);
    tried.grips.assign(grips, {});
    GripFinding found;
    found.prediction.cases.resize(cases);
    found.outcomes.resize(cases);
    for (TrialOutcome& outcome : found.outcomes) outcome.detail = detail;
    tried.found.assign(grips, found);
    const std::string path = folder / std::to_string(grips * cases) + ".nc";
    write_trials_dataset(path, scene, {}, tried, {"stand-in 1", std::string(32, 'a')});
    const auto size = static_cast<double>(std::filesystem::file_size(path));
    const auto room = static_cast<double>(trials_dataset_room(scene, tried));
    EXPECT_LE(size, room) << grips << " x " << cases << ", " << detail.size() << ", " << scene.text.size();
    EXPECT_LT(room, 1.4 * size) << grips << " x " << cases << ", " << detail.size() << ", " << scene.text.size();
    std::filesystem::remove(path);
  };
  expect_room(1, 1);
  expect_room(3000, 1);
  expect_room(100, 60);
  for (const std::size_t length : {1, 80, 2'000, 30'000}) expect_room(100, 8, std::string(length, 'a'));
  for (const std::size_t length : {2'000, 5'000, 30'000, 65'000, 70'000, 1'000'000}) {
    scene.text = std::string(length, '#');
    expect_room(2, 2);
  }
}

TEST(TrialDisagreements, OneRunGoesUpToTheTilt) {
  std::vector<TrialCase> cases;
  for (const double fill : {0.5, 1.0})
    for (const double tilt : {0.0, 1.0, 2.0}) {
      TrialCase one;
      one.fill = fill;
      one.tilt = tilt;
      cases.push_back(one);
    }
  const auto run = cases_up_to(cases, 4);
  ASSERT_EQ(run.size(), 2u);
  EXPECT_EQ(run[0].fill, 1);
  EXPECT_EQ(run[1].tilt, 1);
  cases[5].protocol = TrialProtocol::six_forces;
  EXPECT_EQ(cases_up_to(cases, 5).size(), 1u);
}

}  // namespace
}  // namespace wholehand

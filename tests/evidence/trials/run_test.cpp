// SPDX-License-Identifier: MIT
// sanitizers: thread
#include "evidence/trials/run.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <set>

#include "base/files/csv.h"
#include "base/files/output_lock.h"
#include "evidence/trials/journal.h"
#include "sweeps/run/run.h"
#include "tests/support/fake_trials.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

struct TrialsRun {
  ExitCode code = ExitCode::done;
  std::string error, out, notes;
};

class TrialsTest : public testing::Test {
 protected:
  TemporaryFolder folder;
  Scene scene = scene_for_trials();
  TrialOptions options = few_trials(folder / "trials");

  TrialsRun run(const OpenTrialEngine& open = open_fake_engine(), sweeps::SweepResult* result = nullptr) {
    TrialsRun ran;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      ran.code = run_trials(scene, options, open, result);
    } catch (const Error& error) {
      ran.code = error.code;
      ran.error = error.what();
    }
    ran.out = testing::internal::GetCapturedStdout();
    ran.notes = testing::internal::GetCapturedStderr();
    EXPECT_EQ(ran.error.find('\n'), std::string::npos) << ran.error;
    return ran;
  }

  // Interrupted after some grips.
  TrialsRun run_some(int grips) {
    std::atomic<int> left = grips;
    return run(open_fake_engine([&](FakeTrialEngine& engine) {
      engine.before_run = [&] {
        if (left-- == 0) raise(SIGINT);
      };
    }));
  }

  // No file may be larger.
  TrialsRun run_with_room(std::size_t bytes, const OpenTrialEngine& open = open_fake_engine()) {
    struct rlimit before {};
    getrlimit(RLIMIT_FSIZE, &before);
    struct rlimit small = before;
    small.rlim_cur = bytes;
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const TrialsRun ran = run(open);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    return ran;
  }

  // Trials that disagree with effort, with a text that their recordings can have.
  OpenTrialEngine disagreeing(std::atomic<int>* count = nullptr) {
    scene = shipped_scene_for_trials();
    options.vessel = 0;
    options.grips = 8;
    return open_fake_engine([count](FakeTrialEngine& engine) {
      engine.spread = 4;
      engine.count = count;
    });
  }

  // The folder's files by their names.
  std::map<std::string, std::string> files_there() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(options.folder))
      files[entry.path().filename()] = file_text(entry.path());
    return files;
  }

  std::string csv() const { return file_text(options.folder + "/trials.csv"); }
  std::string journal() const { return options.folder + "/trials.journal"; }
};

TEST_F(TrialsTest, ARowATrial) {
  options.six_forces = true;
  const TrialsRun ran = run();
  ASSERT_EQ(ran.code, ExitCode::done) << ran.error;
  const std::string text = csv();
  EXPECT_TRUE(text.starts_with(
      "vessel,grip,fill,tilt_rad,protocol,effort,tips_effort,push_N,score,held,slip_m,turn_rad,discarded,reason,"));
  const auto rows = parse_csv(text);
  ASSERT_EQ(rows.size(), 1u + (4 + 16) * (8 + 12));
  for (const CsvRow& row : rows) EXPECT_EQ(row.cells.size(), rows[0].cells.size()) << row.line;
  EXPECT_TRUE(has(text, ",best,hand,"));
  EXPECT_TRUE(has(text, ",stratified,hand,"));
  EXPECT_TRUE(has(text, ",DexGraspBench,+x,"));
  EXPECT_FALSE(file_exists(journal()));
  EXPECT_FALSE(file_exists(options.folder + "/trials.lock"));
}

TEST_F(TrialsTest, SameBitsWhateverTheThreads) {
  options.threads = 1;
  ASSERT_EQ(run().code, ExitCode::done);
  const std::string one = csv();
  options.threads = 4;
  options.folder = folder / "other";
  ASSERT_EQ(run().code, ExitCode::done);
  EXPECT_EQ(csv(), one);
  options.seed = 2;
  ASSERT_EQ(run().code, ExitCode::done);
  EXPECT_NE(csv(), one) << "another sample";
}

// The lists and scores of a sweep on the core are those that trials find themselves.
TEST_F(TrialsTest, GripsOfAResultAreThoseOfItsScene) {
  std::set<std::string> tables;
  for (const bool is_robust : {false, true}) {
    if (is_robust) {
      scene.robust.emplace();
      scene.robust->height = 8e-3;
      scene.robust->roll = radians(20);
    }
    const std::string name = is_robust ? "robust" : "plain";
    options.folder = folder / (name + "_of_scene");
    ASSERT_EQ(run().code, ExitCode::done);
    const std::string of_scene = csv();
    const sweeps::SweepOptions sweep{.output = folder / (name + ".nc"), .on = "core", .best = 2, .refine = false};
    testing::internal::CaptureStdout();
    EXPECT_EQ(sweeps::run_sweep(scene, sweep), ExitCode::done);
    testing::internal::GetCapturedStdout();
    sweeps::SweepResult result(sweep.output);
    options.folder = folder / (name + "_of_result");
    const TrialsRun ran = run(open_fake_engine(), &result);
    ASSERT_EQ(ran.code, ExitCode::done) << ran.error;
    EXPECT_EQ(csv(), of_scene);
    tables.insert(of_scene);
  }
  EXPECT_EQ(tables.size(), 2u) << "deviations change the lists";
}

TEST_F(TrialsTest, DeviationsAreTriedAndResumed) {
  options.scatter = 4;
  EXPECT_TRUE(has(run().error, "--scatter needs [robust]"));
  EXPECT_EQ(run().code, ExitCode::usage);
  EXPECT_FALSE(file_exists(options.folder));
  scene.robust.emplace();
  scene.robust->height = 8e-3;
  const TrialsRun whole = run();
  ASSERT_EQ(whole.code, ExitCode::done) << whole.error;
  EXPECT_TRUE(has(whole.out, "each grip is then tried at 4 deviations")) << whole.out;
  EXPECT_TRUE(has(whole.out, "grips at 4 deviations of [robust] each, held in every trial:")) << whole.out;
  EXPECT_TRUE(has(whole.out, "first 5 grips of beaker1 that hold where a person's hand may be")) << whole.out;
  const std::string page = file_text(options.folder + "/trials.html"), table = csv();
  EXPECT_TRUE(has(page, "href=\"#scatter\"") && has(page, "id=\"scatter\"") && has(page, "Best grips at their deviations"));
  expect_well_formed(page.substr(page.find('\n') + 1));
  options.folder = folder / "resumed";
  ASSERT_EQ(run_some(7).code, ExitCode::interrupted);
  options.resume = true;
  EXPECT_EQ(run().code, ExitCode::done);
  EXPECT_EQ(csv(), table);
  // every row has what became of its grip's deviations
  const auto rows = parse_csv(table);
  const auto& names = rows[0].cells;
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), "placements") - names.begin());
  ASSERT_LT(at + 3, names.size());
  int held = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    EXPECT_EQ(rows[k].cells[at], "4");
    EXPECT_LE(std::stoi(rows[k].cells[at + 1]) + std::stoi(rows[k].cells[at + 3]), 4);
    held += std::stoi(rows[k].cells[at + 1]);
    EXPECT_GE(std::stod(rows[k].cells[at - 1]), 0) << "share of the deviations that hold by effort";
  }
  EXPECT_GT(held, 0);
}

TEST_F(TrialsTest, ResumesToTheSameBits) {
  ASSERT_EQ(run().code, ExitCode::done);
  const std::string whole = csv();
  options.folder = folder / "resumed";
  const TrialsRun cut = run_some(7);
  EXPECT_EQ(cut.code, ExitCode::interrupted);
  EXPECT_TRUE(has(cut.notes, "go on with --resume")) << cut.notes;
  EXPECT_FALSE(file_exists(options.folder + "/trials.csv"));
  options.resume = true;
  const int done = count_of(file_text(journal()), "\"outcomes\"");
  EXPECT_GE(done, 7);
  EXPECT_LT(done, 20);
  std::atomic<int> asked = 0;
  const TrialsRun rest = run(open_fake_engine([&](FakeTrialEngine& engine) { engine.count = &asked; }));
  EXPECT_EQ(rest.code, ExitCode::done) << rest.error;
  EXPECT_EQ(asked, 20 - done) << "done ones are not tried again";
  EXPECT_EQ(csv(), whole);
  const TrialsRun again = run();
  EXPECT_EQ(again.code, ExitCode::done);
  EXPECT_TRUE(has(again.out, "nothing to resume")) << again.out;
  // other trials that are whole are not replaced
  options.seed = 5;
  const TrialsRun other = run();
  EXPECT_EQ(other.code, ExitCode::usage);
  EXPECT_TRUE(has(other.error, "other trials are complete there")) << other.error;
  EXPECT_EQ(csv(), whole);
  options.folder = folder / "fresh";
  const TrialsRun fresh = run();
  EXPECT_EQ(fresh.code, ExitCode::done);
  EXPECT_TRUE(has(fresh.notes, "starting from the first grip")) << fresh.notes;
}

TEST_F(TrialsTest, ADamagedLineOfTheJournalIsTriedAgain) {
  ASSERT_EQ(run().code, ExitCode::done);
  const std::string whole = csv();
  options.folder = folder / "resumed";
  ASSERT_EQ(run_some(9).code, ExitCode::interrupted);
  std::string text = file_text(journal());
  const std::size_t at = text.find("\"outcomes\"", text.size() / 2);
  ASSERT_NE(at, std::string::npos);
  text[at + 14] ^= 1;
  text.resize(text.size() - 20);  // as a process leaves it that was killed while it wrote
  write_file(journal(), text);
  options.resume = true;
  const TrialsRun rest = run();
  EXPECT_EQ(rest.code, ExitCode::done) << rest.error;
  EXPECT_TRUE(has(rest.notes, "lines are not as they were written") || has(rest.notes, "line is not as it was written"))
      << rest.notes;
  EXPECT_EQ(csv(), whole);
}

TEST_F(TrialsTest, AJournalOfOtherTrialsIsRefused) {
  ASSERT_EQ(run_some(3).code, ExitCode::interrupted);
  options.resume = true;
  const auto refused = [&](const std::string& gist, const OpenTrialEngine& open = open_fake_engine()) {
    const TrialsRun ran = run(open);
    EXPECT_EQ(ran.code, ExitCode::usage) << gist;
    EXPECT_TRUE(has(ran.error, "begun with another " + gist)) << ran.error;
  };
  options.settings.friction = 0.4;
  refused("model, mass, friction or material");
  options.settings = {};
  options.seed = 5;
  refused("choice of grips, another seed");
  options.seed = 1;
  scene.robust.emplace().height = 1e-3;
  options.scatter = 2;
  refused("choice of grips, another number of deviations");
  options.scatter = 0;
  scene.robust.reset();
  options.tilts = {0, 1};
  refused("choice of states");
  options.tilts.clear();
  refused("engine", open_fake_engine([](FakeTrialEngine& engine) { engine.engine_name = "stand-in 2"; }));
  scene.text += "\n";
  refused("text of the scene");
  write_file(journal(), "wholehand trials journal 1\nrubbish\n");
  const TrialsRun damaged = run();
  EXPECT_EQ(damaged.code, ExitCode::failure);
  EXPECT_TRUE(has(damaged.error, "is damaged")) << damaged.error;
}

TEST_F(TrialsTest, WithoutResumeItBeginsAgainAndSaysSo) {
  ASSERT_EQ(run_some(3).code, ExitCode::interrupted);
  const TrialsRun ran = run();
  EXPECT_EQ(ran.code, ExitCode::done);
  EXPECT_TRUE(has(ran.notes, "are begun again")) << ran.notes;
}

// A diverged trial does not count as held, whatever the engine says.
TEST_F(TrialsTest, DivergedTrialsAreCountedAndNeverHeld) {
  const TrialsRun ran = run(open_fake_engine([](FakeTrialEngine& engine) { engine.discarded = 0.5; }));
  ASSERT_EQ(ran.code, ExitCode::done) << ran.error;
  const auto rows = parse_csv(csv());
  std::size_t diverged = 0;
  for (const CsvRow& row : rows) {
    if (row.cells[13] != "diverged") continue;
    ++diverged;
    EXPECT_EQ(row.cells[9], "0");
    EXPECT_EQ(row.cells[12], "1");
    EXPECT_EQ(row.cells.back(), "Nan, Inf or huge value in QACC at DOF 0. The simulation is unstable.");
  }
  EXPECT_GT(diverged, 8u);
}

TEST_F(TrialsTest, NoEngineIsOneLineBeforeAnyFile) {
  const TrialsRun ran = run([](const Scene&, const Evaluator&, const TrialSettings&) -> std::unique_ptr<TrialEngine> {
    throw failure_error("libmujoco.so.2.2.2 is not there; install libmujoco2.2.2");
  });
  EXPECT_EQ(ran.code, ExitCode::failure);
  EXPECT_TRUE(has(ran.error, "libmujoco"));
  EXPECT_FALSE(file_exists(options.folder));
}

TEST_F(TrialsTest, AVesselWithoutAModelIsOneLineBeforeAnyFile) {
  const std::string name = scene.vessels.back().name;
  const auto open = open_fake_engine([&](FakeTrialEngine& engine) { engine.without_model = name; });
  const TrialsRun ran = run(open);
  EXPECT_EQ(ran.code, ExitCode::usage);
  EXPECT_TRUE(has(ran.error, "vessel '" + name + "' has no model")) << ran.error;
  EXPECT_TRUE(ran.error.ends_with("; or try another vessel: --vessel " + scene.vessels.front().name)) << ran.error;
  EXPECT_FALSE(file_exists(options.folder));
  scene.vessels.erase(scene.vessels.begin(), scene.vessels.end() - 1);
  EXPECT_FALSE(has(run(open).error, "--vessel")) << "there is no other one";
  scene = scene_for_trials();
  options.vessel = 0;
  EXPECT_EQ(run(open).code, ExitCode::done) << "it is not asked for";
}

TEST_F(TrialsTest, AnEngineThatFailsLeavesTheJournal) {
  std::atomic<int> left = 5;
  const TrialsRun ran = run(open_fake_engine([&](FakeTrialEngine& engine) {
    engine.before_run = [&] {
      if (left-- == 0) throw failure_error("out of memory");
    };
  }));
  EXPECT_EQ(ran.code, ExitCode::failure);
  EXPECT_TRUE(file_exists(journal()));
  options.resume = true;
  EXPECT_EQ(run().code, ExitCode::done);
}

TEST_F(TrialsTest, ScenesThatHaveNoEffortsAreRefused) {
  scene.strength.reset();
  EXPECT_TRUE(has(run().error, "trials need the strength of the hand"));
  EXPECT_TRUE(has(run().error, "leave efforts = false out of"));
  scene.strength = StrengthData{};
  scene.tilts.clear();
  EXPECT_TRUE(has(run().error, "trials need [tilts]"));
  EXPECT_FALSE(file_exists(options.folder));
}

TEST_F(TrialsTest, AnotherProcessInTheFolderIsNamed) {
  std::filesystem::create_directory(options.folder);
  const OutputLock lock(options.folder + "/trials.lock", "folder");
  const TrialsRun ran = run();
  EXPECT_EQ(ran.code, ExitCode::usage);
  EXPECT_TRUE(has(ran.error, "name another folder with -o")) << ran.error;
}

// One of each is not "1 threads".
TEST_F(TrialsTest, OneIsSaidAsOne) {
  options.threads = 1;
  options.grips = 1;
  options.best = 0;
  options.vessel = 0;
  options.fills = {1};
  options.tilts = {0};
  const TrialsRun ran = run();
  ASSERT_EQ(ran.code, ExitCode::done) << ran.error;
  EXPECT_TRUE(has(ran.out, "1 grip, 1 trial in stand-in 1, 1 thread\n")) << ran.out;
  EXPECT_TRUE(has(file_text(options.folder + "/trials.html"), "1 grip in 1 trial,"));
}

TEST_F(TrialsTest, FilesOfOthersStay) {
  ASSERT_EQ(mkdir(options.folder.c_str(), 0755), 0);
  for (const char* name : {"trials.csv", "trials.html", "trials.nc", "trials.journal", "disagreement-3.nc"}) {
    const std::string path = options.folder + "/" + name;
    write_file(path, "somebody's");
    const TrialsRun ran = run();
    EXPECT_EQ(ran.code, ExitCode::usage) << name;
    EXPECT_TRUE(has(ran.error, name)) << ran.error;
    EXPECT_EQ(file_text(path), "somebody's");
    std::filesystem::remove(path);
  }
  EXPECT_EQ(run().code, ExitCode::done);
  EXPECT_EQ(run().code, ExitCode::done) << "own files are replaced";
}

TEST_F(TrialsTest, AFolderThatCannotBeIsRefused) {
  options.folder = folder / "missing" + "/trials";
  EXPECT_EQ(run().code, ExitCode::usage);
  write_file(folder / "file", "x");
  options.folder = folder / "file";
  EXPECT_EQ(run().code, ExitCode::usage);
}

// All grips were tried, and then the disk was full: before the first file, and between any two. Whatever an earlier run wrote
// stays.
TEST_F(TrialsTest, AFullDiskLeavesTheFilesOfOneRunAlone) {
  const OpenTrialEngine open = disagreeing();
  ASSERT_EQ(run(open).code, ExitCode::done);
  const auto before = files_there();
  ASSERT_TRUE(before.contains("disagreement-1.nc"));
  options.seed = 2;
  options.folder = folder / "other";
  ASSERT_EQ(run(open).code, ExitCode::done);
  const auto wanted = files_there();
  // from room for all but the largest file down to room for the journal alone
  std::vector<std::size_t> sizes;
  for (const auto& [name, bytes] : wanted) sizes.push_back(bytes.size());
  std::sort(sizes.rbegin(), sizes.rend());
  std::set<std::string> refused;
  for (const std::size_t size : sizes) {
    options.folder = folder / std::to_string(size);
    options.seed = 1;
    options.resume = false;
    ASSERT_EQ(run(open).code, ExitCode::done);
    options.seed = 2;
    const TrialsRun ran = run_with_room(size - 1, open);
    ASSERT_EQ(ran.code, ExitCode::failure) << size;
    if (has(ran.error, "trials.journal: ")) break;
    EXPECT_TRUE(has(ran.error, "go on with --resume")) << ran.error;
    EXPECT_FALSE(has(ran.error, ".new")) << ran.error;
    EXPECT_TRUE(has(ran.error, "File too large")) << ran.error;
    refused.insert(ran.error.substr(ran.error.find(options.folder) + options.folder.size() + 1, 10));
    auto left = files_there();
    EXPECT_EQ(left.erase("trials.journal"), 1u) << size;
    EXPECT_TRUE(left == before) << size << ": " << ran.error;
    options.resume = true;
    std::atomic<int> asked = 0;
    EXPECT_EQ(run(disagreeing(&asked)).code, ExitCode::done);
    EXPECT_EQ(asked, 0) << "all had been tried";
    const auto now = files_there();
    EXPECT_EQ(now.size(), wanted.size());
    EXPECT_EQ(csv(), wanted.at("trials.csv"));
  }
  EXPECT_GE(refused.size(), 2u) << "not always by the same file";
}

// All grips were tried, and recordings of disagreements are under way: each takes a run of the engine.
TEST_F(TrialsTest, AnInterruptBetweenRecordingsLeavesTheFilesOfAnEarlierRun) {
  std::atomic<int> asked = 0;
  const OpenTrialEngine open = disagreeing(&asked);
  ASSERT_EQ(run(open).code, ExitCode::done);
  const auto before = files_there();
  options.grips = 36;  // with several disagreements
  int recorded = 0;
  const TrialsRun cut = run([&](const Scene& of, const Evaluator& core, const TrialSettings& settings) {
    auto engine = open(of, core, settings);
    dynamic_cast<FakeTrialEngine&>(*engine).before_tracks = [&] {
      if (++recorded == 1) raise(SIGINT);
    };
    return engine;
  });
  EXPECT_EQ(cut.code, ExitCode::interrupted) << cut.error;
  EXPECT_EQ(recorded, 1);
  EXPECT_TRUE(has(cut.notes, "interrupted before the files were written; go on with --resume")) << cut.notes;
  auto left = files_there();
  EXPECT_EQ(left.erase("trials.journal"), 1u);
  EXPECT_TRUE(left == before);
  options.resume = true;
  asked = 0;
  EXPECT_EQ(run(open).code, ExitCode::done);
  EXPECT_EQ(asked, 0) << "all had been tried";
  EXPECT_TRUE(file_exists(options.folder + "/disagreement-2.nc")) << "else there was nothing between";
  EXPECT_FALSE(file_exists(journal()));
  EXPECT_GT(csv().size(), before.at("trials.csv").size());
}

TEST_F(TrialsTest, WhatAKilledRunLeftOnTheWayGoes) {
  ASSERT_EQ(mkdir(options.folder.c_str(), 0755), 0);
  for (const char* name : {"trials.csv.new", "trials.nc.new", "trials.html.new", "trials.journal.new", "disagreement-1.nc.new",
                           "disagreement-10.nc.new", "disagreement-10.nc.new.partial"})
    write_file(options.folder + "/" + name, "half");
  ASSERT_EQ(run_some(3).code, ExitCode::interrupted);
  EXPECT_EQ(files_there().size(), 1u) << "the journal";
}

// The trials are done: their tables do not hang on a drawing.
TEST_F(TrialsTest, AnEngineThatFailsOnDisagreementsAloneLosesOnlyTheirRecordings) {
  const OpenTrialEngine open = disagreeing();
  const TrialsRun ran = run([&](const Scene& of, const Evaluator& core, const TrialSettings& settings) {
    auto engine = open(of, core, settings);
    dynamic_cast<FakeTrialEngine&>(*engine).before_tracks = [] { throw failure_error("out of memory"); };
    return engine;
  });
  ASSERT_EQ(ran.code, ExitCode::done) << ran.error;
  EXPECT_TRUE(has(file_text(options.folder + "/trials.html"), "There is no recording: out of memory."));
  EXPECT_EQ(files_there().size(), 3u) << "the table, the dataset and the page";
}

// An earlier run had more disagreements.
TEST_F(TrialsTest, RecordingsOfAnEarlierRunGo) {
  const OpenTrialEngine open = disagreeing();
  ASSERT_EQ(run(open).code, ExitCode::done);
  ASSERT_TRUE(file_exists(options.folder + "/disagreement-1.nc"));
  const std::string last = options.folder + "/disagreement-10.nc";
  std::filesystem::copy_file(options.folder + "/disagreement-1.nc", last, std::filesystem::copy_options::overwrite_existing);
  options.grips = 0;
  options.best = 1;
  ASSERT_EQ(run(open).code, ExitCode::done);
  EXPECT_FALSE(file_exists(last));
}

// Whatever a run had written when it ended, --resume goes on in its folder.
TEST_F(TrialsTest, ResumesBesideADatasetWithoutATable) {
  ASSERT_EQ(run().code, ExitCode::done);
  const std::string whole = csv(), dataset = options.folder + "/trials.nc";
  options.folder = folder / "resumed";
  ASSERT_EQ(run_some(5).code, ExitCode::interrupted);
  std::filesystem::copy_file(dataset, options.folder + "/trials.nc");
  options.resume = true;
  const TrialsRun ran = run();
  EXPECT_EQ(ran.code, ExitCode::done) << ran.error;
  EXPECT_EQ(csv(), whole);
}

// As a full disk: the journal keeps what it took.
TEST_F(TrialsTest, AFullDiskIsOneLineAndResumable) {
  ASSERT_EQ(run().code, ExitCode::done);
  const std::string whole = csv();
  options.folder = folder / "full";
  const TrialsRun ran = run_with_room(8'000);  // some grips
  EXPECT_EQ(ran.code, ExitCode::failure);
  EXPECT_TRUE(has(ran.error, "trials.journal: cannot be written")) << ran.error;
  EXPECT_FALSE(file_exists(options.folder + "/trials.csv"));
  options.resume = true;
  EXPECT_EQ(run().code, ExitCode::done);
  EXPECT_EQ(csv(), whole);
}

// ---- the journal by itself ----

TEST(TrialJournalFile, KeepsNumbersToTheBit) {
  const TemporaryFolder folder;
  const std::string path = folder / "journal";
  const TrialIdentity identity{{"scene", "a"}};
  GripFinding finding;
  finding.prediction.worst_effort = std::numeric_limits<double>::infinity();
  finding.prediction.tips_worst_effort = std::nan("");
  finding.prediction.score = 0.1 + 0.2;
  finding.prediction.epsilon = 5e-324;
  finding.prediction.cases = {{1.0 / 3, std::numeric_limits<double>::infinity()}};
  TrialOutcome outcome;
  outcome.reason = TrialReason::moved;
  outcome.slip = -0.0;
  outcome.turn = 1e-300;
  outcome.detail = "a \"detail\", with\\ signs";
  finding.outcomes = {outcome};
  TrialJournal(path, identity).add(1, finding);
  TrialJournal::Found found;
  std::size_t damaged = 9;
  TrialJournal(path, identity, {1, 1}, found, damaged);
  EXPECT_EQ(damaged, 0u);
  ASSERT_EQ(found.size(), 1u);
  const GripFinding& read = found.at(1);
  const auto expect_same = [](double a, double b) { EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)); };
  expect_same(read.prediction.worst_effort, finding.prediction.worst_effort);
  expect_same(read.prediction.tips_worst_effort, finding.prediction.tips_worst_effort);
  expect_same(read.prediction.score, finding.prediction.score);
  expect_same(read.prediction.epsilon, finding.prediction.epsilon);
  expect_same(read.prediction.cases[0].effort, finding.prediction.cases[0].effort);
  expect_same(read.outcomes[0].slip, outcome.slip);
  expect_same(read.outcomes[0].turn, outcome.turn);
  EXPECT_EQ(read.outcomes[0].reason, outcome.reason);
  EXPECT_EQ(read.outcomes[0].detail, outcome.detail);
  // a grip with another number of cases, and one beyond the last grip
  found.clear();
  TrialJournal(path, identity, {1, 2}, found, damaged);
  EXPECT_EQ(damaged, 1u);
}

}  // namespace
}  // namespace wholehand

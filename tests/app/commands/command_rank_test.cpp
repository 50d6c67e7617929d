// SPDX-License-Identifier: MIT
// The built program's `rank`, and its lists handed back to grip and report.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "base/files/json.h"
#include "core/reader/shipped.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

class CommandRank : public testing::Test {
 protected:
  // With the paper's hand, of which four grips are plausible.
  void SetUp() override {
    std::string text = file_text(find_scene("small"));
    text.replace(text.find("scale = 0.95"), 0, "person = \"paper\"\n");
    write_file(folder / "small.toml", text);
    ASSERT_EQ(run("PROGRAM sweep " + (folder / "small.toml") + " --on core --best 4 -o " + result + " >/dev/null").code, 0);
  }

  TemporaryFolder folder;
  std::string result = folder / "a.nc", list = folder / "list.csv";
};

TEST_F(CommandRank, WithoutOptionsItIsTheSweepsOwnListByteForByte) {
  const Outcome outcome = run("PROGRAM rank " + result + " -o " + list + " 2>&1");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_EQ(file_text(list), file_text(folder / "a.best.csv"));
  EXPECT_NE(outcome.output.find("\n  rank  "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("wrote " + list), std::string::npos) << outcome.output;
}

TEST_F(CommandRank, ASweepListsByAKeyWhatRankListsOfItsResult) {
  const std::string scene = folder / "pushed.toml";
  write_file(scene, file_text(folder / "small.toml"));
  expect_error("sweep " + scene + " --on core -o " + (folder / "b.nc") + " --rank-by push", 2,
               "add it to [output] also, or to its keep");
  write_file(scene, edited(file_text(scene), "best = 5", "best = 5\nalso = [\"push\"]"));
  const std::string sweep = "PROGRAM sweep " + scene + " --on core --best 4 --glb 1 -o " + (folder / "b.nc");
  std::set<std::string> lists;
  for (const std::string by : {"score", "robust", "worst_effort", "push"}) {
    const Outcome swept = run(sweep + " --rank-by " + by + " 2>&1");
    ASSERT_EQ(swept.code, 0) << swept.output;
    const Outcome ranked = run("PROGRAM rank " + (folder / "b.nc") + " --rank-by " + by + " --glb 1 -o " + list + " 2>&1");
    ASSERT_EQ(ranked.code, 0) << ranked.output;
    EXPECT_EQ(file_text(folder / "b.best.csv"), file_text(list)) << by;
    EXPECT_EQ(file_text(folder / "b.tumbler.1.glb"), file_text(folder / "list.tumbler.1.glb")) << by;
    const std::string table =
        ranked.output.substr(ranked.output.find("\n  rank "), ranked.output.find("\n\nwrote ") - ranked.output.find("\n  rank "));
    EXPECT_NE(swept.output.find(table), std::string::npos) << swept.output << ranked.output;
    EXPECT_EQ(read_values(folder / "b.nc", "best_grip"), read_values(result, "best_grip")) << "the scene's own order";
    lists.insert(file_text(list));
  }
  EXPECT_GE(lists.size(), 3u) << "the keys order the grips differently";
}

TEST_F(CommandRank, ASweepRefusesAKeyThatItCannotRankBy) {
  const std::string scene = file_text(folder / "small.toml"), path = folder / "other.toml", other = folder / "other.nc";
  const auto refused = [&](const std::string& text, const std::string& options, const std::string& message) {
    write_file(path, text);
    expect_error("sweep " + path + " --on core -o " + other + " --rank-by " + options, 2, message);
  };
  const auto kept = [&](const std::string& names) { return edited(scene, "best = 5", "best = 5\nkeep = [" + names + "]"); };
  const std::string without = scene.substr(0, scene.find("[robust]"));
  refused(scene, "luck", "--rank-by 'luck'; allowed: score, robust, worst_effort or push");
  refused(without, "robust",
          "--rank-by robust needs [robust], which the scene does not have; allowed: score, worst_effort or push");
  refused(without + "[strength]\nefforts = false\n", "push", "--rank-by push needs efforts");
  refused(kept("'score', 'plausible', 'not_held'"), "worst_effort",
          "--rank-by: the result lacks worst_effort, as keep of the sweep does not name it; add it to keep");
  refused(kept(""), "score", "--rank-by: the result lacks plausible, not_held, score, as keep");
  refused(scene, "score --best 0", "--rank-by: the sweep lists no grips");
  EXPECT_FALSE(file_exists(other));
  EXPECT_FALSE(file_exists(other + ".partial")) << "before anything is computed";
}

TEST_F(CommandRank, AListIsHandedBack) {
  ASSERT_EQ(run("PROGRAM rank " + result + " --rank-by score --where 'roll_deg < 0' --best 3 -o " + list + " >/dev/null").code, 0);
  const std::string ranked = "PROGRAM grip " + result + " --vessel tumbler --rank 2 --json", by_list = ranked + " --list " + list;
  const Outcome own = run(ranked), listed = run(by_list);
  ASSERT_EQ(own.code, 0);
  ASSERT_EQ(listed.code, 0);
  EXPECT_NE(own.output, listed.output);
  const auto reported = parse_json(own.output)["grip"];
  EXPECT_EQ(reported["height_m"], read_values(result, "best_height")[1]);
  EXPECT_EQ(reported["roll_rad"], read_values(result, "best_roll")[1]);
  EXPECT_EQ(reported["obliquity_rad"], read_values(result, "best_obliquity")[1]);
  EXPECT_LT(parse_json(listed.output)["grip"]["roll_rad"], 0) << "as the condition has it";
  EXPECT_EQ(run(by_list + " --glb " + (folder / "g.glb") + " >/dev/null").code, 0);
  EXPECT_TRUE(file_exists(folder / "g.glb"));
  EXPECT_EQ(run(by_list + " --svg " + (folder / "g.svg") + " >/dev/null").code, 0);
  EXPECT_EQ(run(ranked + " --svg " + (folder / "own.svg") + " >/dev/null").code, 0);
  EXPECT_NE(file_text(folder / "g.svg"), file_text(folder / "own.svg"));
  const Outcome page = run("PROGRAM report " + result + " --list " + list + " -o " + (folder / "p.html") + " 2>&1");
  ASSERT_EQ(page.code, 0) << page.output;
  EXPECT_NE(file_text(folder / "p.html").find("Places and scores come from list.csv"), std::string::npos);
}

TEST_F(CommandRank, DrawingsBearTheNameOfTheList) {
  ASSERT_EQ(run("PROGRAM rank " + result + " --glb 2 -o " + list + " 2>&1").code, 0);
  EXPECT_TRUE(file_exists(folder / "list.tumbler.1.glb"));
  EXPECT_TRUE(file_exists(folder / "list.tumbler.2.glb"));
  EXPECT_FALSE(file_exists(folder / "list.tumbler.3.glb"));
}

TEST_F(CommandRank, ConditionsThatAreGivenOneByOneAreAllMet) {
  const std::string both = folder / "both.csv", joined = folder / "joined.csv", rank = "PROGRAM rank " + result + " --apart-mm 0";
  const std::string down = "obliquity_deg < 0", above = "roll_deg < -75 or closure > 2";
  const Outcome separate = run(rank + " --where '" + down + "' --where '" + above + "' -o " + both + " | head -n 1");
  EXPECT_EQ(separate.output, run(rank + " --where '(" + down + ") and (" + above + ")' -o " + joined + " | head -n 1").output);
  EXPECT_EQ(file_text(both), file_text(joined));
  for (const std::string& alone : {down, above}) {
    ASSERT_EQ(run(rank + " --where '" + alone + "' -o " + joined + " >/dev/null").code, 0);
    EXPECT_NE(file_text(both), file_text(joined)) << alone;
  }
  expect_error("rank " + result + " --where 'gap > 0' --where 'gap_m > 0'", 2, "--where, column 1: there is no value 'gap_m'");
}

TEST_F(CommandRank, NearGripsAreListedOnRequestAlone) {
  const std::string near = folder / "near.csv", far = folder / "far.csv";
  ASSERT_EQ(run("PROGRAM rank " + result + " --apart-mm 0 -o " + near + " >/dev/null").code, 0);
  ASSERT_EQ(run("PROGRAM rank " + result + " --apart-mm 60 -o " + far + " >/dev/null").code, 0);
  EXPECT_NE(file_text(near), file_text(folder / "a.best.csv"));
  EXPECT_NE(file_text(far), file_text(folder / "a.best.csv"));
}

TEST_F(CommandRank, TheRefinedGripIsEvaluatedOnRequest) {
  const std::string grip = "PROGRAM grip " + result + " --vessel tumbler --rank 1 --json";
  const auto swept = parse_json(run(grip).output), refined = parse_json(run(grip + " --refined").output);
  EXPECT_EQ(swept["grip"]["height_m"], read_values(result, "best_height")[0]);
  EXPECT_EQ(refined["grip"]["height_m"], read_values(result, "best_refined_height")[0]);
  EXPECT_EQ(refined["grip"]["roll_rad"], read_values(result, "best_refined_roll")[0]);
  EXPECT_EQ(refined["score"], read_values(result, "best_refined_score")[0]);
  ASSERT_EQ(run("PROGRAM sweep small --on core --best 4 --no-refine -o " + result + " >/dev/null").code, 0);
  expect_error("grip " + result + " --vessel tumbler --rank 1 --refined", 2, "has no refined grip of rank 1");
}

// The terminal has a part of what the file has.
TEST_F(CommandRank, RowsAndColumnsAreShownOnRequest) {
  const auto shown = [](const std::string& command) {  // the rows of the list
    std::istringstream output(run("PROGRAM " + command).output);
    std::vector<std::string> rows;
    bool is_list = false;
    for (std::string line; std::getline(output, line); is_list = is_list || line.starts_with("  rank"))
      if (is_list && line.find_first_not_of(' ') == 5) rows.push_back(line);
    return rows;
  };
  const std::string rank = "rank " + result + " --best 7 --apart-mm 0", sweep = "sweep small --on core -o " + (folder / "b.nc");
  EXPECT_EQ(shown(rank).size(), 5u);
  EXPECT_EQ(shown(rank + " --list 6").size(), 6u);
  EXPECT_EQ(shown(rank + " --list 100").size(), 7u) << "there are no more";
  for (const std::string& command : {rank, sweep}) {
    const auto usual = shown(command), few = shown(command + " --list 2 --wide");
    ASSERT_EQ(few.size(), 2u) << command;
    EXPECT_GT(usual.size(), 2u);
    EXPECT_LT(usual[0].size(), 100u);
    EXPECT_GT(few[0].size(), usual[0].size());
    for (const char* bad : {"0", "-1", "2.5", "five", "1000000"})
      expect_error(command + " --list=" + bad, 2, std::string("--list '") + bad + "'; allowed: a whole number, 1 to 100000");
  }
}

// Rows of a list, each with its cells.
std::vector<std::vector<std::string>> list_rows(const std::string& path) {
  std::istringstream file(file_text(path));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    for (rows.emplace_back(); std::getline(cells, line, ',');) rows.back().push_back(line);
  }
  return rows;
}

// The grips of two sweeps compete for the places of one list.
TEST(RankSeveral, GripsOfOneRuleShareAList) {
  const SweptScene low(edited(RESULT_SCENE, "\"flask\"", "\"bottle\"")),
      high(edited(RESULT_SCENE, "roll_deg = [-90, -30, 0]", "roll_deg = [-80, -20, 10]"));
  const std::string list = low.folder / "list.csv";
  const Outcome outcome = run("PROGRAM rank " + low.path + " " + high.path + " --best 8 -o " + list + " 2>&1");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const auto rows = list_rows(list);
  const auto column = [&](const std::string& name) { return std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin(); };
  const auto vessel = column("vessel"), rank = column("rank"), score = column("score"), grip = column("grip"),
             sweep = column("sweep");
  // by hand: the lists of both, sorted
  std::vector<std::tuple<double, std::string, std::string>> expected;
  for (const SweptScene* swept : {&low, &high}) {
    const std::string own = swept->folder / "own.csv";
    ASSERT_EQ(run("PROGRAM rank " + swept->path + " --best 8 -o " + own + " >/dev/null").code, 0);
    for (const auto& row : list_rows(own))
      if (row[vessel] == "cup") expected.emplace_back(std::stod(row[score]), row[grip], row[sweep]);
  }
  std::stable_sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) { return std::get<0>(a) > std::get<0>(b); });
  expected.resize(8);
  std::map<std::string, std::vector<std::tuple<double, std::string, std::string>>> found;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    auto& own = found[rows[i][vessel]];
    own.emplace_back(std::stod(rows[i][score]), rows[i][grip], rows[i][sweep]);
    EXPECT_EQ(rows[i][rank], std::to_string(own.size()));
  }
  EXPECT_EQ(found["cup"], expected);
  std::set<std::string> sweeps;
  for (const auto& one : found["cup"]) sweeps.insert(std::get<2>(one));
  EXPECT_EQ(sweeps.size(), 2u) << "grips of both are among the best";
  EXPECT_EQ(found.size(), 3u) << "a cup of both, and a bottle and a flask of one each";
  const std::string rule = "; all have hand 'right, 187.2 x 83.2 mm, scale 1', strength 'none', robust settings 'none'\n\ncup: ";
  EXPECT_TRUE(outcome.output.starts_with("2 results ranked by score" + rule)) << outcome.output;
  const std::string both = "PROGRAM rank " + low.path + " " + high.path;
  const Outcome weighted = run(both + " --rank-by score --weights depth=1");
  EXPECT_TRUE(weighted.output.starts_with("2 results ranked by score with weights depth=1" + rule)) << weighted.output;
  EXPECT_EQ(run("PROGRAM rank " + low.path).output.find("ranked by"), std::string::npos) << "of one result there is no need";
  for (const SweptScene* swept : {&low, &high}) {
    EXPECT_NE(outcome.output.find("\n  " + swept->path + ": "), std::string::npos) << "counts: " << outcome.output;
    EXPECT_NE(outcome.output.find("  " + swept->path + "  "), std::string::npos) << "rows: " << outcome.output;
  }
  expect_error("grip " + low.path + " --vessel cup --rank 1 --list " + list, 2, "sweep");
}

TEST(RankSeveral, OtherRulesAreRefusedInALineThatNamesThem) {
  const SweptScene usual(RESULT_SCENE);
  const auto refused = [&](const std::string& text, const std::string& options, const std::string& message) {
    const SweptScene other(text);
    expect_error("rank " + usual.path + " " + other.path + options, 2, other.path + ": " + message);
  };
  const auto with = [](const std::string& table) { return edited(RESULT_SCENE, "[tilts]", table + "\n[tilts]"); };
  refused(with("[hand]\nscale = 0.9"), "",
          "hand 'right, 187.2 x 83.2 mm, scale 0.9', but 'right, 187.2 x 83.2 mm, scale 1' in " + usual.path +
              "; allowed: results of one hand");
  refused(with("[robust]\nroll_deg = 5"), "", "robust settings '64 deviations, seed 1, roll 5 deg', but 'none' in ");
  refused(edited(RESULT_SCENE, NO_EFFORTS, "[strength]\nthumb_N = 31\n"), "", "strength '31, ");
  refused(with("[arm]"), "", "arm 'shoulder at ");
  refused(with("[force]\nfriction = 0.7"), "", "force 'friction 0.7, ");
  refused(edited(RESULT_SCENE, "fills = [0, 0.6]", "fills = [0, 0.9]"), "", "states '4 tilts up to 135 deg, 2 fills', but ");
  refused(edited(RESULT_SCENE, "fills = [0, 0.6]", "fills = [0, 0.6]\npour = \"towards\""), "",
          "states '4 tilts up to 135 deg, 2 fills, poured towards the holder', but ");
  refused(with("[hand]\nbetween = 1"), "",
          "hand 'right, 187.2 x 83.2 mm, scale 1, other numbers than by default', but 'right, 187.2 x 83.2 mm, scale 1' in ");
  refused(with("[score]\nhold = 0.5"), "", "weights '");
  refused(with("[score]\nhold = 0.5"), " --weights depth=1", "weights '");
  const SweptScene other(with("[score]\nhold = 0.5"));
  EXPECT_EQ(run("PROGRAM rank " + usual.path + " " + other.path + " --weights hold=0.3 >/dev/null").code, 0) << "one rule for both";
  expect_error("rank " + usual.path + " " + usual.path, 2, "are the same file; name each result once");
  expect_error("rank " + usual.path + " " + other.path + " --weights hold=0.3 --glb 1 -o " + (usual.folder / "l.csv"), 2,
               "--glb: draws grips of one result");
}

TEST_F(CommandRank, WhatIsWrongIsOneLineAndNothingIsWritten) {
  std::ofstream(folder / "mine.txt") << "mine";
  std::ofstream(folder / "other.nc") << "\x89HDF\r\n\x1a\n";
  std::filesystem::copy_file(folder / "a.best.csv", folder / "other.best.csv");
  const std::string before = file_text(result), own = file_text(folder / "a.best.csv");
  const std::pair<std::string, std::string> cases[] = {
      {"rank /nonexistent.nc", "/nonexistent.nc: cannot be read"},
      {"rank " + result + " -o " + result, "this is the result file itself"},
      {"rank " + result + " -o " + (folder / "a.best.csv"), "this is the sweep's own list"},
      {"rank " + result + " -o " + (folder / "mine.txt"), "is there and is no list of grips"},
      {"rank " + result + " -o " + (folder / "other.best.csv"), "this is the sweep's own list of " + (folder / "other.nc")},
      {"rank " + result + " --glb 1", "--glb: the name of the list is missing"},
      {"rank " + result + " --best 0", "--best '0'; allowed"},
      {"rank " + result + " --apart-mm=-1", "--apart-mm '-1'; allowed: a number, 0 to 10000"},
      {"rank " + result + " --where 'fingers_usd > 1' -o " + list,
       "--where, column 1: there is no value 'fingers_usd'; the nearest is 'fingers_used'"},
      {"rank " + result + " --weights 'finger=1'", "--weights: there is no term 'finger'"},
      {"grip " + result + " --vessel tumbler", "this is a result, and the rank of the grip is missing; give --rank"},
      {"grip " + result + " --vessel tumbler --rank 5", "--rank 5: " + result + " lists 4 grips of tumbler"},
      {"grip " + result + " --vessel tumbler --rank 1 --height-mm 5", "excludes"},
      {"grip " + result + " --vessel tumbler --rank 1 --hand-scale 1", "--hand-scale: the sweep has one list for all"},
      {"grip small --vessel tumbler --height-mm 50 --refined", "--refined: the rank of the grip is missing; give --rank"},
      {"grip " + result + " --vessel tumbler --rank 1 --refined --list " + (folder / "a.best.csv"),
       "--refined: only the sweep's own list has refined grips"},
      {"grip small --vessel tumbler --list x", "--list: the rank of the grip is missing; give --rank"},
      {"grip " + result + " --vessel tumbler --rank 1 --list " + (folder / "mine.txt"), "is not a list of wholehand rank"},
      {"view " + result + " --list " + (folder / "none.csv"), "none.csv: cannot be read"},
      {"report " + result + " --list " + (folder / "mine.txt"), "is not a list of wholehand rank"},
  };
  for (const auto& [arguments, gist] : cases) expect_error(arguments, 2, gist);
  EXPECT_FALSE(file_exists(list));
  EXPECT_EQ(file_text(result), before);
  EXPECT_EQ(file_text(folder / "a.best.csv"), own);
}

}  // namespace
}  // namespace wholehand

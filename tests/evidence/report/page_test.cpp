// SPDX-License-Identifier: MIT
// The whole page of many kinds of sweeps: well-formed, self-contained, and with a word for everything that is not there.
// sanitizers: address
#include "evidence/report/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/charts/html.h"
#include "base/text/error.h"
#include "evidence/report/scene.h"
#include "evidence/report/source.h"
#include "sweeps/plan/variables.h"
#include "sweeps/rank/rank.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/program.h"
#include "tests/support/scenes.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

std::string page_of(const SweptScene& swept, const std::string& mesh_error = "") {
  sweeps::SweepResult result(swept.path);
  return report_page(result, swept.scene, mesh_error);
}

void expect_well_built(const SweptScene& swept, const std::string& page) {
  const std::string path = swept.folder / "page.html";
  std::ofstream(path) << page;
  // Debian's own python3, whatever else there is
  EXPECT_EQ(std::system(("/usr/bin/python3 " WHOLEHAND_SOURCE_DIR "/tests/evidence/report/page_test.py " + path).c_str()), 0);
}

// With one height and two rolls, the best is always at an end of the rolls.
TEST(ReportPage, TellsThatTheBestIsAtTheEndOfAnAxis) {
  const std::string rolls = edited(RESULT_SCENE, "[-90, -30, 0]", "[-30, 0]");
  const std::string line = "<p>The best grip lies on the edge of roll_deg; widen it?</p>";
  const std::string one_height = edited(edited(rolls, "{ from = 0.1, to = 0.95, count = 12 }", "0.5"), "[-10, 10]", "0");
  const SweptScene swept(one_height);
  EXPECT_TRUE(has(report_page(*swept.result, swept.scene, ""), line));
  const SweptScene still(edited(one_height, "[-30, 0]", "0"));
  EXPECT_FALSE(has(report_page(*still.result, still.scene, ""), "on the edge of"));
}

// A list need not be in the order of the scores: the page shows its first grip.
TEST(ReportPage, ShowsTheForcesOfTheFirstGripOfTheList) {
  const SweptScene swept(
      edited(edited(RESULT_SCENE, NO_EFFORTS, "[strength]\n"), "apart_mm = 0", "apart_mm = 0\nalso = [\"push\"]"));
  const std::string list = swept.folder / "firm.csv";
  ASSERT_EQ(run("PROGRAM rank " + swept.path + " --rank-by push -o " + list + " >/dev/null").code, 0);
  sweeps::SweepResult result(swept.path);
  const std::string page = report_page(result, swept.scene, "", list);
  result.use(swept.scene, *swept.plan);
  sweeps::RankRequest request;
  request.best = 5;
  request.by = sweeps::RankBy::push;
  const sweeps::Ranking ranking =
      sweeps::rank_grips(result, swept.scene, *swept.plan, request, [&] { return make_core_evaluator(swept.scene); });
  int reordered = 0;
  for (std::size_t v = 0; v < 2; ++v) {
    const std::vector<sweeps::BestGrip>& listed = ranking.lists[v];
    reordered +=
        std::any_of(listed.begin(), listed.end(), [&](const sweeps::BestGrip& grip) { return grip.score > listed[0].score; });
    EXPECT_TRUE(has(page, "The forces of the best grip: " + grip_text(*swept.plan, listed.at(0).grip) + ".")) << v;
  }
  EXPECT_GT(reordered, 0) << "else the order of the scores would say the same";
}

TEST(ReportPage, TellsEachAxisAsTheSceneDoes) {
  const auto text = [](const Axis& axis, bool is_sobol) {
    return axis_text(sweeps::PlanAxis("offset", "m", "", AXIS_OFFSET, axis, is_sobol), 1e3, " mm");
  };
  const std::vector<double> nine{0.05, 0.01, 0.02, 0.03, 0.09, 0.06, 0.07, 0.08, 0.04};
  for (const bool is_sobol : {false, true}) {
    EXPECT_EQ(text({{0.012}}, is_sobol), "12 mm");
    EXPECT_EQ(text({{0.02, 0.05, 0.01}}, is_sobol), "20, 50, 10 mm");
    EXPECT_EQ(text({nine}, is_sobol), "10 to 90 mm (9 values)");
    EXPECT_EQ(text({{0.01}, true}, is_sobol), "10 mm");
  }
  EXPECT_EQ(text({{0.01, 0.02, 0.03}, true}, false), "10 to 30 mm (3 values)");
  EXPECT_EQ(text({{0.01, 0.02, 0.03}, true}, true), "10 to 30 mm");
}

TEST(ReportPage, IsWellBuiltForEveryKindOfSweep) {
  const std::string keep = "best = 5\nkeep = ";
  const std::pair<const char*, std::string> kinds[] = {
      {"usual", RESULT_SCENE},
      {"left hand, shell", edited(edited(RESULT_SCENE, "[liquid]", "[hand]\nhandedness = \"left\"\n[liquid]"), "wall_mm = 1.5",
                                  "wall_mm = 1.5\nsurface = \"shell\"")},
      {"no tilts", edited(RESULT_SCENE, RESULT_TILTS, "")},
      {"no liquid", edited(RESULT_SCENE, RESULT_LIQUID, "")},
      {"neither", edited(edited(RESULT_SCENE, RESULT_LIQUID, ""), RESULT_TILTS, "")},
      {"rigged", edited(RESULT_SCENE, "name = \"cups\"", "name = \"cups\"\npose = \"rigged\"")},
      {"paper", edited(RESULT_SCENE, "name = \"cups\"", "pose = \"paper\"")},
      {"one grip", edited(edited(edited(edited(RESULT_SCENE, "{ from = 0.1, to = 0.95, count = 12 }", "0.5"), "[-90, -30, 0]", "0"),
                                 "[-10, 10]", "0"),
                          "[0, 60, 120]", "0")},
      {"one height in mm", edited(RESULT_SCENE, "height_fraction = { from = 0.1, to = 0.95, count = 12 }", "height_mm = 60")},
      {"every axis",
       edited(RESULT_SCENE, "roll_deg = [-90, -30, 0]", "roll_deg = [-90, 0]\noffset_mm = [0, 4]\nhand_scale = [0.9, 1.1]")},
      {"Sobol",
       edited(RESULT_SCENE, "roll_deg = [-90, -30, 0]", "roll_deg = { from = -90, to = 0 }\nsampling = \"sobol\"\ncount = 200")},
      {"one tilt, full", edited(edited(RESULT_SCENE, "[0, 45, 90, 135]", "[60]"), "[0, 0.6]", "[1]")},
      {"many fills", edited(RESULT_SCENE, "[0, 0.6]", "[0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1]")},
      {"nobody can hold", edited(RESULT_SCENE, "diameter_mm = 70", "diameter_mm = 300")},
      {"no friction", edited(RESULT_SCENE, "[tilts]", "[force]\nfriction = 0\n[tilts]")},
      {"nothing kept", edited(RESULT_SCENE, "best = 5", keep + "[]")},
      {"nothing kept nor listed", edited(RESULT_SCENE, "best = 5", "best = 0\nkeep = []")},
      {"score kept", edited(RESULT_SCENE, "best = 5", "best = 0\nkeep = [\"score\"]")},
      {"strength", edited(RESULT_SCENE, NO_EFFORTS, "[strength]\n[table]\n")},
      {"strength, no liquid", edited(edited(RESULT_SCENE, RESULT_LIQUID, ""), NO_EFFORTS, "")},
      {"strength, nothing holds", edited(RESULT_SCENE, NO_EFFORTS, "[force]\nfriction = 0\n")},
      {"strength, no tilts", edited(edited(RESULT_SCENE, RESULT_TILTS, ""), NO_EFFORTS, "[strength]\n")},
      {"strength, tilts left out",
       edited(edited(RESULT_SCENE, RESULT_TILTS, RESULT_TILTS + "\nuntil_poured = 0.5"), NO_EFFORTS, "")},
      {"strength, one tilt", edited(edited(RESULT_SCENE, RESULT_TILTS, "[tilts]\ndeg = [60]"), NO_EFFORTS, "")},
      {"vectors kept", edited(RESULT_SCENE, "best = 5", keep + "[\"posed\", \"score\", \"reason\"]")},
  };
  for (const auto& [kind, text] : kinds) {
    SCOPED_TRACE(kind);
    const SweptScene swept(text, Precision::single);
    expect_well_built(swept, page_of(swept));
  }
}

TEST(ReportPage, TellsInItsOrder) {
  const std::string page = page_of(SweptScene(RESULT_SCENE));
  std::size_t at = 0;
  for (const char* heading : {"<h1>Grips of cups</h1>", ">What was asked</h2>", ">How it ran</h2>", ">cup</h2>",
                              ">Score, fingers and force over height and roll</h3>", ">The best grips</h3>",
                              ">Forces over the tilt</h3>", ">Where pouring starts</h3>", ">Agreement with the core</h3>",
                              ">Touching, and the distance from a guidance point</h3>", ">flask</h2>", ">The words</h2>"}) {
    const std::size_t next = page.find(heading, at);
    ASSERT_NE(next, std::string::npos) << heading;
    at = next;
  }
}

TEST(ReportPage, OfAHandWithStrengthTellsWhatHoldingTakes) {
  const SweptScene swept(edited(RESULT_SCENE, NO_EFFORTS, "[strength]\n"));
  const std::string page = page_of(swept);
  std::size_t at = 0;
  for (const char* part :
       {">cup</h2>", ">The best grips</h3>", "This grip is good because ", "(margin ",
        ">Normal force of each digit, and its share of the strength at the opening of the grip, in the hardest state of "
        "cup</caption>",
        ">Limits of the best grips of cup</caption>", "A margin says how many times over", "Why each of the other grips is good",
        ">Forces over the tilt</h3>", ">Effort over the tilt</h3>", ">Where pouring starts</h3>", ">flask</h2>",
        ">What others call a held grasp</h2>", ">The words</h2>", ">effort</dt>"}) {
    const std::size_t next = page.find(part, at);
    ASSERT_NE(next, std::string::npos) << part;
    at = next;
  }
  EXPECT_TRUE(
      has(page, "strength of the digits in N at the best opening: thumb 40, index 25, middle 35, ring 25, little 14, palm 80"));
  EXPECT_EQ(has(page, "least worst effort over height and roll"), swept.result->find("worst_effort") != nullptr);
}

TEST(ReportPage, WithoutStrengthEffortIsNotSpokenOf) {
  const std::string page = page_of(SweptScene(RESULT_SCENE));
  EXPECT_TRUE(has(page, "The effort of the whole hand: the scene has no strengths."));
  for (const char* part : {">Effort over the tilt</h3>", "What others call", ">effort</dt>", "Normal force of each digit",
                           "This grip is good because ", ">margin</dt>"})
    EXPECT_FALSE(has(page, part)) << part;
}

TEST(ReportPage, EachHandScaleHasAListOfItsOwn) {
  const SweptScene swept(edited(RESULT_SCENE, "roll_deg = [-90, -30, 0]", "roll_deg = [-90, 0]\nhand_scale = [0.9, 1.1]"));
  const std::string page = page_of(swept);
  const std::size_t small = page.find(">The best grips at hand scale 0.9</h3>");
  const std::size_t large = page.find(">The best grips at hand scale 1.1</h3>", small);
  ASSERT_NE(large, std::string::npos);
  // each of its own grips: the score of its first is the first in its table
  sweeps::SweepResult result(swept.path);
  const sweeps::Plan plan(swept.scene, sweeps::keeps_vectors(result.variables()));
  result.use(swept.scene, plan);
  for (const auto& [place, scale] : {std::pair<std::size_t, std::size_t>{small, 0}, {large, 1}}) {
    const std::size_t row = page.find("<tbody>", page.find("<table", place));
    ASSERT_NE(row, std::string::npos);
    const std::string first = page.substr(row, page.find("</tr>", row) - row);
    EXPECT_TRUE(has(first, shown_number(result.best(0, scale).front().score, 3))) << first;
  }
  EXPECT_NE(shown_number(result.best(0, 0).front().score, 3), shown_number(result.best(0, 1).front().score, 3));
}

TEST(ReportPage, TellsOnWhatItRan) {
  const std::string page = page_of(SweptScene(RESULT_SCENE));
  for (const char* fact : {"core, 2 threads", "double precision", "wholehand 1.2.3", "12.50 s in all, 3.25 s of it in kernels",
                           "144 grips, 1,152 states", "result.nc, "})
    EXPECT_TRUE(has(page, fact)) << fact;
}

TEST(ReportPage, TheScenesTextIsTextAndNothingElse) {
  const SweptScene swept(
      edited(RESULT_SCENE, "[scene]", "# </pre></details><script>alert(1)</script> & <img src=x onerror=y>\n[scene]"));
  const std::string page = page_of(swept);
  EXPECT_FALSE(has(page, "<script"));
  EXPECT_FALSE(has(page, "<img src=x"));
  EXPECT_TRUE(has(page, "&lt;script&gt;alert(1)&lt;/script&gt; &amp; &lt;img src=x onerror=y&gt;"));
  EXPECT_TRUE(has(page, "# &lt;b&gt;bold &amp; &quot;quoted&quot;&lt;/b&gt;"));
  expect_well_built(swept, page);
}

TEST(ReportPage, NamesOfAnyLettersCannotBreakIt) {
  // a reader of scenes refuses them; a scene may come from elsewhere
  SweptScene swept(RESULT_SCENE);
  swept.scene.name = "<i>\"&'\x01\xff";
  for (VesselData& vessel : swept.scene.vessels) vessel.name = "</h2><script>" + vessel.name + "\"'&\xc3";
  const std::string page = page_of(swept);
  EXPECT_FALSE(has(page, "<script"));
  expect_well_built(swept, page);
}

TEST(ReportPage, WithoutTheMeshesWhatTheFileHoldsRemains) {
  const SweptScene swept(RESULT_SCENE);
  const std::string page = page_of(swept, "cup.glb: cannot be read: No such file or directory");
  expect_well_built(swept, page);
  EXPECT_TRUE(has(page, "best score over height and roll"));
  EXPECT_TRUE(has(page, "The best 5 grips of cup"));
  EXPECT_FALSE(has(page, "<img"));
  std::size_t sentences = 0;
  for (std::size_t at = page.find("cup.glb"); at != std::string::npos; at = page.find("cup.glb", at + 1)) ++sentences;
  EXPECT_GE(sentences, 4u) << "drawings, forces, agreement, guidance";
}

TEST(ReportPage, ASceneThatCannotBeMadeReadyIsNoReasonToFail) {
  SweptScene swept(RESULT_SCENE);
  swept.scene.vessels[0].wall = 1;  // thicker than the cup
  const std::string page = page_of(swept);
  EXPECT_TRUE(has(page, "left out: "));
  expect_well_built(swept, page);
}

#ifdef WHOLEHAND_PROGRAM

// From the sweep of a mesh to its page, by the program: as long as the mesh is there, and when it is not or another one.
TEST(ReportPage, OfAMeshSaysWhetherItIsStillThere) {
  const SweptScene other(RESULT_SCENE);  // a folder
  const std::string folder = other.folder.path(), result = folder + "/cup.nc", page = folder + "/cup.html";
  const ScopedVariable cache("XDG_CACHE_HOME", (folder + "/cache").c_str());
  const auto put = [&folder](const std::string& name, const std::string& text) {
    std::ofstream(folder + "/" + name, std::ios::binary) << text;
  };
  const auto report = [&] {
    const Outcome outcome = run("PROGRAM report " + result + " 2>&1");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    const std::string text = file_text(page);
    expect_well_built(other, text);
    return text;
  };
  put("cup.glb", glb_text(turned_mesh(beaker1(), 48, 2e-3)));
  put("cup.toml",
      "[[vessel]]\nname = \"cup\"\nmesh = \"cup.glb\"\ngrid_mm = 2\nmass_kg = 0.1\ncenter_of_mass_mm = [0, 50, 0]\nguidance_mm = "
      "[[50, 0]]\n"
      "[grips]\nheight_fraction = [0.3, 0.4, 0.5, 0.6]\nazimuth_deg = 10\nroll_deg = [-60, -30, 0]\n[tilts]\ndeg = [0, 45, 90]\n");
  ASSERT_EQ(run("PROGRAM sweep " + folder + "/cup.toml --on core -o " + result + " 2>&1").code, 0);
  const std::string whole = report();
  EXPECT_TRUE(has(whole, "no device was compared with it"));
  EXPECT_TRUE(has(whole, "point-biserial r"));
  EXPECT_TRUE(has(whole, "azimuth 10°"));
  std::filesystem::remove(folder + "/cup.glb");
  const std::string gone = report();
  EXPECT_TRUE(has(gone, "This part is left out: "));
  EXPECT_TRUE(has(gone, "best score over height and roll"));
  EXPECT_FALSE(has(gone, "<img"));
  put("cup.glb", glb_text(turned_mesh(beaker1(), 40, 2e-3)));
  EXPECT_TRUE(has(report(), "not what they were when the sweep ran"));
}

#endif

TEST(ReportPage, IsTheSameEachTime) {
  const SweptScene swept(RESULT_SCENE);
  EXPECT_EQ(page_of(swept), page_of(swept));
}

TEST(ReportPage, StaysSmall) {
  // bytes: a page that a phone opens; most of it are the drawings
  EXPECT_LT(page_of(SweptScene(RESULT_SCENE)).size(), 400u << 10);
}

TEST(LeftOut, NamesWhatTheSceneDoesNotNeed) {
  const auto all = [](const std::string& text) {
    std::string sentences;
    for (const std::string& sentence : left_out(*SweptScene(text).source)) sentences += sentence + "\n";
    return sentences;
  };
  const std::string usual = all(RESULT_SCENE);
  EXPECT_TRUE(has(usual, "2 of 3 azimuths"));
  EXPECT_TRUE(has(usual, "The inner wall"));
  EXPECT_TRUE(has(usual, "hold_force"));
  EXPECT_FALSE(has(usual, "The liquid"));
  EXPECT_TRUE(has(usual, "The table: the scene has no table"));
  EXPECT_FALSE(has(usual, "table_depth"));
  EXPECT_FALSE(has(all(edited(RESULT_SCENE, RESULT_TILTS, RESULT_TILTS + std::string("\n[table]\n"))), "The table"));
  EXPECT_TRUE(has(all(edited(RESULT_SCENE, RESULT_LIQUID, "")), "The liquid: the scene has no liquid."));
  EXPECT_TRUE(has(all(edited(RESULT_SCENE, RESULT_TILTS, "")), "The forces: the scene has no tilts."));
  EXPECT_TRUE(has(all(edited(RESULT_SCENE, "name = \"cups\"", "pose = \"rigged\"")), "the pose is rigged"));
  EXPECT_TRUE(has(all(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = []")), "the file holds only the best grips"));
}

TEST(OverwritesPage, OnlyPagesAreWrittenOver) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) -> std::string {
    try {
      check_overwrites_page(folder / name, folder / "result.nc");
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return error.what();
    }
    return "";
  };
  std::ofstream(folder / "result.nc") << "\x89HDF";
  std::ofstream(folder / "scene.toml") << RESULT_SCENE;
  const SweptScene swept(RESULT_SCENE);
  std::ofstream(folder / "page.html") << page_of(swept);
  std::ofstream(folder / "mine.html") << "<!DOCTYPE html>\n<html><head><title>My page</title></head></html>";
  std::ofstream(folder / "empty.html").close();
  std::filesystem::create_symlink("result.nc", folder / "link.html");
  EXPECT_EQ(refusal("new.html") + refusal("page.html") + refusal("empty.html"), "");
  EXPECT_TRUE(has(refusal("result.nc"), "this is the result file itself"));
  EXPECT_TRUE(has(refusal("link.html"), "this is the result file itself"));
  EXPECT_TRUE(has(refusal("scene.toml"), "is no page of wholehand's"));
  EXPECT_TRUE(has(refusal("mine.html"), "is no page of wholehand's"));
}

}  // namespace
}  // namespace wholehand

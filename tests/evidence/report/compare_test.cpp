// SPDX-License-Identifier: MIT
// Two results side by side: edits of a scene whose effect is known.
// sanitizers: address
#include "evidence/report/compare.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/program.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

// The scene with strengths of the digits, `share` of full ones.
std::string with_strength(double share = 1) {
  std::string table = "[strength]\n";
  for (const auto& [digit, full] :
       {std::pair("thumb", 40), {"index", 24}, {"middle", 36}, {"ring", 24}, {"little", 16}, {"palm", 80}})
    table += fmt::format("{}_N = {}\n", digit, share * full);
  return edited(RESULT_SCENE, NO_EFFORTS, table);
}

std::vector<ComparePart> compared(const std::string& a, const std::string& b) {
  SweptScene one(a), other(b);
  return compare_results(*one.result, one.scene, *other.result, other.scene);
}

// The cells behind a row's header.
std::vector<std::string> row_of(const ComparePart& part, const std::string& header) {
  for (const CompareTable& table : part.tables)
    for (const auto& row : table.rows)
      if (row[0] == header) return {row.begin() + 1, row.end()};
  ADD_FAILURE() << "no row " << header;
  return {"", "", ""};
}

TEST(CompareResults, HalfTheStrengthDoublesTheEffortsOfTheSameGrips) {
  const auto parts = compared(with_strength(), with_strength(0.5));
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].sentences, std::vector<std::string>{"Scores are not of one rule: other strength."});
  ASSERT_EQ(parts[0].changes.size(), 12u);
  EXPECT_EQ(parts[0].changes[0], "- [strength] index_N = 24");
  EXPECT_EQ(parts[0].changes[1], "+ [strength] index_N = 12");
  EXPECT_EQ(row_of(parts[0], "strength"), (std::vector<std::string>{"40, 24, 36, 24, 16, 80 N at the best opening",
                                                                    "20, 12, 18, 12, 8, 40 N at the best opening"}));
  SweptScene strong(with_strength()), weak(with_strength(0.5));
  for (std::size_t v = 0; v < 2; ++v) {
    const ComparePart& part = parts[v + 1];
    EXPECT_EQ(part.title, strong.scene.vessels[v].name);
    for (const char* same : {"grips", "feasible", "plausible"}) EXPECT_EQ(row_of(part, same)[2], "0") << same;
    std::vector<double> effort(strong.plan->grips()), plausible(effort.size());
    strong.result->read(*strong.result->find("worst_effort"), v, 0, 0, effort.size(), effort.data());
    strong.result->read(*strong.result->find("plausible"), v, 0, 0, plausible.size(), plausible.data());
    double least = INFINITY;
    for (std::size_t i = 0; i < effort.size(); ++i)
      if (plausible[i] == 1) least = std::min(least, effort[i]);
    ASSERT_TRUE(std::isfinite(least));
    const auto row = row_of(part, "least worst effort");
    EXPECT_EQ(row[0], fmt::format("{:.3f}", least));
    EXPECT_EQ(row[1], fmt::format("{:.3f}", 2 * least));
    // each of the first grips is where the other list has it, with twice the effort
    const CompareTable& grips = part.tables.at(1);
    const auto before = strong.result->best(v), now = weak.result->best(v);
    ASSERT_EQ(grips.rows.size(), before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      const auto there = std::find_if(now.begin(), now.end(), [&](const Candidate& c) { return c.index == before[k].index; });
      EXPECT_EQ(grips.rows[k][2], there == now.end() ? "not listed" : fmt::format("rank {}", there - now.begin() + 1));
      EXPECT_EQ(grips.rows[k][5], fmt::format("{:.3f}", effort[before[k].index]));
      EXPECT_EQ(grips.rows[k][6], fmt::format("{:.3f}", 2 * effort[before[k].index]));
    }
  }
}

TEST(CompareResults, SaysThatNothingDiffers) {
  const auto parts = compared(RESULT_SCENE, RESULT_SCENE);
  EXPECT_EQ(parts[0].sentences[0], "Nothing that is compared differs.");
  EXPECT_TRUE(parts[0].changes.empty() && parts[0].tables.empty());
  for (std::size_t v = 1; v <= 2; ++v) EXPECT_EQ(parts[v].sentences[0], "Both list the same 5 grips in the same order.");
  // comments and blank lines are no change
  const auto commented = compared(RESULT_SCENE, edited(RESULT_SCENE, "[liquid]\n", "# water\n\n  [liquid]\n"));
  EXPECT_EQ(commented[0].sentences[0], "Nothing that is compared differs.");
}

TEST(CompareResults, AHandThatNoLongerFitsHasAReason) {
  const std::string small = edited(RESULT_SCENE, "[liquid]", "[hand]\nscale = 0.6\n\n[liquid]");
  const auto parts = compared(RESULT_SCENE, small);
  EXPECT_EQ(parts[0].sentences[0], "Scores are not of one rule: other hand.");
  EXPECT_EQ(parts[0].changes, (std::vector<std::string>{"+ [hand]", "+ [hand] scale = 0.6"}));
  EXPECT_NE(row_of(parts[1], "feasible")[2][0], '+');
  std::size_t infeasible = 0;
  for (const auto& row : parts[1].tables.at(1).rows) infeasible += row[2].starts_with("infeasible: too wide") ? 1 : 0;
  EXPECT_GT(infeasible, 0u) << comparison_text(parts);

  // the other way round A lists none, and B's first grips have their reasons
  const auto back = compared(small, RESULT_SCENE);
  EXPECT_EQ(back[1].sentences[0], "A lists no grip of it.");
  const CompareTable& of_b = back[1].tables.at(1);
  EXPECT_EQ(std::vector<std::string>(of_b.columns.begin(), of_b.columns.begin() + 5),
            (std::vector<std::string>{"grip", "rank in B", "in A", "score B", "score A"}));
  const SweptScene usual(RESULT_SCENE);
  const auto listed = usual.result->best(0);
  ASSERT_EQ(of_b.rows.size(), listed.size());
  for (std::size_t k = 0; k < listed.size(); ++k) {
    EXPECT_EQ(of_b.rows[k][1], std::to_string(k + 1));
    EXPECT_EQ(of_b.rows[k][2], parts[1].tables[1].rows[k][2]);
    EXPECT_EQ(of_b.rows[k][3], fmt::format("{:.3f}", listed[k].score));
  }
}

TEST(CompareResults, NamesVesselsOfOneFileAndCutsLongChanges) {
  std::string edit = edited(edited(RESULT_SCENE, "\"flask\"", "\"bottle\""), "best = 5", "best = 0");
  edit +=
      "[score]\nhold = 0.5\n[[vessel]]\nname = \"third\"\nshape = \"cylinder\"\ndiameter_mm = 60\nheight_mm = 95\nwall_mm = 1.5\n";
  edit += "guidance_mm = [\n";
  for (int k = 0; k < 20; ++k) edit += fmt::format("[{}, 0],\n", 20 + k);
  const auto parts = compared(RESULT_SCENE, edit + "]\n");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].sentences, (std::vector<std::string>{"Scores are not of one rule: other weights.", "Only A has flask.",
                                                          "Only B has bottle, third."}));
  EXPECT_EQ(parts[0].changes.size(), 21u);
  EXPECT_TRUE(parts[0].changes.back().ends_with(" more")) << parts[0].changes.back();
  EXPECT_EQ(parts[1].sentences[0], "B lists no grip of it.");
}

TEST(CompareResults, ReadsResultsOnlyAndWritesPagesOverPages) {
  const SweptScene strong(with_strength()), weak(with_strength(0.5));
  const std::string page = strong.folder / "page.html", foreign = strong.folder / "mine.html";
  const std::string both = "compare " + strong.path + " " + weak.path;
  for (int k = 0; k < 2; ++k) {
    const Outcome outcome = run("PROGRAM " + both + " -o " + page + " 2>&1");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_TRUE(has(outcome.output, "Scores are not of one rule: other strength.") && has(outcome.output, "wrote " + page))
        << outcome.output;
  }
  EXPECT_EQ(std::system(("/usr/bin/python3 " WHOLEHAND_SOURCE_DIR "/tests/evidence/report/page_test.py " + page).c_str()), 0);
  write_file(foreign, "<html>mine</html>");
  expect_error(both + " -o " + foreign, 2, "mine.html");
  expect_error(both + " -o " + weak.path, 2, "this is the result file itself");
  expect_error("compare " + strong.path + " " + strong.folder.path() + "/./result.nc", 2, "are the same file; name two results");
  expect_error("compare " + strong.path + " " + foreign, 2, "is a web page (HTML)");
  expect_error("compare " + strong.path + " " + strong.folder.path() + "/none.nc", 2, "cannot be read");
  std::string damaged = file_text(weak.path);
  const std::size_t at = damaged.find("thumb_N = 20");
  ASSERT_NE(at, std::string::npos);
  damaged[at + 10] = '9';
  write_file(foreign, damaged);
  expect_error("compare " + strong.path + " " + foreign, 2, "mine.html: ");
  EXPECT_EQ(file_text(foreign), damaged);
}

}  // namespace
}  // namespace wholehand

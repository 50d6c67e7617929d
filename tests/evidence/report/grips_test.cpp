// SPDX-License-Identifier: MIT
// The best grips: their numbers, their drawings cut out of the whole one, and the text where there are none.
// sanitizers: address
#include "evidence/report/grips.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <regex>
#include <vector>

#include "core/core_backend.h"
#include "sweeps/grips/svg.h"
#include "sweeps/lists/refine.h"
#include "sweeps/result/result_contents.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

std::string written_grips(const SweptScene& swept, std::size_t vessel) {
  MarkupWriter html;
  write_grips(html, *swept.source, vessel, read_grips(*swept.source, vessel), "v");
  EXPECT_TRUE(html.is_closed());
  return html.written();
}

std::size_t times_in(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(ReportGrips, AreTheFilesWithTheCoresNumbers) {
  const SweptScene swept(RESULT_SCENE);
  const ReportedGrips best = read_grips(*swept.source, 1);
  ASSERT_TRUE(best.is_whole);
  ASSERT_EQ(best.grips.size(), 5u);
  const auto listed = swept.result->best(1);
  for (std::size_t rank = 0; rank < 5; ++rank) {
    const sweeps::BestGrip& grip = best.grips[rank];
    EXPECT_EQ(grip.rank, rank + 1);
    EXPECT_EQ(grip.score, listed[rank].score);
    EXPECT_EQ(grip.candidate.index, listed[rank].index);
    GripResult result;
    swept.source->core->grip(1, grip.grip, result);
    EXPECT_EQ(grip.gap, result.gap);
    EXPECT_EQ(grip.fingers_used, std::popcount(result.used_mask));
    const GripScore score = swept.source->core->score(1, grip.grip, result);
    EXPECT_EQ(grip.peak_force, std::max(score.fills[0].peak_force, score.fills[1].peak_force));
  }
}

TEST(ReportGrips, TableHasARowForEachAndADrawingForTheFirst) {
  const std::string html = written_grips(SweptScene(RESULT_SCENE), 0);
  EXPECT_EQ(times_in(html, "<th scope=\"row\">"), 5u);
  EXPECT_EQ(times_in(html, "<img src=\"data:image/svg+xml,"), DRAWN_GRIPS);
  EXPECT_EQ(times_in(html, "alt=\"Front and side view of the hand on cup"), DRAWN_GRIPS);
  for (const char* column : {"height (mm)", "roll (°)", "obliquity (°)", "peak force (N)", "hold force (N)", "safe tilt (°)"})
    EXPECT_EQ(times_in(html, std::string(">") + column + "</th>"), 1u) << column;
  EXPECT_EQ(html.find("azimuth (°)"), std::string::npos) << "one stands for all";
}

// Beside each grip its refined score and place; a grip that was not refined has neither, and the swept grips stay as they are.
TEST(ReportGrips, RefinedGripsAreToldBesideTheSweptOnes) {
  const std::string before = written_grips(SweptScene(RESULT_SCENE), 0);
  EXPECT_EQ(before.find("efined"), std::string::npos) << "nothing was refined";
  SweptScene swept(RESULT_SCENE);
  const auto listed = swept.result->best(0);
  // each rank has its own place in its box; the second has none
  std::vector<double> scores;
  std::array<std::vector<double>, sweeps::REFINED_COORDINATES> places;
  std::vector<GripInput> grips;
  for (std::size_t rank = 0; rank < listed.size(); ++rank) {
    const sweeps::RefineBox box = sweeps::refine_box(*swept.plan, 0, listed[rank].index);
    std::array<double, sweeps::REFINED_COORDINATES> place{};
    scores.push_back(rank == 1 ? std::nan("") : 0.9871 - 0.01 * static_cast<double>(rank));
    for (std::size_t k = 0; k < place.size(); ++k) {
      place[k] = box.low[k] + (box.high[k] - box.low[k]) * (0.3 + 0.05 * static_cast<double>(rank));
      places[k].push_back(rank == 1 ? std::nan("") : place[k]);
    }
    grips.push_back(sweeps::with_coordinates(swept.plan->grip(0, listed[rank].index), place));
  }
  swept.change("best_refined_score", scores);
  for (std::size_t k = 0; k < places.size(); ++k)
    swept.change(sweeps::refined_axis_name(swept.plan->axes()[static_cast<std::size_t>(sweeps::REFINED_PLACES[k])]), places[k]);
  const ReportedGrips best = read_grips(*swept.source, 0);
  EXPECT_EQ(best.grips[0].refined_score, 0.9871);
  EXPECT_EQ(best.grips[2].refined.height, grips[2].height);
  EXPECT_TRUE(std::isnan(best.grips[1].refined_score));
  EXPECT_EQ(best.grips[0].score, listed[0].score);
  EXPECT_EQ(best.grips[0].grip.height, swept.plan->grip(0, listed[0].index).height);
  const std::string html = written_grips(swept, 0);
  for (const char* column : {"refined score", "refined grip"})
    EXPECT_EQ(times_in(html, std::string(">") + column + "</th>"), 1u) << column;
  for (const std::size_t rank : {0, 2}) {
    const std::string text = grip_text(*swept.plan, grips[rank]);
    EXPECT_NE(text, grip_text(*swept.plan, swept.plan->grip(0, listed[rank].index)));
    const std::string cells = "<td>" + shown_number(scores[rank], 3) + "</td>\n<td>" + text + "</td>";
    EXPECT_EQ(times_in(html, cells), 1u) << cells << html;
  }
  EXPECT_EQ(times_in(html, grip_text(*swept.plan, grips[1])), 0u);
  EXPECT_EQ(times_in(html, "within half a step of the axes"), 1u);
  EXPECT_EQ(times_in(html, "<th scope=\"row\">"), times_in(before, "<th scope=\"row\">"));
}

// Each grip has its score at random deviations beside it; without [robust] there is none.
TEST(ReportGrips, RobustScoresAreToldBesideTheScores) {
  EXPECT_EQ(written_grips(SweptScene(RESULT_SCENE), 1).find("obust"), std::string::npos);
  SweptScene swept(edited(RESULT_SCENE, "[tilts]", "[robust]\nroll_deg = 5\ncount = 48\n[tilts]"));
  std::vector<double> means, lows, shares(10, 0.875);
  for (int place = 0; place < 10; ++place) {  // five of each of two vessels
    means.push_back(0.9012 - 0.01 * place);
    lows.push_back(0.5023 - 0.02 * place);
  }
  swept.change("best_robust_mean", means);
  swept.change("best_robust_low", lows);
  swept.change("best_robust_share", shares);
  const ReportedGrips best = read_grips(*swept.source, 1);
  ASSERT_EQ(best.grips.size(), 5u);
  EXPECT_EQ(best.grips[0].robust.mean, means[5]);
  EXPECT_EQ(best.grips[4].robust.low, lows[9]);
  const std::string html = written_grips(swept, 1);
  for (const char* column : {"robust low", "robust mean", "share that holds"})
    EXPECT_EQ(times_in(html, std::string(">") + column + "</th>"), 1u) << column;
  for (std::size_t place = 5; place < 10; ++place) {
    const std::string cells = "<td>" + shown_number(lows[place], 3) + "</td>\n<td>" + shown_number(means[place], 3) +
                              "</td>\n<td>" + shown_number(0.875, 2) + "</td>";
    EXPECT_EQ(times_in(html, cells), 1u) << cells << html;
  }
  EXPECT_EQ(times_in(html, "at 48 random deviations by [robust]"), 1u);
}

TEST(ReportGrips, EachDrawingHasItsForcesAndAVerdict) {
  const std::string html = written_grips(SweptScene(edited(RESULT_SCENE, NO_EFFORTS, "[strength]\n")), 0);
  EXPECT_GT(times_in(html, "class=%22force%22"), 2 * DRAWN_GRIPS) << "arrows in two views";
  EXPECT_EQ(times_in(html, "<p>This grip is good because "), DRAWN_GRIPS);
  EXPECT_EQ(times_in(html, "; longest arrow "), DRAWN_GRIPS);
  EXPECT_EQ(times_in(html, " Arrows show the forces of the hand: longest arrow "), 2 * DRAWN_GRIPS) << "page and drawing say so";
  EXPECT_EQ(times_in(html, "Arrows show the forces of the hand on the vessel in the state that takes most effort."), 1u);
  const std::string without = written_grips(SweptScene(RESULT_SCENE), 0);
  EXPECT_EQ(times_in(without, "class=%22force%22") + times_in(without, "longest arrow") + times_in(without, "Arrows"), 0u);
}

TEST(ReportGrips, WithoutTiltsTheyAreAntipodalOrNot) {
  const std::string html = written_grips(SweptScene(edited(RESULT_SCENE, "[tilts]\ndeg = [0, 45, 90, 135]", "")), 0);
  EXPECT_NE(html.find(">antipodal</th>"), std::string::npos);
  EXPECT_EQ(html.find("force (N)"), std::string::npos);
}

TEST(ReportGrips, ManyAreCutAndCounted) {
  const SweptScene swept(edited(RESULT_SCENE, "best = 5", "best = 60"));
  const ReportedGrips best = read_grips(*swept.source, 1);
  EXPECT_EQ(best.grips.size(), TABLED_GRIPS);
  EXPECT_EQ(best.listed, swept.result->best(1).size());
  ASSERT_GT(best.listed, TABLED_GRIPS);
  EXPECT_NE(written_grips(swept, 1).find("The sweep listed " + std::to_string(best.listed)), std::string::npos);
}

TEST(ReportGrips, NoneAskedAndNoneThereAreSaid) {
  EXPECT_NE(written_grips(SweptScene(edited(RESULT_SCENE, "best = 5", "best = 0")), 0).find("not asked to list grips"),
            std::string::npos);
  EXPECT_NE(
      written_grips(SweptScene(edited(RESULT_SCENE, "diameter_mm = 70", "diameter_mm = 300")), 0).find("There are no best grips"),
      std::string::npos);
}

TEST(ReportGrips, WithoutTheCoreThePlacesRemain) {
  SweptScene swept(RESULT_SCENE);
  swept.source->core = nullptr;
  swept.source->no_core = "cup.glb: is not there";
  const std::string html = written_grips(swept, 0);
  EXPECT_EQ(times_in(html, "<th scope=\"row\">"), 5u);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(html.find("closure"), std::string::npos);
  EXPECT_NE(html.find("left out: cup.glb: is not there"), std::string::npos);
}

// ---- the drawing's part ----

std::string drawing() {
  const SweptScene swept(RESULT_SCENE);
  const auto& source = *swept.source;
  const GripInput grip = source.plan.grip(0, swept.result->best(0)[0].index);
  return sweeps::grip_svg(
      source.scene, 0,
      sweeps::make_grip_report(source.scene, 0, grip, {}, sweeps::core_grip_methods(source.scene, source.core, "core")));
}

std::array<double, 4> box_of(const std::string& svg) {
  std::smatch found;
  EXPECT_TRUE(std::regex_search(svg, found, std::regex(R"re(viewBox="([-\d.]+) ([-\d.]+) ([-\d.]+) ([-\d.]+)")re")));
  return {std::stod(found[1]), std::stod(found[2]), std::stod(found[3]), std::stod(found[4])};
}

TEST(FrontAndSide, LeavesTwoViewsAndNothingElse) {
  const std::string whole = drawing(), part = front_and_side(whole);
  for (const char* view : {"front", "side"})
    EXPECT_NE(part.find(std::string("<g id=\"") + view + "\">"), std::string::npos) << view;
  for (const char* gone : {"<g id=\"top\">", "<g id=\"legend\">", "brought to the glass"})
    EXPECT_EQ(part.find(gone), std::string::npos) << gone;
  EXPECT_LT(part.size(), whole.size());
  // the front view as it was
  const std::size_t begin = whole.find("<g id=\"front\">"), end = whole.find("</g>", begin);
  EXPECT_NE(part.find(whole.substr(begin, end - begin)), std::string::npos);
}

TEST(FrontAndSide, ItsBoxHoldsWhatIsDrawn) {
  const std::string part = front_and_side(drawing());
  const auto box = box_of(part);
  const std::regex point(R"re(c?x="([-\d.]+)" c?y="([-\d.]+)")re");
  int points = 0;
  for (std::sregex_iterator p(part.begin(), part.end(), point), end; p != end; ++p, ++points) {
    EXPECT_GT(std::stod((*p)[1]), box[0]);
    EXPECT_LT(std::stod((*p)[1]), box[0] + box[2]);
    EXPECT_GT(std::stod((*p)[2]), box[1]);
    EXPECT_LT(std::stod((*p)[2]), box[1] + box[3]);
  }
  EXPECT_GT(points, 20);
}

TEST(FrontAndSide, WhatIsNoSuchDrawingStays) {
  for (const char* other : {"", "<svg/>", "<svg viewBox=\"0 0 10 10\"><style></style><text x=\"1\">front</text></svg>"})
    EXPECT_EQ(front_and_side(other), other);
}

}  // namespace
}  // namespace wholehand

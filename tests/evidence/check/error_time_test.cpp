// SPDX-License-Identifier: MIT
// The tables of error against run time: figures, fronts, reports and variants.
// sanitizers: none
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/charts/colors.h"
#include "evidence/check/error_plot.h"
#include "evidence/check/error_table.h"
#include "evidence/check/error_variants.h"
#include "tests/support/drawn.h"
#include "tests/support/files.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

// ---- figures ----

TEST(ErrorTime, FiguresAreNearestRanks) {
  std::vector<double> errors;
  std::vector<std::string> where;
  for (int k = 1; k <= 2000; ++k) {
    errors.push_back((k * 7) % 2001);
    where.push_back(std::to_string(k));
  }
  const ErrorFigures figures = error_figures(errors, where);
  EXPECT_EQ(figures.median, 1000);
  EXPECT_EQ(figures.p999, 1998);
  EXPECT_EQ(figures.max, 2000);
  EXPECT_EQ(errors[std::stoul(figures.worst) - 1], 2000);
  EXPECT_EQ(figures.compared, 2000u);
}

TEST(ErrorTime, FiguresTakeWhatIsNoNumberForTheWorst) {
  const ErrorFigures figures = error_figures({1, std::numeric_limits<double>::quiet_NaN(), 2}, {"a", "b", "c"});
  EXPECT_EQ(figures.median, 2);
  EXPECT_TRUE(std::isinf(figures.max));
  EXPECT_EQ(figures.worst, "b");
  EXPECT_TRUE(std::isnan(error_figures({}, {}).median));
  EXPECT_EQ(error_figures({3, 3}, {"first", "second"}).worst, "first");
}

ErrorRow row_of(const std::string& name, double microseconds, double micrometers) {
  ErrorRow row;
  row.variant.name = name;
  row.errors.fill(error_figures({}, {}));
  row.errors[ERROR_GAP] = error_figures({micrometers}, {"0:0"});
  row.seconds_per_grip = microseconds * 1e-6;
  return row;
}

// A machine that is half as fast for a while: what is timed then, is as many times the base as it would be otherwise.
TEST(ErrorTime, TimesAreByTheBaseBesideThem) {
  const std::vector<double> base_before{1, 1.1, 1}, base_after{2, 2, 2.2}, base{1, 1.1, 1, 2, 2, 2.2};
  EXPECT_DOUBLE_EQ(time_figures({3, 3.3, 3}, base_before, base).median, time_figures({6, 6.6, 6}, base_after, base).median);
  EXPECT_DOUBLE_EQ(time_figures({3, 3.3, 3}, base_before, base).spread, time_figures({6, 6.6, 6}, base_after, base).spread);
  EXPECT_DOUBLE_EQ(time_figures({5, 3, 4}).median, 4);
  EXPECT_DOUBLE_EQ(time_figures({5, 3, 4}).spread, 2);
  EXPECT_DOUBLE_EQ(time_figures({5, 3, 4}, {0, 0}, {0, 0}).median, 4);
  EXPECT_EQ(time_figures({}).median, 0);
}

TEST(ErrorTime, FrontIsWhatNothingBeats) {
  const std::vector<ErrorRow> rows{row_of("slow exact", 9, 0.1), row_of("beaten", 5, 7), row_of("fast rough", 1, 50),
                                   row_of("middle", 4, 5)};
  std::vector<std::string> names;
  for (const ErrorRow* row : pareto_front(rows, &ErrorRow::length_error)) names.push_back(row->variant.name);
  EXPECT_EQ(names, (std::vector<std::string>{"fast rough", "middle", "slow exact"}));
  EXPECT_TRUE(pareto_front(rows, &ErrorRow::force_error).empty());
}

TEST(ErrorTime, ReportNamesTheFastestUnderEachError) {
  const std::vector<ErrorRow> rows{row_of("slow exact", 9, 0.1), row_of("fast rough", 1, 50), row_of("middle", 4, 5)};
  const std::string report = error_report(rows, {});
  EXPECT_NE(report.find("| 1 um | slow exact | 9 us | 0.1 um |"), report.npos) << report;
  EXPECT_NE(report.find("| 10 um | middle |"), report.npos) << report;
  EXPECT_NE(report.find("| 100 um | fast rough |"), report.npos) << report;
}

TEST(ErrorTime, ReportHasItsHeadings) {
  ErrorRow points = row_of("liquid", 1, 0), left_out = row_of("smaller", 1, 0), effort = row_of("rough", 1, 0);
  effort.variant.axis = SweptAxis::effort;
  points.variant.axis = SweptAxis::points;
  points.liquid_seconds = 1e-6;
  left_out.variant.left_out = "much";
  ErrorContext context;
  context.scene = "cups";
  std::istringstream report(error_report({row_of("core", 1, 0), points, effort, left_out}, context));
  std::vector<std::string> headings;
  for (std::string line; std::getline(report, line);)
    if (line.starts_with('#')) headings.push_back(line);
  EXPECT_EQ(headings,
            (std::vector<std::string>{"# Error against run time: cups", "## The fastest variant under an error",
                                      "## Observed orders of convergence", "## Left out, left in", "## Efforts", "## The liquid"}));
}

// What answers where others do not, or nowhere, is not the best for having few answers to be wrong in.
TEST(ErrorTime, WhatDoesNotCompareIsNotChosen) {
  std::vector<ErrorRow> rows{row_of("sound", 9, 0.1), row_of("mute", 1, 0), row_of("fickle", 2, 0), row_of("limp", 3, 0.05)};
  for (ErrorRow& row : rows) {
    row.grips = 2000;
    row.feasible_flips = 2;  // as many as a 99.9th percentile leaves out
    row.errors[ERROR_FEEDBACK] = error_figures(std::vector<double>(2000, 1e-5), std::vector<std::string>(2000));
  }
  rows[1].errors.fill(error_figures({}, {}));
  rows[2].feasible_flips = 3;
  rows[3].hold_flips = 3;
  EXPECT_TRUE(std::isnan(rows[1].length_error()) && std::isnan(rows[1].force_error()));
  EXPECT_TRUE(std::isinf(rows[3].force_error()));
  const auto names = [&](double (ErrorRow::*error)() const) {
    std::vector<std::string> front;
    for (const ErrorRow* row : pareto_front(rows, error)) front.push_back(row->variant.name);
    return front;
  };
  EXPECT_EQ(names(&ErrorRow::length_error), (std::vector<std::string>{"limp"}));
  EXPECT_EQ(names(&ErrorRow::force_error), (std::vector<std::string>{"sound"}));
  ErrorContext context;
  context.states = 10;
  const std::string report = error_report(rows, context);
  for (const char* text : {"| 1 um | limp |", "| 1 mN | sound |", "none of their grips could be compared: mute.\n",
                           "on one side only (number of grips): fickle (3).\n", "infinite error of force): limp (3).\n",
                           "With so few grips compared (1), the 99.9th percentile is the largest"})
    EXPECT_NE(report.find(text), report.npos) << text << " in " << report;
  for (const PictureFile& file : front_files(front_pictures("", rows, context), rows)) {
    EXPECT_FALSE(has(file.svg, "mute"));
    EXPECT_FALSE(has(file.svg, "fickle"));
  }
  EXPECT_TRUE(front_pictures("", {rows[1]}, context).empty());
}

// ---- variants ----

TEST(ErrorTime, VariantsHaveNamesOfTheirOwn) {
  Scene scene = three_beakers();
  scene.strength.emplace();
  for (const bool quick : {false, true}) {
    const auto variants = error_variants(scene, {quick, 2, true, true, true, true});
    std::set<std::string> names;
    for (const ErrorVariant& variant : variants) EXPECT_TRUE(names.insert(variant.name).second) << variant.name;
    for (const char* name :
         {"core double: 1 thread", "Vulkan double", "core double: tolerance 1e-3 m", "core double: 16 steps",
          "core double: gap table 257", "core double: liquid 4 points", "core double: grid 64^3 x 16 bits",
          "Vulkan float: grid 128^3 x 32 bits", "core double: effort tolerance 1e-5", "Vulkan float: effort tolerance 1e-1",
          "Vulkan float: outline from a buffer", "core double: pose rigged", "core double: shell", "Vulkan float: without liquid"})
      EXPECT_TRUE(names.contains(name)) << name << (quick ? ", quick" : "");
  }
}

TEST(ErrorTime, VariantsLeaveOutWhatTheSceneLacks) {
  Scene scene = scene_of({ledges()});  // no wall, no liquid, no tilts
  for (const ErrorVariant& variant : error_variants(scene, {false, 1, true, false, false, false})) {
    EXPECT_EQ(variant.name.find("liquid"), std::string::npos) << variant.name;
    EXPECT_EQ(variant.name.find("shell"), std::string::npos) << variant.name;
    EXPECT_EQ(variant.name.find("effort"), std::string::npos) << variant.name;
    EXPECT_FALSE(!variant.on_core && variant.precision == Precision::full) << variant.name;
    EXPECT_FALSE(!variant.on_core && variant.options.lattice_samples == 0) << variant.name;
  }
  for (const ErrorVariant& variant : error_variants(three_beakers(), {false, 2, false, false, false, false}))
    EXPECT_TRUE(variant.on_core);
}

TEST(ErrorTime, FrontsAreDrawn) {
  std::vector<ErrorRow> rows{row_of("slow 'exact'", 9, 0), row_of("fast <rough>", 1, 50), row_of("middle", 4, 5),
                             row_of("beaten", 8, 50)};
  rows[1].errors[ERROR_FEEDBACK] = error_figures({1e-3}, {"0:0"});
  const TemporaryFolder folder;
  const auto pictures = front_pictures(folder.path(), rows, {});
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(write_pictures(front_files(pictures, rows)), "");
  const std::string svg = file_text(folder / "error-time.svg");
  expect_well_formed(svg);
  expect_well_formed(file_text(folder / "error-time-force.svg"));
  for (const char* text : {">slow &#39;exact&#39;</text>", ">fast &lt;rough&gt;</text>", ">middle</text>",
                           "time of a grip (\u00b5s)", "core double", "length&#39;s error (\u00b5m)"})
    EXPECT_TRUE(has(svg, text)) << text;
  EXPECT_FALSE(has(svg, ">beaten</text>")) << "only the front is named";
  EXPECT_EQ(drawn_marks(svg, color_text(okabe_ito::BLUE)), rows.size() + 1) << "and one in the legend";
  // the axes end at a 1, 2 or 5 beyond the values: 0.5 to 10 us; an error of 0 is drawn at 1e-9 um
  const DrawnAxes axes = drawn_axes(svg).at(0);
  const auto front = drawn_lines(svg, "#a0a0a0").at(0);
  ASSERT_EQ(front.size(), 3u);
  const auto fast = axes.share(front[0]), middle = axes.share(front[1]), slow = axes.share(front[2]);
  EXPECT_NEAR(fast[1], std::log(1 / 0.5) / std::log(10 / 0.5), 1e-3);
  EXPECT_NEAR(middle[1], std::log(4 / 0.5) / std::log(10 / 0.5), 1e-3);
  EXPECT_NEAR(slow[0], std::log(1e-9 / 5e-10) / std::log(100 / 5e-10), 1e-3);
  EXPECT_NEAR(fast[0], std::log(50 / 5e-10) / std::log(100 / 5e-10), 1e-3);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Box plots: the five numbers by hand, and what is drawn where its value is.
// sanitizers: address
#include "base/charts/box_plot.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "base/charts/style.h"
#include "tests/support/drawn.h"
#include "tests/support/files.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

constexpr double BOX_TENTH = 0.051;  // units: coordinates are written to a tenth

// ---- numbers ----

// By linear interpolation as numpy.percentile: quartiles of 1 .. 9 are 3, 5 and 7, so whiskers reach from -3 to 13.
TEST(Box, OfAFewValues) {
  const Box box = box_of(std::vector<double>{9, 1, 8, 2, 7, 3, 6, 4, 5});
  EXPECT_EQ(box.count, 9u);
  EXPECT_DOUBLE_EQ(box.lower_quartile, 3);
  EXPECT_DOUBLE_EQ(box.median, 5);
  EXPECT_DOUBLE_EQ(box.upper_quartile, 7);
  EXPECT_EQ(box.low, 1);
  EXPECT_EQ(box.high, 9);
  EXPECT_TRUE(box.outliers.empty());
}

// Quartiles 3 and 7 again, so whiskers reach from -3 to 13.
TEST(Box, WhatIsFurtherThanTheWhiskersIsAnOutlier) {
  const Box box = box_of(std::vector<double>{-30, 3, 3, 3, 4, 5, 6, 7, 7, 13, 13.001});
  EXPECT_DOUBLE_EQ(box.lower_quartile, 3);
  EXPECT_DOUBLE_EQ(box.upper_quartile, 7);
  EXPECT_EQ(box.low, 3);
  EXPECT_EQ(box.high, 13) << "at 1.5 ranges it is within";
  EXPECT_EQ(box.outliers, (std::vector<double>{-30, 13.001}));
  EXPECT_EQ(box.outliers_beside, 0u);
}

// The lower quartile lies between 0 and 100, and no value lies between it and the end of the whisker.
TEST(Box, AWhiskerNeverEndsInTheBox) {
  const Box box = box_of(std::vector<double>{0, 100, 100, 100});
  EXPECT_DOUBLE_EQ(box.lower_quartile, 75);
  EXPECT_EQ(box.low, 75);
  EXPECT_EQ(box.outliers, (std::vector<double>{0}));
}

TEST(Box, OfNothingOneAndNoNumber) {
  EXPECT_EQ(box_of({}).count, 0u);
  EXPECT_EQ(box_of(std::vector<double>{std::nan(""), HUGE_VAL, -HUGE_VAL}).count, 0u);
  const Box one = box_of(std::vector<double>{std::nan(""), 4});
  EXPECT_EQ(one.count, 1u);
  for (const double number : {one.low, one.lower_quartile, one.median, one.upper_quartile, one.high}) EXPECT_EQ(number, 4);
}

// 1,000 equal values have no range, so all 200 others are beyond it.
std::vector<double> many_outliers() {
  std::vector<double> values(1000, 5.0);
  for (int k = 1; k <= 100; ++k) {
    values.push_back(5 + 0.1 * k);
    values.push_back(5 - 0.04 * k);
  }
  return values;
}

TEST(Box, OfManyOutliersSomeAreKept) {
  const Box box = box_of(many_outliers());
  ASSERT_EQ(box.outliers.size(), Box::MOST_OUTLIERS);
  EXPECT_EQ(box.outliers_beside, 200 - Box::MOST_OUTLIERS);
  EXPECT_DOUBLE_EQ(box.outliers.front(), 1);
  EXPECT_DOUBLE_EQ(box.outliers.back(), 15);
  EXPECT_TRUE(std::is_sorted(box.outliers.begin(), box.outliers.end()));
}

// ---- what is drawn ----

BoxChart two_groups() {
  BoxChart chart;
  chart.name = {"times", "title <1>", "Times of two parts."};
  chart.y_label = "time (s)";
  chart.mark = "paper: mean and SD";
  chart.groups.push_back({"lift", box_of(std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 30})});
  chart.groups.push_back({"tilt", box_of(std::vector<double>{11, 12, 13, 14, 15}), BoxChart::Mark{20, 5}});
  return chart;
}

std::string drawn_chart(const BoxChart& chart) {
  MarkupWriter svg;
  write_chart(svg, chart);
  EXPECT_TRUE(svg.is_closed());
  expect_well_formed(svg.written());
  return svg.written();
}

// The place of a value by the ticks of the axis, which have a text each.
class Heights {
 public:
  explicit Heights(const std::string& svg) : zero_(drawn_text(svg, "0")[1]), ten_(drawn_text(svg, "10")[1]) {}
  double of(double y) const { return 10 * (zero_ - 0.35 * CHART_LETTER - y) / (zero_ - ten_); }
  double rounding() const { return 4 * BOX_TENTH * 10 / (zero_ - ten_); }  // of a place and of both ticks

 private:
  double zero_, ten_;
};

// The numbers of the elements that begin so.
std::vector<std::vector<double>> numbers_in(const std::string& svg, const std::string& start) {
  std::vector<std::vector<double>> all;
  const std::regex element(start + "[^>]*>"), number("-?[0-9]+\\.?[0-9]*");
  for (std::sregex_iterator e(svg.begin(), svg.end(), element), end; e != end; ++e) {
    const std::string text = e->str().substr(start.size());
    all.emplace_back();
    for (std::sregex_iterator n(text.begin(), text.end(), number); n != end; ++n) all.back().push_back(std::stod(n->str()));
  }
  return all;
}

TEST(BoxChart, PartsAreWhereTheirValuesAre) {
  const BoxChart chart = two_groups();
  const std::string svg = drawn_chart(chart);
  const Heights heights(svg);
  const auto boxes = numbers_in(svg, "<rect class=\"box\"");  // x, y, width, height
  ASSERT_EQ(boxes.size(), 2u);
  const auto medians = numbers_in(svg, "<path class=\"median\"");  // x, y, x, y
  ASSERT_EQ(medians.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const Box& box = chart.groups[k].box;
    EXPECT_NEAR(heights.of(boxes[k][1]), box.upper_quartile, heights.rounding());
    EXPECT_NEAR(heights.of(boxes[k][1] + boxes[k][3]), box.lower_quartile, 2 * heights.rounding());
    EXPECT_NEAR(heights.of(medians[k][1]), box.median, heights.rounding());
    EXPECT_NEAR(medians[k][0], boxes[k][0], 2 * BOX_TENTH);
    EXPECT_NEAR(medians[k][2], boxes[k][0] + boxes[k][2], 2 * BOX_TENTH);
  }
  EXPECT_LT(boxes[0][0] + boxes[0][2], boxes[1][0]) << "side by side";
  // to its end, and the cap there; the lower one first
  const auto whiskers = numbers_in(svg, "<path class=\"whisker\"");
  ASSERT_EQ(whiskers.size(), 8u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(heights.of(whiskers[4 * k][3]), chart.groups[k].box.low, heights.rounding());
    EXPECT_NEAR(heights.of(whiskers[4 * k + 1][1]), chart.groups[k].box.low, heights.rounding());
    EXPECT_NEAR(heights.of(whiskers[4 * k + 2][3]), chart.groups[k].box.high, heights.rounding());
  }
  const auto outliers = numbers_in(svg, "<path class=\"outlier\"");
  ASSERT_EQ(outliers.size(), 1u);
  EXPECT_NEAR(heights.of(outliers[0][1]), 30, heights.rounding());
}

TEST(BoxChart, AMarkStandsBesideItsBox) {
  const std::string svg = drawn_chart(two_groups());
  const Heights heights(svg);
  const auto marks = numbers_in(svg, "<path class=\"box-mark\"");
  ASSERT_EQ(marks.size(), 5u) << "bar, two caps and a diamond, and the diamond of the key";
  const auto boxes = numbers_in(svg, "<rect class=\"box\"");
  const auto& bar = marks[1];
  EXPECT_GT(bar[0], boxes[1][0] + boxes[1][2]);
  EXPECT_NEAR(heights.of(bar[1]), 25, heights.rounding());
  EXPECT_NEAR(heights.of(bar[3]), 15, heights.rounding());
  EXPECT_NEAR(heights.of(0.5 * (marks[4][1] + marks[4][5])), 20, heights.rounding());
  drawn_text(svg, "paper: mean and SD");
  // without a mark there is no key; without a deviation there is no bar
  BoxChart bare = two_groups();
  bare.groups[1].mark->deviation = std::nan("");
  EXPECT_EQ(numbers_in(drawn_chart(bare), "<path class=\"box-mark\"").size(), 2u);
  for (const double none : {std::nan(""), HUGE_VAL}) {
    bare.groups[1].mark->mean = none;
    EXPECT_FALSE(has(drawn_chart(bare), "box-mark"));
    EXPECT_FALSE(has(drawn_chart(bare), "paper"));
  }
}

TEST(BoxChart, SaysItsNumbersToWhoDoesNotSeeThem) {
  const std::string svg = drawn_chart(two_groups());
  for (const char* part : {"role=\"img\"", "aria-labelledby=\"times-title times-text\"", "title &lt;1&gt;",
                           "Times of two parts. lift: median 5.5, quartiles 3.25 and 7.75, whiskers from 1 to 9, 1 outlier.",
                           "tilt: median 13, quartiles 12 and 14, whiskers from 11 to 15. tilt, paper: mean and SD: 20 \u00b1 5."})
    EXPECT_TRUE(has(svg, part)) << part;
}

TEST(BoxChart, SaysHowManyOutliersAreNotDrawn) {
  BoxChart chart = two_groups();
  EXPECT_FALSE(has(drawn_chart(chart), "+"));
  chart.groups[0].box = box_of(many_outliers());
  const std::string svg = drawn_chart(chart);
  drawn_text(svg, "\\+140");
  drawn_text(svg, "\\+n: so many outliers more than are drawn");
  EXPECT_TRUE(has(svg, "200 outliers of which 60 are drawn"));
  const std::string path = drawn_paths(svg, "class=\"outlier\"").at(0);
  EXPECT_EQ(count_of(path, "M"), 60);
}

TEST(BoxChart, LongLabelsAreSlantedAndKeptOnThePage) {
  BoxChart chart = two_groups();
  EXPECT_FALSE(has(drawn_chart(chart), "rotate"));
  for (int k = 0; k < 8; ++k) chart.groups.push_back({"articulated, " + std::string(40, '\xC3') + "beaker", {}});
  chart.groups.back().label = "a rather long name of a vessel that nobody gave";
  const std::string svg = drawn_chart(chart);
  EXPECT_EQ(count_of(svg, "rotate(-50)"), 10);
  EXPECT_TRUE(has(svg, ">lift</text>"));
  EXPECT_TRUE(has(svg, "\u2026</text>"));
  EXPECT_FALSE(has(svg, "that nobody gave</text>"));
  EXPECT_TRUE(has(svg, "that nobody gave: no values.")) << "the description has all of it";
  const auto box = numbers_in(svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 360 ");
  ASSERT_EQ(box.size(), 1u);
  EXPECT_GT(box[0][0], 300) << "the chart grows with its labels";
  EXPECT_LT(box[0][0], 400);
}

TEST(BoxChart, WhateverTheValuesAreTheyAreOnThePage) {
  for (const std::vector<double>& values :
       std::vector<std::vector<double>>{{}, {0}, {5, 5, 5}, {-1e-9, -2e-9}, {1e300, 2e300}, {-3, 4}, {1000.1, 1000.2}}) {
    BoxChart chart = two_groups();
    chart.groups = {{"one", box_of(values)}};
    const std::string svg = drawn_chart(chart);
    const auto medians = numbers_in(svg, "<path class=\"median\"");
    ASSERT_EQ(medians.size(), values.empty() ? 0u : 1u);
    if (values.empty()) continue;
    EXPECT_GE(medians[0][1], 30);
    EXPECT_LE(medians[0][1], 236);
  }
  BoxChart none = two_groups();
  none.groups.clear();
  EXPECT_TRUE(has(drawn_chart(none), "time (s)"));
}

// Every class that a box plot has beyond those of all charts is in its rules.
TEST(BoxChart, ItsRulesNameItsParts) {
  const std::string svg = drawn_chart(two_groups());
  for (const char* part : {"box", "median", "whisker", "outlier", "box-mark"}) {
    EXPECT_TRUE(has(svg, std::string("class=\"") + part + "\"")) << part;
    EXPECT_TRUE(has(BOX_RULES, std::string("svg .") + part + " {")) << part;
  }
}

}  // namespace
}  // namespace wholehand

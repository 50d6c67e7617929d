// SPDX-License-Identifier: MIT
// Charts (base/charts/axes, base/charts/colors, base/charts/field, base/charts/lines): values where they belong, colors in their order, words for
// those who do not see them.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>

#include "base/charts/colors.h"
#include "base/charts/field.h"
#include "base/charts/lines.h"
#include "tests/support/special_values.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

constexpr double TENTH = 0.051;  // units: coordinates are written to a tenth

// ---- axes ----

TEST(SequentialColor, IsViridisAndGrowsLighter) {
  EXPECT_EQ(sequential_color(0), "#440154");
  EXPECT_EQ(sequential_color(1), "#fde725");
  EXPECT_EQ(sequential_color(-3), sequential_color(0));
  EXPECT_EQ(sequential_color(7), sequential_color(1));
  double before = -1;
  for (int k = 0; k <= 20; ++k) {
    const std::string color = sequential_color(k / 20.0);
    const auto part = [&](int at) { return std::stoi(color.substr(at, 2), nullptr, 16); };
    const double lightness = 0.299 * part(1) + 0.587 * part(3) + 0.114 * part(5);
    EXPECT_GT(lightness, before) << color;
    before = lightness;
  }
}

TEST(RoundTicks, AreRoundWithinAndAboutAsManyAsAsked) {
  EXPECT_EQ(round_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(round_ticks(-98, 34, 6, true), (std::vector<double>{-90, -60, -30, 0, 30}));
  EXPECT_EQ(round_ticks(0, 150, 6, true).size(), 6u);
  for (const auto& [low, high] : {std::pair{0.01, 0.07}, {-1e-6, 3e-6}, {0.0, 4.4}, {1e6, 1.00001e6}, {-7.0, 9e9}}) {
    const auto ticks = round_ticks(low, high, 5);
    ASSERT_GE(ticks.size(), 2u) << low;
    EXPECT_LE(ticks.size(), 11u) << low;
    const double slack = 1e-6 * (high - low);
    EXPECT_GE(ticks.front(), low - slack);
    EXPECT_LE(ticks.back(), high + slack);
  }
}

TEST(RoundTicks, EndWhateverIsAsked) {
  EXPECT_EQ(round_ticks(3, 3, 5), (std::vector<double>{3}));
  EXPECT_EQ(round_ticks(4, 3, 5), (std::vector<double>{4}));
  EXPECT_LE(round_ticks(1, std::nextafter(1.0, 2.0), 5).size(), 21u);
  EXPECT_LE(round_ticks(0, 1e300, 5).size(), 21u);
}

// ---- fields ----

FieldChart two_by_three() {
  FieldChart chart;
  chart.name = {"id", "title <1>", "what it shows"};
  chart.x_label = "x (mm)";
  chart.y_label = "y (N)";
  chart.x_edges = {0, 1, 3};
  chart.y_edges = {0, 10, 20, 30};
  chart.values = {0, 1, 0, 0.5, 0, 1};
  chart.kinds.assign(6, CellKind::filled);
  chart.scale = {"value (1)", 0, 1, 2, 0};
  return chart;
}

template <class Chart>
std::string written(const Chart& chart) {
  MarkupWriter html;
  write_chart(html, chart);
  EXPECT_TRUE(html.is_closed());
  EXPECT_EQ(html.written().find("nan"), std::string::npos);
  EXPECT_EQ(html.written().find("inf"), std::string::npos);
  return html.written();
}

// The rectangles of the cells by their color: left, bottom, right, top.
std::multimap<std::string, std::array<double, 4>> cells_in(const std::string& svg) {
  std::multimap<std::string, std::array<double, 4>> cells;
  const std::regex path(R"re(<path class="cell( hollow)?"( fill="(#\w+)")? d="([^"]*)")re"),
      rectangle(R"(M([\d.]+) ([\d.]+)H([\d.]+)V([\d.]+)H([\d.]+)z)");
  for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p) {
    const std::string data = (*p)[4];
    for (std::sregex_iterator r(data.begin(), data.end(), rectangle); r != end; ++r) {
      EXPECT_EQ((*r)[1], (*r)[5]);
      cells.insert({(*p)[1].matched ? "hollow" : (*p)[3].str(),
                    {std::stod((*r)[1]), std::stod((*r)[2]), std::stod((*r)[3]), std::stod((*r)[4])}});
    }
  }
  return cells;
}

TEST(FieldChart, CellsAreWhereTheirEdgesAre) {
  const auto cells = cells_in(written(two_by_three()));
  ASSERT_EQ(cells.size(), 4u) << "three zeros above one another are one";
  const auto tall = *cells.find(sequential_color(0));
  const auto ones = cells.equal_range(sequential_color(1));
  ASSERT_EQ(std::distance(ones.first, ones.second), 2);
  const auto bottom = ones.first->second, top = std::next(ones.first)->second;
  // the column of zeros is as tall as three rows and half as wide as the other
  EXPECT_NEAR(tall.second[1] - tall.second[3], 3 * (bottom[1] - bottom[3]), 6 * TENTH + 0.6);
  EXPECT_NEAR(2 * (bottom[0] - tall.second[0]), bottom[2] - bottom[0], 4 * TENTH + 0.3);
  EXPECT_NEAR(bottom[1] - top[1], 2 * (bottom[1] - bottom[3]), 4 * TENTH + 0.6);
  EXPECT_GT(bottom[1], top[1]) << "y grows upwards";
}

TEST(FieldChart, GreysShowWhatHasNoValue) {
  FieldChart chart = two_by_three();
  chart.kinds[0] = CellKind::hollow;
  chart.kinds[1] = CellKind::absent;
  chart.values[0] = chart.values[1] = std::nan("");
  chart.hollow = "only implausible";
  chart.absent = "none feasible";
  const std::string svg = written(chart);
  const auto cells = cells_in(svg);
  EXPECT_EQ(cells.count("hollow"), 1u);
  EXPECT_EQ(cells.size(), 4u);
  EXPECT_NE(svg.find(">only implausible</text>"), std::string::npos);
  EXPECT_NE(svg.find(">none feasible</text>"), std::string::npos);
}

// As a damaged file may have it: a grip that is there, and a number that is none.
TEST(FieldChart, WhatIsNoNumberIsAbsent) {
  for (const double value : {std::nan(""), HUGE_VAL}) {
    FieldChart chart = two_by_three(), without = chart;
    chart.values[0] = without.values[0] = value;
    without.kinds[0] = CellKind::absent;
    EXPECT_EQ(cells_in(written(chart)), cells_in(written(without)));
  }
}

TEST(FieldChart, WholeNumbersHaveAColorEach) {
  FieldChart chart = two_by_three();
  chart.values = {0, 1, 2, 3, 4, 5};
  chart.scale = {"fingers", 0, 5, 0, 6};
  const auto cells = cells_in(written(chart));
  for (int k = 0; k <= 5; ++k) EXPECT_EQ(cells.count(sequential_color(k / 5.0)), 1u) << k;
}

TEST(FieldChart, IsNamedForScreenReaders) {
  const std::string svg = written(two_by_three());
  EXPECT_NE(svg.find("role=\"img\" aria-labelledby=\"id-title id-text\""), std::string::npos);
  EXPECT_NE(svg.find("<title id=\"id-title\">title &lt;1&gt;</title>"), std::string::npos);
  EXPECT_NE(svg.find("<desc id=\"id-text\">what it shows</desc>"), std::string::npos);
  for (const char* label : {">x (mm)<", ">y (N)<", ">value (1)<"}) EXPECT_NE(svg.find(label), std::string::npos) << label;
}

TEST(FieldChart, MarksTheBestWithARing) {
  FieldChart chart = two_by_three();
  chart.marks = {{0.5, 25, true}, {2, 5, false}};
  chart.mark = "best 2";
  const std::string svg = written(chart);
  EXPECT_EQ(count_of(svg, "class=\"mark\""), 3) << "one in the legend";
  EXPECT_EQ(count_of(svg, "class=\"ring\""), 2);
  EXPECT_NE(svg.find(">best 2</text>"), std::string::npos);
}

TEST(FieldChart, AnAxisOfOneValueIsLabelledAtIt) {
  FieldChart chart = two_by_three();
  chart.x_edges = {29, 31};
  chart.values = {0, 1, 0};
  chart.kinds.resize(3);
  EXPECT_NE(written(chart).find(">30</text>"), std::string::npos);
}

TEST(FieldChart, NamedRowsStandBesideTheirCells) {
  FieldChart chart = two_by_three();
  chart.rows = {"low", "middle", "high"};
  chart.y_edges = {0, 1, 2, 3};
  const std::string svg = written(chart);
  const auto y_of = [&](const std::string& row) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(svg, found, std::regex("y=\"([\\d.]+)\" class=\"end\">" + row)));
    return std::stod(found[1]);
  };
  EXPECT_NEAR(y_of("low") - y_of("middle"), chart.row_height, 2 * TENTH);
  EXPECT_NEAR(y_of("middle") - y_of("high"), chart.row_height, 2 * TENTH);
}

// ---- lines ----

LineChart three_lines() {
  LineChart chart;
  chart.name = {"id", "title", "text"};
  chart.x_label = "tilt (°)";
  chart.y_label = "force (N)";
  chart.x = {0, 30, 60, 90, 120, 150};
  for (int k = 0; k < 3; ++k) {
    LineChart::Line line;
    line.label = std::to_string(k) + " %";
    for (const double x : chart.x) line.y.push_back(1 + k * x / 50);
    line.shade = k / 2.0;
    chart.lines.push_back(line);
  }
  return chart;
}

std::vector<std::string> paths_in(const std::string& svg) {
  std::vector<std::string> paths;
  const std::regex path(R"re(<path class="line" d="([^"]*)")re");
  for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p) paths.push_back((*p)[1]);
  return paths;
}

TEST(LineChart, DrawsEveryPointOfEveryLine) {
  const auto paths = paths_in(written(three_lines()));
  ASSERT_EQ(paths.size(), 3u);
  for (const std::string& path : paths) {
    EXPECT_EQ(count_of(path, "M"), 1);
    EXPECT_EQ(count_of(path, "L"), 5);
  }
}

TEST(LineChart, InfiniteValuesAreGaps) {
  LineChart chart = three_lines();
  chart.lines[1].y[2] = INFINITE;
  chart.lines[2].y.assign(6, INFINITE);
  const std::string svg = written(chart);
  const auto paths = paths_in(svg);
  ASSERT_EQ(paths.size(), 2u) << "of nothing there is no line, and no label";
  EXPECT_EQ(count_of(paths[1], "M"), 2);
  EXPECT_EQ(svg.find(">2 %</text>"), std::string::npos);
}

// The middles of the crosses.
std::vector<std::array<double, 2>> crosses_in(const std::string& svg) {
  std::vector<std::array<double, 2>> crosses;
  const std::regex path(R"re(<path class="line end-of-line" d="M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)M)re");
  for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p)
    crosses.push_back({0.5 * (std::stod((*p)[1]) + std::stod((*p)[3])), 0.5 * (std::stod((*p)[2]) + std::stod((*p)[4]))});
  return crosses;
}

// The numbers of a path, two a point.
std::vector<double> path_numbers(const std::string& path) {
  std::vector<double> numbers;
  const std::regex number(R"([\d.]+)");
  for (std::sregex_iterator n(path.begin(), path.end(), number), end; n != end; ++n) numbers.push_back(std::stod(n->str()));
  return numbers;
}

TEST(LineChart, ACrossStandsWhereALineBecomesInfiniteAndNowhereElse) {
  LineChart chart = three_lines();
  chart.lines.resize(1);
  chart.lines[0].y[3] = INFINITE;
  chart.lines[0].y[5] = std::nan("");  // left out: the line has an end there and no cross
  EXPECT_TRUE(crosses_in(written(chart)).empty()) << "not asked for";
  chart.lines[0].marks_ends = true;
  const std::string svg = written(chart);
  const auto crosses = crosses_in(svg);
  ASSERT_EQ(crosses.size(), 2u) << "before the gap and after it";
  const std::vector<double> numbers = path_numbers(paths_in(svg)[0]);
  ASSERT_EQ(numbers.size(), 8u) << "points 0, 1, 2 and 4";
  for (const int axis : {0, 1}) {
    EXPECT_NEAR(crosses[0][axis], numbers[4 + axis], 2 * TENTH);
    EXPECT_NEAR(crosses[1][axis], numbers[6 + axis], 2 * TENTH);
  }
}

TEST(LineChart, OneOfTwoLinesMayBeDashed) {
  LineChart chart = three_lines();
  EXPECT_EQ(count_of(written(chart), "stroke-dasharray"), 0);
  chart.lines[1].is_dashed = true;
  EXPECT_EQ(count_of(written(chart), "stroke-dasharray"), 1);
}

TEST(LineChart, LabelsLieApartAndWithin) {
  for (const bool is_crowded : {false, true}) {
    LineChart chart = three_lines();
    if (is_crowded)
      for (auto& line : chart.lines) line.y = chart.lines[0].y;  // all upon each other
    const std::string svg = written(chart);
    const std::regex label(R"re(<text x="([\d.]+)" y="([\d.]+)" class="halo-text">)re");
    std::vector<std::array<double, 2>> places;
    for (std::sregex_iterator l(svg.begin(), svg.end(), label), end; l != end; ++l)
      places.push_back({std::stod((*l)[1]), std::stod((*l)[2])});
    ASSERT_EQ(places.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(places[i][0], 46);
      EXPECT_LT(places[i][0], CHART_WIDTH - 2 * CHART_LETTER);
      for (std::size_t k = 0; k < i; ++k) {
        const bool is_beside = std::abs(places[i][0] - places[k][0]) > 3 * CHART_LETTER_WIDTH,
                   is_under = std::abs(places[i][1] - places[k][1]) > CHART_LETTER - 1;
        EXPECT_TRUE(is_beside || is_under) << i << " " << k;
      }
    }
  }
}

TEST(LineChart, MarksLieOnTheirLine) {
  LineChart chart = three_lines();
  chart.lines.erase(chart.lines.begin(), chart.lines.begin() + 2);
  chart.lines[0].marked_x = 45;
  const std::string svg = written(chart);
  std::smatch dot, points;
  ASSERT_TRUE(std::regex_search(svg, dot, std::regex(R"re(class="dot" cx="([\d.]+)" cy="([\d.]+)")re")));
  const std::string path = paths_in(svg)[0];
  ASSERT_TRUE(std::regex_search(path, points, std::regex(R"(L([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+))")));
  // half way between the second and the third point
  EXPECT_NEAR(std::stod(dot[1]), 0.5 * (std::stod(points[1]) + std::stod(points[3])), 2 * TENTH);
  EXPECT_NEAR(std::stod(dot[2]), 0.5 * (std::stod(points[2]) + std::stod(points[4])), 2 * TENTH);
}

TEST(LineChart, ShowsALimitThatIsWithin) {
  LineChart chart = three_lines();
  chart.limit = LineChart::Limit{5, "most 5 N"};
  EXPECT_NE(written(chart).find(">most 5 N</text>"), std::string::npos);
  chart.limit->y = 50;
  EXPECT_EQ(written(chart).find("most 5 N"), std::string::npos);
}

TEST(LineChart, EndsAtTheHighestThatIsAsked) {
  LineChart chart = three_lines();
  chart.lines[0].y[3] = 1e6;
  chart.highest = 8;
  const auto paths = paths_in(written(chart));
  EXPECT_EQ(count_of(paths[0], "M"), 2) << "the point above it is left out";
}

TEST(LineChart, OneTiltIsADot) {
  LineChart chart = three_lines();
  chart.x = {45};
  for (auto& line : chart.lines) line.y.resize(1);
  EXPECT_EQ(count_of(written(chart), "class=\"dot\""), 3);
}

TEST(LineChart, OfNothingButZeroHasAScale) {
  LineChart chart = three_lines();
  for (auto& line : chart.lines) line.y.assign(6, 0);
  EXPECT_EQ(paths_in(written(chart)).size(), 3u);
  chart.lines.clear();
  EXPECT_TRUE(paths_in(written(chart)).empty());
}

}  // namespace
}  // namespace wholehand

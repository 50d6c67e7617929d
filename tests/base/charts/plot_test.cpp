// SPDX-License-Identifier: MIT
// Plots and pictures of their own (base/charts/plot, base/charts/picture): areas, lines and marks where their values are, on linear and
// logarithmic axes, whatever the values are.
// sanitizers: address
#include "base/charts/plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/charts/picture.h"
#include "base/files/pictures.h"
#include "tests/support/drawn.h"
#include "tests/support/files.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

constexpr PlotPlace SOMEWHERE{50, 40, 250, 140};
constexpr const char* RED = "#ff0000";

Plot empty_plot() {
  Plot plot;
  plot.x = {"x (mm)", 0, 10};
  plot.y = {"y (N)", 0, 100};
  return plot;
}

std::string drawn_plot(const Plot& plot) {
  MarkupWriter svg;
  svg.open("svg");
  put_plot(svg, plot, SOMEWHERE);
  svg.close();
  EXPECT_TRUE(svg.is_closed());
  expect_well_formed(svg.written());
  return svg.written();
}

PlotLayer line_of(const std::vector<std::array<double, 2>>& points) {
  PlotLayer layer;
  layer.label = "a line";
  layer.color = RED;
  layer.line = 1;
  layer.points = points;
  return layer;
}

// ---- ticks ----

TEST(LogarithmicTicks, AreOnesTwosAndFives) {
  EXPECT_EQ(logarithmic_ticks(1, 20), (std::vector<double>{1, 2, 5, 10, 20}));
  EXPECT_EQ(logarithmic_ticks(40, 3000), (std::vector<double>{50, 100, 200, 500, 1000, 2000}));
  EXPECT_EQ(logarithmic_ticks(1, 1e4).size(), 5u) << "decades alone";
  EXPECT_LE(logarithmic_ticks(1e-30, 1e30).size(), 10u);
  for (const auto& [low, high] : {std::pair{0.0, 1.0}, {-1.0, 1.0}, {2.0, 1.0}, {1.0, HUGE_VAL}, {std::nan(""), 1.0}})
    EXPECT_TRUE(logarithmic_ticks(low, high).empty()) << low << " " << high;
}

TEST(LogarithmicTicks, RangesAreRound) {
  const TickRange range = round_logarithmic_range(0.0085, 87000);
  EXPECT_DOUBLE_EQ(range.low, 0.005);
  EXPECT_DOUBLE_EQ(range.high, 100000);
  const TickRange of_one = round_logarithmic_range(3, 3);
  EXPECT_DOUBLE_EQ(of_one.low, 2);
  EXPECT_DOUBLE_EQ(of_one.high, 5);
}

TEST(PowerText, IsShort) {
  EXPECT_EQ(power_text(0.005), "0.005");
  EXPECT_EQ(power_text(2000), "2,000");
  EXPECT_EQ(power_text(1e4), "10⁴");
  EXPECT_EQ(power_text(2e4), "2·10⁴");
  EXPECT_EQ(power_text(1e-9), "10⁻⁹");
  EXPECT_EQ(power_text(5e12), "5·10¹²");
  EXPECT_EQ(power_text(0), "0");
}

// ---- plots ----

TEST(Plot, PointsAreWhereTheirValuesAre) {
  Plot plot = empty_plot();
  plot.layers.push_back(line_of({{0, 0}, {5, 25}, {10, 100}}));
  const auto lines = drawn_lines(drawn_plot(plot), RED);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], (std::vector<std::array<double, 2>>{{50, 140}, {150, 115}, {250, 40}}));
}

TEST(Plot, LogarithmicAxesAreEvenInDecades) {
  Plot plot = empty_plot();
  plot.x = {"x", 1, 100, true};
  plot.y = {"y", 1e-6, 1e-2, true};
  plot.x.has_grid = plot.y.has_grid = true;
  plot.layers.push_back(line_of({{1, 1e-6}, {10, 1e-5}, {100, 1e-2}}));
  const std::string svg = drawn_plot(plot);
  EXPECT_EQ(drawn_lines(svg, RED).at(0), (std::vector<std::array<double, 2>>{{50, 140}, {150, 115}, {250, 40}}));
  for (const char* tick : {"1", "2", "5", "10", "100", "10⁻⁵", "10⁻⁴"}) drawn_text(svg, tick);
  EXPECT_EQ(count_of(svg, "class=\"grid\""), 7 + 5);
}

TEST(Plot, WhatHasNoPlaceIsAGap) {
  for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    Plot plot = empty_plot();
    plot.layers.push_back(line_of({{0, 0}, {2, 10}, {3, none}, {4, 20}, {5, 50}}));
    EXPECT_EQ(drawn_lines(drawn_plot(plot), RED).size(), 2u) << none;
  }
  Plot plot = empty_plot();
  plot.y = {"y", 1, 100, true};
  plot.layers.push_back(line_of({{0, 1}, {2, 10}, {3, 0}, {4, -20}, {5, 50}}));
  EXPECT_EQ(drawn_lines(drawn_plot(plot), RED).size(), 2u) << "no logarithm";
}

TEST(Plot, LevelStretchesAreOneLine) {
  Plot plot = empty_plot();
  plot.layers.push_back(line_of({{0, 50}, {1, 50}, {2, 50}, {3, 50}, {4, 60}, {5, 50}}));
  EXPECT_EQ(drawn_lines(drawn_plot(plot), RED).at(0).size(), 4u);
}

TEST(Plot, BoxesEndAtTheAxes) {
  Plot plot = empty_plot();
  PlotLayer layer;
  layer.color = RED;
  layer.boxes = {{-5, 50, 5, 1e9}, {20, 0, 30, 10}, {1, 20, 1, 30}, {std::nan(""), 0, 1, 1}};
  plot.layers.push_back(layer);
  const auto boxes = drawn_boxes(drawn_plot(plot), RED);
  ASSERT_EQ(boxes.size(), 2u) << "beyond the axes, and of no number";
  EXPECT_EQ(boxes[0][0], 50);
  EXPECT_EQ(boxes[0][1], 40);
  EXPECT_NEAR(boxes[0][2], 150, 0.31);
  EXPECT_NEAR(boxes[0][3], 90, 0.31);
}

TEST(Plot, MarksAreCountedWhereTheyAreWithin) {
  for (const MarkShape shape : {MarkShape::disc, MarkShape::square, MarkShape::triangle, MarkShape::diamond}) {
    Plot plot = empty_plot();
    PlotLayer layer = line_of({{0, 0}, {5, 50}, {10, 100}, {11, 50}, {5, 101}, {std::nan(""), 1}});
    layer.line = 0;
    layer.mark = shape;
    plot.layers.push_back(layer);
    EXPECT_EQ(drawn_marks(drawn_plot(plot), RED), 3u);
  }
}

TEST(Plot, NotesLieApart) {
  Plot plot = empty_plot();
  for (int k = 0; k < 4; ++k) plot.notes.push_back({5 + 0.05 * k, 50, std::string(1, static_cast<char>('p' + k))});
  plot.notes.push_back({500, 50, "far"});
  const std::string svg = drawn_plot(plot);
  EXPECT_FALSE(has(svg, ">far<"));
  std::vector<std::array<double, 2>> places;
  for (const char* text : {"p", "q", "r", "s"}) places.push_back(drawn_text(svg, text));
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const bool is_beside = std::abs(places[i][0] - places[k][0]) > CHART_LETTER_WIDTH - 0.2;
      EXPECT_TRUE(is_beside || std::abs(places[i][1] - places[k][1]) > 0.8 * CHART_LETTER) << i << " " << k;
    }
  }
}

TEST(Plot, OfNothingHasItsAxes) {
  const std::string svg = drawn_plot(empty_plot());
  for (const char* text : {"x \\(mm\\)", "y \\(N\\)", "0", "10", "100"}) drawn_text(svg, text);
  Plot bare = empty_plot();
  bare.x.has_numbers = false;
  EXPECT_FALSE(has(drawn_plot(bare), "x (mm)"));
}

// ---- legends ----

TEST(Legend, NamesEveryLabelledLayerInRows) {
  std::vector<PlotLayer> layers{line_of({}), line_of({}), line_of({}), line_of({})};
  layers[1].is_area = true;
  layers[1].label = "an <area>";
  layers[2].label = "";
  layers[3].label = "a mark";
  layers[3].line = 0;
  layers[3].mark = MarkShape::disc;
  MarkupWriter svg;
  svg.open("svg");
  EXPECT_EQ(put_legend(svg, layers, 2000, 12, 2500), 12) << "far to the right too";
  svg.close();
  expect_well_formed(svg.written());
  EXPECT_EQ(drawn_lines(svg.written(), RED).size(), 1u);
  EXPECT_EQ(drawn_marks(svg.written(), RED), 1u);
  EXPECT_EQ(count_of(svg.written(), "<rect"), 1);
  EXPECT_EQ(count_of(svg.written(), "<text"), 3);
  EXPECT_TRUE(has(svg.written(), ">an &lt;area&gt;<"));
  EXPECT_EQ(legend_height(layers, 0, 500), LEGEND_STEP);
  EXPECT_EQ(legend_height(layers, 0, 0), 3 * LEGEND_STEP) << "one a row";
}

// ---- pictures ----

TEST(Picture, HasAGroundAMarkAndWords) {
  MarkupWriter svg;
  const double top = open_picture(svg, {"it's <a> \x01 title", "what \"it\" shows", 300, 200, 1.5});
  svg.close();
  const std::string& text = svg.written();
  expect_well_formed(text);
  EXPECT_GT(top, 20);
  EXPECT_LT(top, 40);
  for (const char* part : {"xmlns=\"http://www.w3.org/2000/svg\"", "width=\"450\"", "role=\"img\" aria-labelledby=\"title text\"",
                           "<title id=\"title\">it&#39;s &lt;a&gt; \uFFFD title</title>",
                           "<desc id=\"text\">what &quot;it&quot; shows</desc>", "fill=\"#ffffff\"", "<style>"})
    EXPECT_TRUE(has(text, part)) << part;
  EXPECT_TRUE(has(text, std::string(PICTURE_MARK)));
  EXPECT_FALSE(has(text, "var(")) << "programs for papers know no variables";
  EXPECT_FALSE(has(text, "prefers-color-scheme")) << "the same on a dark page";
}

TEST(Picture, LongTitlesHaveSeveralLines) {
  for (const std::string& title :
       {std::string(200, 'a'), std::string("some words and others that follow, as many as it takes"),
        std::string("\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5")}) {
    MarkupWriter svg;
    const double top = open_picture(svg, {title, "", 100, 100, 1});
    svg.close();
    expect_well_formed(svg.written());
    const int lines = count_of(svg.written(), "class=\"title\"");
    EXPECT_GT(lines, 1);
    EXPECT_GT(top, 13 * lines);
    EXPECT_FALSE(has(svg.written(), "\uFFFD")) << "no letter is cut";
  }
  MarkupWriter svg;
  open_picture(svg, {"", "", 3, 3, 1});
  EXPECT_TRUE(svg.close().is_closed());
}

}  // namespace
}  // namespace wholehand

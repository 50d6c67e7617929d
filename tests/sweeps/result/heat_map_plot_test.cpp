// SPDX-License-Identifier: MIT
#include "sweeps/result/heat_map_plot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <regex>

#include "base/files/files.h"
#include "base/files/pictures.h"
#include "sweeps/result/output_names.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/xml.h"

namespace wholehand::sweeps {
namespace {

// A map of 7 heights x 4 rolls: one cell infeasible, one implausible, the others 0.4 to 0.81.
HeatMap small_map() {
  HeatMap map{Plan(fake_scene(), false)};
  std::vector<double> scores(map.scores().size());
  for (std::size_t i = 0; i < scores.size(); ++i) scores[i] = 0.4 + 0.015 * static_cast<double>(i);
  scores[0] = NAN;
  scores[1] = 0;
  map.restore(scores);
  return map;
}

std::string drawn(const HeatMapPicture& picture) {
  const std::vector<PictureFile> files = heat_map_files({picture});
  EXPECT_EQ(files.size(), 1u);
  expect_well_formed(files[0].svg);
  return files[0].svg;
}

// Left, bottom, right and top of every filled rectangle; runs of cells of one color above one another are one.
std::vector<std::array<double, 4>> cells_of(const std::string& svg, const std::string& attribute) {
  std::vector<std::array<double, 4>> cells;
  const std::regex path("<path class=\"" + attribute + "[^>]* d=\"([^\"]*)\""),
      rectangle(R"(M([\d.]+) ([\d.]+)H([\d.]+)V([\d.]+)H)");
  for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p) {
    const std::string data = (*p)[1];
    for (std::sregex_iterator r(data.begin(), data.end(), rectangle); r != end; ++r)
      cells.push_back({std::stod((*r)[1]), std::stod((*r)[2]), std::stod((*r)[3]), std::stod((*r)[4])});
  }
  return cells;
}

// What a screen reader says.
std::string said(const std::string& svg) {
  const std::size_t from = svg.find("<desc id=\"text\">");
  return svg.substr(from, svg.find("</desc>", from) - from);
}

TEST(HeatMapPlot, DrawsEveryPicture) {
  const TemporaryFolder folder;
  const HeatMap map = small_map();
  const std::vector<HeatMapPicture> pictures{{folder / "a.svg", "beaker1: best score", &map, 0.11},
                                             {folder / "b.svg", "it's \"b\" \\ <c> & $d `e` \xff", &map, 0.14}};
  ASSERT_EQ(write_pictures(heat_map_files(pictures)), "");
  for (const HeatMapPicture& picture : pictures) {
    const std::string svg = file_text(picture.file);
    expect_well_formed(svg);
    EXPECT_TRUE(svg.starts_with("<?xml"));
    EXPECT_TRUE(has(svg, "xmlns=\"http://www.w3.org/2000/svg\""));
    for (const char* text : {"roll (°)", "height (mm)", "best score", "no feasible grip", "only implausible grips"})
      EXPECT_TRUE(has(svg, text)) << text;
    EXPECT_TRUE(has(svg, "fill=\"#ffffff\"")) << "a ground of its own, for dark pages";
    EXPECT_FALSE(has(svg, "var(")) << "programs for papers know no variables";
    EXPECT_EQ(cells_of(svg, "cell\"").size(), 26u) << "a cell each";
    EXPECT_EQ(cells_of(svg, "cell hollow\"").size(), 1u);
    EXPECT_TRUE(has_mark(picture.file, PICTURE_MARK));
  }
  EXPECT_TRUE(has(file_text(folder / "b.svg"), ">it&#39;s &quot;b&quot; \\ &lt;c&gt; &amp; $d `e` \uFFFD</title>"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2) << "nothing else is left";
}

TEST(HeatMapPlot, CellsAreWhereTheirGripsAre) {
  const HeatMap map = small_map();
  const std::string svg = drawn({"a.svg", "a", &map, 0.11});
  auto cells = cells_of(svg, "cell\"");
  const auto hollow = cells_of(svg, "cell hollow\"").at(0);
  double left = 1e9, bottom = 0, right = 0, top = 1e9;
  for (const auto& cell : cells) {
    left = std::min(left, cell[0]);
    bottom = std::max(bottom, cell[1]);
    right = std::max(right, cell[2]);
    top = std::min(top, cell[3]);
  }
  // the implausible cell is the second of the lowest row, and the first is left out
  EXPECT_NEAR(hollow[1], bottom, 0.11);
  EXPECT_NEAR(hollow[0], left + (right - left) / 4, 1);
  EXPECT_NEAR(hollow[1] - hollow[3], (bottom - top) / 7, 1);
  EXPECT_TRUE(has(said(svg), "28 cells. Scores from 0.430 to 0.805, the highest at")) << said(svg);
  EXPECT_TRUE(has(said(svg), "only implausible grips: 1. Cells without a feasible grip: 1.")) << said(svg);
}

TEST(HeatMapPlot, ScaleIsCommonAndOfRealScoresAlone) {
  const HeatMap map = small_map();
  HeatMap low = small_map();
  low.restore(std::vector<double>(28, 0.23));
  for (const PictureFile& file : heat_map_files({{"a.svg", "a", &map, 1}, {"b.svg", "b", &low, 1}})) {
    EXPECT_TRUE(has(file.svg, ">0.20</text>"));
    EXPECT_TRUE(has(file.svg, ">0.85</text>"));
  }
  const std::string alone = drawn({"a.svg", "a", &map, 1});
  EXPECT_TRUE(has(alone, ">0.40</text>")) << "no score of 0 counts";
  EXPECT_TRUE(has(alone, ">0.85</text>"));
  EXPECT_EQ(score_scale(0.5, 0.5).high, 0.55) << "a scale of one score has a width";
}

TEST(HeatMapPlot, MapWithoutAnyGripIsGrey) {
  const HeatMap empty{Plan(fake_scene(), false)};
  const std::string svg = drawn({"empty.svg", "empty", &empty, 0.11});
  EXPECT_TRUE(has(svg, "no feasible grip"));
  EXPECT_TRUE(cells_of(svg, "cell").empty());
  EXPECT_TRUE(has(said(svg), "Cells without a feasible grip: 28.")) << said(svg);
  EXPECT_FALSE(has(said(svg), "highest"));
}

TEST(HeatMapPlot, OneCellIsAMapToo) {
  Scene scene = fake_scene();
  scene.grips.height = {{0.5}};
  scene.grips.roll = {{0.0}};
  HeatMap map{Plan(scene, false)};
  ASSERT_EQ(map.scores().size(), 1u);
  map.restore({0.7});
  EXPECT_EQ(cells_of(drawn({"a.svg", "a", &map, 0.11}), "cell\"").size(), 1u);
}

TEST(HeatMapPlot, WhatIsNoNumberHasNoColor) {
  HeatMap map = small_map();
  for (const double score : {HUGE_VAL, -HUGE_VAL, -1.0}) {
    std::vector<double> scores(28, score);
    scores[5] = 0.6;
    map.restore(scores);
    const std::string svg = drawn({"a.svg", "a", &map, 0.11});
    EXPECT_EQ(cells_of(svg, "cell\"").size(), 1u) << score;
    EXPECT_TRUE(has(svg, ">0.65</text>")) << score;
  }
}

TEST(HeatMapPlot, FailureIsASentenceAndLeavesNothing) {
  const HeatMap map = small_map();
  const TemporaryFolder folder;
  const std::string failure = write_pictures(heat_map_files({{folder / "missing/a.svg", "a", &map, 1}}));
  EXPECT_EQ(failure, "no picture: cannot write " + (folder / "missing/a.svg") +
                         ": No such file or directory; make room, or name another file");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(HeatMapPlot, PicturesOfASweepSayWhatIsMaximised) {
  Scene scene = fake_scene();
  scene.vessels[0].name = "a b";
  scene.vessels[1].name = "a/b";
  const Plan plan(scene, false);
  const std::vector<HeatMap> maps(2, HeatMap(plan));
  const auto pictures = sweep_pictures(scene, plan, maps, output_names("x/y.nc"));
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0].file, "x/y.a_b.svg");
  EXPECT_EQ(pictures[1].file, "x/y.a_b_2.svg");
  EXPECT_EQ(pictures[1].title, "a/b: best score over azimuth, obliquity, offset");
  EXPECT_EQ(pictures[1].map, &maps[1]);
  EXPECT_EQ(pictures[1].height_unit, 0.14);
  scene.grips.azimuth.values = scene.grips.obliquity.values = scene.grips.offset.values = {0};
  EXPECT_EQ(sweep_pictures(scene, Plan(scene, false), maps, output_names("y.nc"))[0].title, "a b: score");
}

// A mesh whose origin is kept stands where its file has it.
TEST(HeatMapPlot, FractionsCountFromTheVesselsBase) {
  Scene scene = fake_scene();
  ASSERT_TRUE(scene.grips.height_is_fraction);
  scene.vessels[1].base = -0.06;
  scene.vessels[1].height = 0.14;
  const std::vector<HeatMap> maps(2, small_map());
  const auto pictures = sweep_pictures(scene, Plan(scene, false), maps, output_names("y.nc"));
  EXPECT_EQ(pictures[1].height_zero, -0.06);
  EXPECT_DOUBLE_EQ(pictures[1].height_unit, 0.2);
  // the middle of the highest row, which has the best
  const MapAxis& heights = maps[1].heights();
  const double best = -60 + 0.5 * (heights.edge(6) + heights.edge(7)) * 200;
  EXPECT_TRUE(has(said(drawn(pictures[1])), fmt::format("a height of {:.1f} mm", best))) << said(drawn(pictures[1]));
}

TEST(HeatMapPlot, VesselNamesBecomeFileNames) {
  EXPECT_EQ(file_name_part("beaker1"), "beaker1");
  EXPECT_EQ(file_name_part("../a b/c"), "___a_b_c");
  EXPECT_EQ(file_name_part(""), "_");
}

}  // namespace
}  // namespace wholehand::sweeps

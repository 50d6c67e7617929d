// SPDX-License-Identifier: MIT
#include "sweeps/heat_map_plot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/support/fake_backend.h"
#include "tests/support/files.h"

namespace wholehand {
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

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(HeatMapPlot, DrawsEveryPicture) {
  const TemporaryFolder folder;
  const HeatMap map = small_map();
  const std::vector<HeatMapPicture> pictures{{folder / "a.svg", "beaker1: best score", &map, 0.11},
                                             {folder / "b.svg", "it's \"b\" \\ <c> & $d `e`", &map, 0.14}};
  ASSERT_EQ(draw_heat_maps(pictures), "");
  for (const HeatMapPicture& picture : pictures) {
    const std::string svg = file_text(picture.file);
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    for (const char* text : {"roll / deg", "height / mm", "best score", "no feasible grip", "only implausible grips"}) {
      EXPECT_NE(svg.find(text), std::string::npos) << text;
    }
    EXPECT_NE(svg.find("#ffffff"), std::string::npos) << "a background of its own, for dark pages";
    EXPECT_GE(count(svg, "<polygon"), 26) << "a cell each";
    EXPECT_FALSE(file_exists(picture.file + ".partial"));
  }
  EXPECT_NE(file_text(folder / "b.svg").find("it's"), std::string::npos);
  EXPECT_NE(file_text(folder / "b.svg").find("&lt;c>"), std::string::npos);
}

TEST(HeatMapPlot, ScaleIsCommonAndOfRealScoresAlone) {
  const HeatMap map = small_map();
  EXPECT_NE(heat_map_script({{"a.svg", "a", &map, 1}}).find("set cbrange [0.4:0.85]"), std::string::npos);
}

TEST(HeatMapPlot, MapWithoutAnyGripIsGrey) {
  const TemporaryFolder folder;
  const HeatMap empty{Plan(fake_scene(), false)};
  ASSERT_EQ(draw_heat_maps({{folder / "empty.svg", "empty", &empty, 0.11}}), "");
  EXPECT_NE(file_text(folder / "empty.svg").find("no feasible grip"), std::string::npos);
}

TEST(HeatMapPlot, FailureIsASentenceAndLeavesNothing) {
  const HeatMap map = small_map();
  const TemporaryFolder folder;
  EXPECT_NE(draw_heat_maps({{folder / "missing/a.svg", "a", &map, 1}}), "");
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const std::string failure = draw_heat_maps({{folder / "a.svg", "a", &map, 1}});
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(failure.find("gnuplot-nox"), std::string::npos) << failure;
  EXPECT_FALSE(file_exists(folder / "a.svg"));
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
  const MapAxis& heights = maps[1].heights();
  const auto height = [](double fraction) { return (-0.06 + 0.2 * fraction) * 1e3; };
  EXPECT_NE(heat_map_script({pictures[1]})
                .find(fmt::format("set yrange [{}:{}]", height(heights.edge(0)), height(heights.edge(heights.cells())))),
            std::string::npos)
      << heat_map_script({pictures[1]});
}

TEST(HeatMapPlot, VesselNamesBecomeFileNames) {
  EXPECT_EQ(file_name_part("beaker1"), "beaker1");
  EXPECT_EQ(file_name_part("../a b/c"), "___a_b_c");
  EXPECT_EQ(file_name_part(""), "_");
}

}  // namespace
}  // namespace wholehand

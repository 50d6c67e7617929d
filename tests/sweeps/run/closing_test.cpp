// SPDX-License-Identifier: MIT
#include "sweeps/run/closing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "tests/support/fake_backend.h"

namespace wholehand::sweeps {
namespace {

TEST(Closing, OpeningSaysWhatIsEvaluatedAndWhere) {
  Scene scene = fake_scene();
  BackendInfo info{"vulkan", "llvmpipe", "Mesa", Precision::single, true};
  EXPECT_EQ(opening_lines(scene, Plan(scene, false), info),
            "fake: 560 grips of 2 vessels, 8 states each\n"
            "on llvmpipe, a CPU driver (Mesa), single precision\n"
            "one azimuth stands for all 3: the vessels are bodies of revolution\n");
  EXPECT_EQ(backend_line(info, {4.25, 3, 1, 0, 0}, "; the core would"),
            "computed on Vulkan (llvmpipe, a CPU driver), float, in 4.2 s, 3.0 s of it to compile kernels; the core would\n");
  info.is_cpu = false;
  info.precision = Precision::full;
  scene.tilts.clear();
  scene.name.clear();
  scene.vessels.resize(1);
  EXPECT_EQ(opening_lines(scene, Plan(scene, true), info), "sweep: 840 grips of 1 vessel\non llvmpipe (Mesa), double precision\n");
}

TEST(Closing, VesselsSayWhatTheyHoldAndWeigh) {
  Scene scene = fake_scene();
  scene.vessels[0].wall = 1e-3;
  std::vector<VesselFacts> facts(2);
  facts[0].capacity = 446.7e-6;
  facts[0].empty_mass = 0.19;
  facts[1].empty_mass = 1.23456;
  EXPECT_EQ(vessel_lines(scene, facts), "first vessel: holds 447 mL, 0.190 kg empty\nsecond: holds nothing, 1.23 kg empty\n");
}

TEST(Closing, VerdictSaysWhetherTheFirstGripHoldsAndHowSurely) {
  Scene scene = fake_scene();
  BestGrip grip;
  grip.score = 0.8126;
  EXPECT_EQ(verdict_text(scene, {grip}), "whether it holds is not judged without efforts; grip 1 scores 0.813");
  EXPECT_EQ(verdict_text(scene, {}), "no grip is feasible and plausible");
  scene.strength.emplace();
  EXPECT_EQ(verdict_text(scene, {}), "no grip is feasible and plausible and holds");
  grip.efforts.worst = 0.25;
  const std::string holds = "grip 1 holds with 25 % of the hand's strength (margin 4.00)";
  EXPECT_EQ(verdict_text(scene, {grip}), holds + "; not judged off its place");
  scene.robust.emplace();
  EXPECT_EQ(verdict_text(scene, {grip}), holds) << "nobody asked for its deviations";
  grip.robust.share = 0.999;
  EXPECT_EQ(verdict_text(scene, {grip, BestGrip()}), holds + " and in 99 % of its deviations") << "not all of them";
  grip.robust.share = 0.625;
  EXPECT_EQ(verdict_text(scene, {grip}), holds + ", but in only 62 % of its deviations");
  grip.efforts.worst = 1.6;
  EXPECT_EQ(verdict_text(scene, {grip}), "no grip holds; grip 1 takes 160 % of the hand's strength (margin 0.62)");
  grip.efforts.worst = std::numeric_limits<double>::infinity();
  EXPECT_EQ(verdict_text(scene, {grip}), "no grip holds; no force of the hand holds it in grip 1");
  scene.tilts.clear();
  EXPECT_EQ(verdict_text(scene, {grip}), "whether it holds is not judged without [tilts]; grip 1 scores 0.813");
}

TEST(Closing, AListShowsItsFirstGripsAndHowManyMoreThereAre) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  std::vector<BestGrip> best(8);
  const auto count_lines = [&](std::size_t rows, const std::string& file) {
    const std::string text = list_lines(scene, plan, 0, best, file, {rows});
    EXPECT_EQ(text.find("  .. ") != std::string::npos, rows < 8) << text;
    const std::string more = file.empty() ? " more; -o FILE writes all of them\n" : " more in a.csv\n";
    EXPECT_EQ(text.find(more) != std::string::npos, rows < 8) << text;
    return std::count(text.begin(), text.end(), '\n') - (rows < 8 ? 2 : 1);
  };
  const std::ptrdiff_t edge = count_lines(8, "") - 8;  // whether a line names an edge
  EXPECT_EQ(count_lines(5, "a.csv"), 5 + edge);
  EXPECT_EQ(count_lines(1, ""), 1 + edge);
  EXPECT_EQ(count_lines(50, ""), 8 + edge) << "no more than there are";
}

TEST(Closing, GripsNearTheGateAreCountedInWords) {
  EXPECT_EQ(gate_text(0, 1e-3), "");
  EXPECT_EQ(gate_text(1, 1e-3), "1 grip is within 0.4 % of the gate, where another backend may decide otherwise");
  EXPECT_EQ(gate_text(1234, 1.22e-3), "1,234 grips are within 0.49 % of the gate, where another backend may decide otherwise");
}

TEST(Closing, AListCountsRanksThatAreNearToTheNextOne) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  std::vector<BestGrip> best(4);
  const auto near_line = [&](const std::vector<std::array<double, 3>>& values, RankBy by) {  // score, low, mean
    for (std::size_t k = 0; k < best.size(); ++k) {
      best[k].rank = k + 1;
      best[k].score = values[k][0];
      best[k].robust.low = values[k][1];
      best[k].robust.mean = values[k][2];
    }
    ListView view;
    view.by = by;
    view.score_tolerance = 2.84e-4;
    const std::string text = list_lines(scene, plan, 0, best, "", view), start = " within ";
    const std::size_t at = text.find(start);
    if (at == std::string::npos) return std::string();
    const std::size_t begin = text.rfind('\n', at) + 1;
    return text.substr(begin, text.find('\n', at) - begin);
  };
  constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::array<double, 3>> apart{{0.9, 0.8, 0.85}, {0.8, 0.7, 0.84}, {0.7, 0.6, 0.83}, {0.6, 0.5, 0.82}};
  EXPECT_EQ(near_line(apart, RankBy::score), "");
  EXPECT_EQ(near_line(apart, RankBy::robust), "");
  const std::vector<std::array<double, 3>> near{{0.9, 0.8, 0.8}, {0.8, 0.7998, 0.7}, {0.7998, 0, 0.6}, {0.7996, 0, 0.5999}};
  EXPECT_EQ(near_line(near, RankBy::score), "  2 ranks are within 0.00028 of the next one, the first is rank 2");
  EXPECT_EQ(near_line(near, RankBy::robust), "  2 ranks are within 0.00028 of the next one, the first is rank 1")
      << "of equal percentiles the means";
  EXPECT_EQ(near_line(near, RankBy::push), "");
  const std::vector<std::array<double, 3>> unjudged{{0.9, 0.8, 0.8}, {0.8999, NONE, NONE}, {0.7, NONE, NONE}, {0.6999, NONE, NONE}};
  EXPECT_EQ(near_line(unjudged, RankBy::robust), "  rank 3 is within 0.00028 of the next one") << "by their scores";
  const std::vector<std::array<double, 3>> unheld{{0, NONE, NONE}, {0, NONE, NONE}, {0, NONE, NONE}, {0, NONE, NONE}};
  EXPECT_EQ(near_line(unheld, RankBy::score), "");
}

TEST(Closing, TimesAddUp) {
  const std::string text = closing_lines({"missing.nc", "missing.best.csv"}, {2.0, 0.5, 1.25, 0.25, 50000000});
  EXPECT_EQ(text.substr(0, text.find("; CPU")),
            "wrote missing.nc (0 B), missing.best.csv\n"
            "2.00 s: kernels 1.25, file writing 0.250 (200 MB/s), everything else 0.50");
  EXPECT_NE(text.find("; peak memory "), std::string::npos);
  const std::string cold = closing_lines({"missing.nc"}, {4.0, 2.25, 1.0, 0.25, 50000000});
  EXPECT_EQ(cold.substr(0, cold.find("; CPU")),
            "wrote missing.nc (0 B)\n"
            "4.00 s: compiling kernels 2.25, kernels 1.00, file writing 0.250 (200 MB/s), everything else 0.50");
}

TEST(Closing, TheLastLineSaysWhatComputed) {
  BackendInfo info;
  info.backend = "core";
  info.device = "core, 2 threads";
  EXPECT_EQ(backend_line(info, {1.44, 0, 1, 0, 0}, "; a device would not"),
            "computed on the CPU core, double, in 1.4 s; a device would not\n");
  info = {"vulkan", "llvmpipe", "Mesa", Precision::single, true};
  EXPECT_EQ(backend_line(info, {1.25, 0.9, 1, 0, 0}, ""), "computed on Vulkan (llvmpipe, a CPU driver), float, in 1.2 s\n");
  EXPECT_EQ(backend_line(info, {4.25, 3, 1, 0, 0}, "; the core would"),
            "computed on Vulkan (llvmpipe, a CPU driver), float, in 4.2 s, 3.0 s of it to compile kernels; the core would\n");
  info.is_cpu = false;
  EXPECT_EQ(backend_line(info, {1.25, 0.9, 1, 0, 0}, ""), "computed on Vulkan (llvmpipe), float, in 1.2 s\n");
}

}  // namespace
}  // namespace wholehand::sweeps

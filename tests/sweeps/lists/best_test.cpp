// SPDX-License-Identifier: MIT
#include "sweeps/lists/best.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/text/error.h"
#include "tests/support/fake_backend.h"

namespace wholehand::sweeps {
namespace {

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

// A backend whose chunks hold made-up forces.
class ForceBackend : public FakeBackend {
 public:
  using FakeBackend::FakeBackend;
  RunResult run(const RunRequest& request) override {
    RunRequest changed = request;
    changed.sink = [&](const PlaneChunk& chunk) {
      std::vector<double> reals(chunk.doubles, chunk.doubles + fields().real_kept * chunk.stride);
      const auto put = [&](int field, int fill, double value) { reals[(fields().plane[field] + fill) * chunk.stride] = value; };
      put(FIELD_PEAK_FORCE, 0, 2);
      put(FIELD_PEAK_FORCE, 1, 3);
      put(FIELD_PEAK_TILT, 0, 0.1);
      put(FIELD_PEAK_TILT, 1, static_cast<float>(radians(30)));
      put(FIELD_LARGEST_HOLD, 0, std::numeric_limits<double>::infinity());
      put(FIELD_LARGEST_HOLD, 1, 5);
      put(FIELD_SAFE_TILT, 0, 1.5);
      put(FIELD_SAFE_TILT, 1, safe);
      PlaneChunk with = chunk;
      with.doubles = reals.data();
      request.sink(with);
    };
    return FakeBackend::run(changed);
  }
  double safe = static_cast<float>(radians(60));
};

TEST(Best, ValuesComeFromThoseGripsAlone) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  for (const Precision precision : {Precision::single, Precision::full}) {
    FakeBackend backend(scene, make_field_set(best_fields(scene), scene), precision, 2);
    const std::vector<Candidate> candidates{{0.9, 17}, {0.8, 3}, {0.7, 250}};
    const auto best = evaluate_best(backend, scene, plan, 1, candidates);
    ASSERT_EQ(best.size(), 3u);
    EXPECT_EQ(backend.evaluated, 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const GripInput grip = plan.grip(1, candidates[i].index);
      EXPECT_EQ(best[i].candidate.index, candidates[i].index);
      EXPECT_EQ(best[i].grip.height, grip.height);
      EXPECT_EQ(best[i].score, fake_real(1, grip, FIELD_SCORE, 0));
      EXPECT_EQ(best[i].terms[5], fake_real(1, grip, FIELD_TERMS, 5));
      EXPECT_EQ(best[i].points_touching, std::popcount(fake_uint(1, grip, FIELD_TOUCH_MASK)));
    }
  }
}

TEST(Best, ForcesAreTheWorstOverTheFills) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  ForceBackend backend(scene, make_field_set(best_fields(scene), scene), Precision::full, 1);
  BestGrip best = evaluate_best(backend, scene, plan, 0, {{0.9, 1}}).front();
  EXPECT_EQ(best.peak_force, 3);
  EXPECT_EQ(best.peak_tilt, scene.tilts[1]) << "the listed tilt nearest to the device's number";
  EXPECT_TRUE(std::isinf(best.largest_hold));
  EXPECT_EQ(best.safe_tilt, scene.tilts[2]);
  EXPECT_FALSE(best.is_safe_to_end);
  backend.safe = std::nan("");
  EXPECT_TRUE(std::isnan(evaluate_best(backend, scene, plan, 0, {{0.9, 1}}).front().safe_tilt)) << "one fill has none";
}

// The end is each fill's own: where tilts are left out, the safe tilt runs over those that count.
TEST(Best, SafeToTheEndMeansAtEveryTiltThatCounts) {
  const Scene scene = fake_scene();
  const auto is_safe = [&](std::vector<double> reported, const std::vector<double>& last) {
    BestGrip best;
    set_worst(best, scene, last,
              [&](int field, int fill) { return field == FIELD_SAFE_TILT ? reported[static_cast<std::size_t>(fill)] : 0; });
    return best.is_safe_to_end;
  };
  const double end = scene.tilts.back(), middle = scene.tilts[1];
  EXPECT_TRUE(is_safe({end, static_cast<float>(middle)}, {end, middle}));
  EXPECT_TRUE(is_safe({static_cast<float>(middle), end}, {middle, end}));
  EXPECT_FALSE(is_safe({middle, middle}, {end, middle}));
  EXPECT_FALSE(is_safe({end, std::nan("")}, {end, middle}));
  EXPECT_FALSE(is_safe({middle, end}, {end, end}));
}

TEST(Best, CsvHasOneRowAVesselAndRankWithUnitsInItsHead) {
  Scene scene = fake_scene();
  scene.vessels[1].name = "a, \"b\"";
  BestGrip grip;
  grip.grip = {0.05, radians(45), radians(-10), radians(-90), -2e-3, 1.1};
  grip.score = 0.75;
  grip.gap = 0.08;
  grip.safe_tilt = std::nan("");
  grip.largest_hold = std::numeric_limits<double>::infinity();
  grip.candidate.index = 41;
  BestGrip next = grip;
  next.rank = 2;
  next.refined = {0.051, radians(44), radians(-9), radians(-88), -1e-3, 1.1};
  next.refined_score = 0.875;
  const Plan plan(scene, false);
  const auto rows = lines(best_csv(scene, plan, {{grip, next}, {grip}}, {"a, b.nc", "sweep-0"}));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_TRUE(
      rows[0].starts_with("vessel,rank,height_mm,azimuth_deg,obliquity_deg,roll_deg,offset_mm,hand_scale,score,score_fingers,"));
  EXPECT_TRUE(rows[1].starts_with("first vessel,1,50,45,-10,-90,-2,1.1,0.75,")) << rows[1];
  EXPECT_TRUE(rows[2].starts_with("first vessel,2,"));
  EXPECT_TRUE(rows[3].starts_with("\"a, \"\"b\"\"\",1,")) << rows[3];
  EXPECT_TRUE(rows[1].ends_with(",inf,,0,,,,,,,,,,,,,,,41,\"a, b.nc\",sweep-0")) << "no safe tilt, not refined: empty";
  EXPECT_TRUE(rows[2].ends_with(",inf,,0,,,,,,,,,0.875,51,44,-9,-88,-1,41,\"a, b.nc\",sweep-0")) << rows[2];
  EXPECT_TRUE(
      rows[0].ends_with(",antipodal,worst_effort,worst_effort_fill,worst_effort_tilt_deg,tips_worst_effort,push_N,friction_needed,"
                        "held_margin,not_held,"
                        "refined_score,refined_height_mm,refined_azimuth_deg,refined_obliquity_deg,refined_roll_deg,"
                        "refined_offset_mm,grip,result,sweep"));
  EXPECT_TRUE(rows[0].starts_with(BEST_CSV_START));
  const auto commas = std::count(rows[0].begin(), rows[0].end(), ',');
  EXPECT_EQ(std::count(rows[1].begin(), rows[1].end(), ','), commas + 1) << "one is in the name";
}

TEST(Best, TableShowsTheAxesThatVaryInColumns) {
  Scene scene = fake_scene();
  scene.grips.offset.values = {0};
  const Plan plan(scene, false);
  BestGrip grip;
  grip.grip.height = 0.0612;
  grip.safe_tilt = std::nan("");
  BestGrip next = grip;
  next.rank = 2;
  const auto rows = lines(best_table(scene, plan, {grip, next, next}, {2, true}));
  ASSERT_EQ(rows.size(), 3u);
  for (const char* title : {"score", "height mm", "obliquity deg", "roll deg", "peak N", "safe deg"}) {
    EXPECT_NE(rows[0].find(title), std::string::npos) << title;
  }
  for (const char* title : {"azimuth", "offset", "hand scale"}) EXPECT_EQ(rows[0].find(title), std::string::npos) << title;
  EXPECT_NE(rows[1].find("61.2"), std::string::npos);
  for (const std::string& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_LE(rows[0].size(), 132u);
  EXPECT_EQ(rows[0].find("refined"), std::string::npos);
  next.safe_tilt = radians(22.5);
  EXPECT_NE(best_table(scene, plan, {next}, {1, true}).find(" 22.5\n"), std::string::npos) << "as the scene has it";
  next.is_safe_to_end = true;
  EXPECT_NE(best_table(scene, plan, {next}, {1, true}).find(" 22.5+"), std::string::npos) << "more was not asked";
  next.refined_score = 0.8764;
  const auto refined = lines(best_table(scene, plan, {grip, next}, {2, true}));
  EXPECT_LT(refined[0].find("score"), refined[0].find("refined"));
  EXPECT_EQ(refined[1].find("0.876"), std::string::npos) << "not every grip need be refined";
  EXPECT_NE(refined[2].find("0.876"), std::string::npos);
}

// Whatever the scene asks for, a line fits a terminal, and shows the axes and what the list is ranked by.
TEST(Best, NarrowTableHasTenColumnsAtMost) {
  Scene scene = fake_scene();
  scene.robust.emplace();
  BestGrip grip;
  grip.robust = {0.5, 0.25, 0.75};
  const auto head = [&](RankBy by, std::size_t rows = 1) {
    const auto table = lines(best_table(scene, Plan(scene, false), {grip, grip, grip}, {rows, false, by}));
    EXPECT_EQ(table.size(), 1 + std::min<std::size_t>(rows, 3));
    for (const std::string& line : table) EXPECT_LT(line.size(), 100u) << line;
    EXPECT_EQ(table[1].size(), table[0].size());
    return table[0];
  };
  const auto expect_titles = [](const std::string& titles, const std::vector<std::string>& there,
                                const std::vector<std::string>& absent) {
    for (const std::string& title : there) EXPECT_NE(titles.find("  " + title), std::string::npos) << title << ": " << titles;
    for (const std::string& title : absent) EXPECT_EQ(titles.find("  " + title), std::string::npos) << title << ": " << titles;
  };
  scene.grips.offset.values = {0};
  expect_titles(head(RankBy::robust), {"rank", "robust", "holds %", "height mm", "obliquity deg", "roll deg", "hold N"},
                {"score", "effort", "peak N", "points", "azimuth", "offset"});
  EXPECT_NE(best_table(scene, Plan(scene, false), {grip}, {1, false, RankBy::robust}).find("0.250       75"), std::string::npos);
  scene.strength.emplace();
  expect_titles(head(RankBy::score), {"score", "fingers", "gap mm", "effort", "safe deg"},
                {"robust", "holds %", "hold N", "margin"});
  expect_titles(head(RankBy::robust), {"robust", "holds %", "fingers", "gap mm", "effort", "safe deg"}, {"score", "margin"});
  expect_titles(head(RankBy::push), {"score", "effort", "push N"}, {"robust"});
  scene.grips.offset.values = {0, 1e-3};
  expect_titles(head(RankBy::robust), {"offset mm", "holds %", "fingers", "effort", "safe deg"}, {"gap mm"});
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 64;
  scene.grips.hand_scale = {{0.9, 1.1}, true};
  for (const RankBy by : {RankBy::score, RankBy::robust, RankBy::worst_effort, RankBy::push})
    expect_titles(head(by, 5), {"height mm", "obliquity deg", "roll deg", "offset mm", "hand scale"}, {"gap mm"});
}

TEST(Best, SceneWithoutTiltsHasNoForces) {
  Scene scene = fake_scene();
  scene.tilts.clear();
  const Plan plan(scene, false);
  FakeBackend backend(scene, make_field_set(best_fields(scene), scene), Precision::full, 8);
  const BestGrip best = evaluate_best(backend, scene, plan, 0, {{0.9, 1}}).front();
  EXPECT_TRUE(std::isnan(best.peak_force));
  EXPECT_EQ(best_table(scene, plan, {best}, {1}).find("peak N"), std::string::npos);
  const std::string row = lines(best_csv(scene, plan, {{best}}, {"a.nc", "s"}))[1];
  EXPECT_TRUE(row.ends_with(best.antipodal ? ",,,,,1,,,,,,,,,,,,,,,1,a.nc,s" : ",,,,,0,,,,,,,,,,,,,,,1,a.nc,s")) << row;
  EXPECT_NE(best_table(scene, plan, {best}, {1}).find("antipodal"), std::string::npos) << "nothing else says that it would slip";
}

}  // namespace
}  // namespace wholehand::sweeps

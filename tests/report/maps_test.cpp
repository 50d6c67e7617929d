// SPDX-License-Identifier: MIT
// Maps against the file's values gone through one by one, and what is said where the file lacks some.
// sanitizers: address
#include "report/maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>

#include "scene/reader.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

// The best grip of a height and roll by the file's own values: place in the plan, -1 for none; `has_feasible`: any at all.
struct BestHere {
  std::int64_t grip = -1;
  double score = 0;
  bool has_feasible = false;
};

BestHere best_here(const SweptScene& swept, const std::vector<double>& scores, const std::vector<double>& reasons,
                   std::size_t vessel, double height, double roll) {
  const std::size_t first = vessel * swept.plan->stored_grips();
  BestHere best;
  for (std::uint64_t i = 0; i < swept.plan->grips(); ++i) {
    const GripInput grip = swept.plan->grip(vessel, i);
    if (std::abs(grip.height - height) > 1e-9 || std::abs(grip.roll - roll) > 1e-9 || reasons[first + i] != 0) continue;
    best.has_feasible = true;
    if (scores[first + i] > best.score) best = {static_cast<std::int64_t>(i), scores[first + i], true};
  }
  return best;
}

TEST(ReportMaps, EachCellIsTheBestOfItsHeightAndRoll) {
  for (const Precision precision : {Precision::full, Precision::single}) {
    const SweptScene swept(RESULT_SCENE, precision);
    const auto scores = read_values(swept.path, "score"), reasons = read_values(swept.path, "reason");
    const auto fingers = read_values(swept.path, "fingers_used"), forces = read_values(swept.path, "peak_feedback_force");
    const std::uint64_t grips = swept.plan->stored_grips();
    for (std::size_t v = 0; v < 2; ++v) {
      const GripMap map = read_map(*swept.source, v);
      ASSERT_EQ(map.heights.cells(), 12u);
      ASSERT_EQ(map.rolls.cells(), 3u);
      EXPECT_TRUE(map.has_fingers && map.has_forces && map.knows_reasons && !map.is_by_core);
      for (std::size_t h = 0; h < 12; ++h) {
        for (std::size_t r = 0; r < 3; ++r) {
          const MapCell& cell = map.cells[h * 3 + r];
          const BestHere best =
              best_here(swept, scores, reasons, v, swept.scene.grips.height.values[h] * swept.scene.vessels[v].height,
                        swept.scene.grips.roll.values[r]);
          ASSERT_EQ(cell.kind, best.grip >= 0      ? CellKind::filled
                               : best.has_feasible ? CellKind::hollow
                                                   : CellKind::absent)
              << v << h << r;
          if (best.grip < 0) continue;
          const auto at = static_cast<std::size_t>(best.grip);
          EXPECT_EQ(cell.score, best.score);
          EXPECT_EQ(cell.grip, at);
          EXPECT_EQ(cell.fingers, fingers[v * grips + at]);
          EXPECT_EQ(cell.peak_force, std::max(forces[2 * v * grips + at], forces[(2 * v + 1) * grips + at]));
        }
      }
    }
  }
}

TEST(ReportMaps, TheirBestIsTheListsFirst) {
  const SweptScene swept(RESULT_SCENE);
  for (std::size_t v = 0; v < 2; ++v) {
    const GripMap map = read_map(*swept.source, v);
    ASSERT_NE(map.best(), nullptr);
    EXPECT_EQ(map.best()->score, swept.result->best(v)[0].score);
  }
}

TEST(ReportMaps, WhatTheFileLacksIsTheCores) {
  const SweptScene whole(RESULT_SCENE), score(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\"]"));
  const GripMap map = read_map(*whole.source, 1), other = read_map(*score.source, 1);
  EXPECT_TRUE(other.is_by_core && other.has_fingers && other.has_forces && !other.knows_reasons);
  ASSERT_EQ(map.cells.size(), other.cells.size());
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (map.cells[i].kind != CellKind::filled) continue;
    EXPECT_EQ(map.cells[i].grip, other.cells[i].grip);
    EXPECT_EQ(map.cells[i].fingers, other.cells[i].fingers);
    EXPECT_EQ(map.cells[i].peak_force, other.cells[i].peak_force);
  }
}

TEST(ReportMaps, WithoutTheCoreWhatTheFileLacksIsLeftOut) {
  SweptScene swept(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\"]"));
  swept.source->core = nullptr;
  const GripMap map = read_map(*swept.source, 0);
  EXPECT_FALSE(map.has_fingers || map.has_forces);
  MarkupWriter html;
  write_maps(html, *swept.source, 0, map, map_scales({map}), swept.result->best(0), "v");
  EXPECT_NE(html.written().find("does not have the fingers used"), std::string::npos);
  EXPECT_NE(html.written().find("does not have the forces"), std::string::npos);
  EXPECT_EQ(html.written().find("v-fingers-title"), std::string::npos);
}

TEST(ReportMaps, NoScoreNoMap) {
  EXPECT_TRUE(has_map(*SweptScene(RESULT_SCENE).source));
  EXPECT_FALSE(has_map(*SweptScene(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"gap\"]")).source));
}

TEST(ReportMaps, SobolPointsAreBinned) {
  const SweptScene swept(edited(
      edited(RESULT_SCENE, "roll_deg = [-90, -30, 0]", "roll_deg = { from = -90, to = 0 }\nsampling = \"sobol\"\ncount = 600"),
      ", count = 12", ""));
  const GripMap map = read_map(*swept.source, 0);
  const auto scores = read_values(swept.path, "score");
  EXPECT_EQ(map.cells.size(), 36u) << "16 points a cell";
  double best = 0;
  for (const MapCell& cell : map.cells) {
    if (cell.kind != CellKind::filled) continue;
    EXPECT_EQ(cell.score, scores[cell.grip]);
    best = std::max(best, cell.score);
  }
  EXPECT_EQ(best, *std::max_element(scores.begin(), scores.begin() + 600));
  MarkupWriter html;
  write_maps(html, *swept.source, 0, map, map_scales({map}), swept.result->best(0), "v");
  EXPECT_NE(html.written().find("the sweep has points and no grid"), std::string::npos);
}

TEST(ReportMaps, CountsAreThoseOfTheFile) {
  const SweptScene swept(RESULT_SCENE);
  const auto reasons = read_values(swept.path, "reason"), plausible = read_values(swept.path, "plausible"),
             antipodal = read_values(swept.path, "antipodal"), blocked = read_values(swept.path, "blocked_mask");
  for (std::size_t v = 0; v < 2; ++v) {
    GripCounts counts, wanted;
    ASSERT_TRUE(read_counts(*swept.source, v, counts));
    // one azimuth stands for all
    wanted.grips = swept.plan->grips();
    for (std::size_t i = 0; i < wanted.grips; ++i) {
      const std::size_t at = v * swept.plan->stored_grips() + i;
      ++wanted.by_reason[static_cast<std::size_t>(reasons[at])];
      wanted.implausible += plausible[at] == 0;
      wanted.antipodal += antipodal[at] == 1;
      wanted.blocked += blocked[at] > 0;
    }
    EXPECT_EQ(counts.grips, wanted.grips);
    EXPECT_EQ(counts.by_reason, wanted.by_reason);
    EXPECT_EQ(counts.implausible, wanted.implausible);
    EXPECT_EQ(counts.antipodal, wanted.antipodal);
    EXPECT_EQ(counts.blocked, wanted.blocked);
  }
  GripCounts counts;
  EXPECT_FALSE(read_counts(*SweptScene(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"reason\"]")).source, 0, counts));
}

// Any variable of one real a grip stands for the worst effort here: its values are the test's.
struct MappedEfforts {
  explicit MappedEfforts(const std::function<double(std::uint64_t stored)>& effort) : swept(RESULT_SCENE) {
    for (std::uint64_t i = 0; i < 2 * swept.plan->stored_grips(); ++i) values.push_back(effort(i));
    swept.change("gap", values);
    map = std::make_unique<GripMap>(read_map(*swept.source, 0, swept.result->find("gap")));
  }
  std::string written() const {
    MarkupWriter html;
    write_maps(html, *swept.source, 0, *map, map_scales({*map}), swept.result->best(0), "v");
    EXPECT_TRUE(html.is_closed());
    return html.written();
  }
  SweptScene swept;
  std::vector<double> values;
  std::unique_ptr<GripMap> map;
};

TEST(ReportMaps, EffortOfACellIsTheLeastOfItsGrips) {
  // no order in it, some infinite, some missing
  const MappedEfforts efforts([](std::uint64_t i) {
    const std::uint64_t k = i * 7919 % 101;
    return k < 30 ? INFINITY : k < 50 ? std::nan("") : static_cast<double>(k) / 100;
  });
  const SweptScene& swept = efforts.swept;
  const auto reasons = read_values(swept.path, "reason");
  int finite = 0, infinite = 0, missing = 0;
  for (std::size_t h = 0; h < 12; ++h) {
    for (std::size_t r = 0; r < 3; ++r) {
      double least = std::nan("");
      for (std::uint64_t i = 0; i < swept.plan->grips(); ++i) {
        const GripInput grip = swept.plan->grip(0, i);
        const bool is_here = std::abs(grip.height - swept.scene.grips.height.values[h] * swept.scene.vessels[0].height) < 1e-9 &&
                             std::abs(grip.roll - swept.scene.grips.roll.values[r]) < 1e-9;
        if (is_here && reasons[i] == 0 && !std::isnan(efforts.values[i])) least = std::fmin(least, efforts.values[i]);
      }
      const MapCell& cell = efforts.map->cells[h * 3 + r];
      (std::isnan(least) ? missing : std::isinf(least) ? infinite : finite) += 1;
      if (std::isnan(least)) {
        EXPECT_TRUE(std::isnan(cell.effort));
        continue;
      }
      EXPECT_EQ(cell.effort, least);
      EXPECT_EQ(efforts.values[cell.effort_grip], least);
    }
  }
  EXPECT_GT(finite, 0);
  EXPECT_GT(infinite + missing, 0);
}

TEST(ReportMaps, EffortsThatNothingHoldsAndMissingOnesAreDrawnApart) {
  const MappedEfforts efforts([](std::uint64_t i) { return i % 3 == 0 ? INFINITY : i % 3 == 1 ? std::nan("") : 0.3; });
  const std::string html = efforts.written();
  const std::size_t at = html.find("id=\"v-worst-effort-title\"");
  ASSERT_NE(at, std::string::npos);
  const std::string chart = html.substr(at);
  EXPECT_NE(chart.find(">worst effort</text>"), std::string::npos);
  const auto has_kind = [&](const auto& is) {
    return std::any_of(efforts.map->cells.begin(), efforts.map->cells.end(), [&](const MapCell& cell) { return is(cell.effort); });
  };
  // the legend names what there is and nothing else
  EXPECT_EQ(chart.find(">nothing holds</text>") != std::string::npos, has_kind([](double e) { return std::isinf(e); }));
  EXPECT_EQ(chart.find(">none plausible</text>") != std::string::npos, has_kind([](double e) { return std::isnan(e); }));
  const MappedEfforts never([](std::uint64_t) { return INFINITY; });
  EXPECT_NE(never.written().find("no grip holds the vessel. In "), std::string::npos);
  EXPECT_NE(never.written().find(">nothing holds</text>"), std::string::npos);
}

TEST(ReportMaps, GreatEffortsHaveTheColourOfTheLargestShown) {
  const MappedEfforts efforts([](std::uint64_t i) { return i % 2 == 0 ? 0.21 : 700; });
  const MapScales scales = map_scales({*efforts.map});
  EXPECT_EQ(scales.effort.low, 0.2);
  EXPECT_LE(scales.effort.high, MOST_MAPPED_EFFORT);
  const MappedEfforts all([](std::uint64_t) { return 700; });
  EXPECT_EQ(map_scales({*all.map}).effort.high, MOST_MAPPED_EFFORT);
  EXPECT_NE(all.written().find("Efforts above 2 have the colour of 2."), std::string::npos);
}

TEST(ReportMaps, DamagedEffortsAreNone) {
  const MappedEfforts efforts([](std::uint64_t i) { return i % 2 == 0 ? -1.0 : -INFINITY; });
  for (const MapCell& cell : efforts.map->cells) EXPECT_TRUE(std::isnan(cell.effort));
}

TEST(ReportMaps, WithoutEffortsThereIsNoMapOfThem) {
  const SweptScene swept(RESULT_SCENE);
  EXPECT_EQ(effort_variable(*swept.source), nullptr);
  const GripMap map = read_map(*swept.source, 0);
  EXPECT_FALSE(map.has_efforts);
  MarkupWriter html;
  write_maps(html, *swept.source, 0, map, map_scales({map}), {}, "v");
  EXPECT_EQ(html.written().find("effort"), std::string::npos);
}

TEST(ReportMaps, ColoursMeanTheSameForAllVessels) {
  const SweptScene swept(RESULT_SCENE);
  const std::vector<GripMap> maps{read_map(*swept.source, 0), read_map(*swept.source, 1)};
  const MapScales scales = map_scales(maps);
  for (const GripMap& map : maps) {
    for (const MapCell& cell : map.cells) {
      if (cell.kind != CellKind::filled) continue;
      EXPECT_LE(scales.score.low, cell.score);
      EXPECT_GE(scales.score.high, cell.score);
      EXPECT_LE(scales.peak_force.low, cell.peak_force);
      EXPECT_GE(scales.peak_force.high, cell.peak_force);
    }
  }
  EXPECT_EQ(scales.fingers.steps, 6);
}

TEST(ReportMaps, DamagedValuesAreNoBest) {
  SweptScene swept(edited(RESULT_SCENE, "best = 5", "best = 0"));
  swept.change("score", {INFINITY, std::nan(""), -1});
  const GripMap map = read_map(*swept.source, 0);
  for (const MapCell& cell : map.cells) EXPECT_TRUE(std::isfinite(cell.score));
}

TEST(ReportMaps, OneGripAndNoGripGetASentence) {
  const SweptScene one(edited(edited(RESULT_SCENE, "{ from = 0.1, to = 0.95, count = 12 }", "0.5"), "[-90, -30, 0]", "0"));
  MarkupWriter html;
  const GripMap map = read_map(*one.source, 0);
  write_maps(html, *one.source, 0, map, map_scales({map}), {}, "v");
  EXPECT_NE(html.written().find("one height and one roll"), std::string::npos);
  EXPECT_EQ(html.written().find("<svg"), std::string::npos);
  const SweptScene none(edited(RESULT_SCENE, "diameter_mm = 70", "diameter_mm = 300"));
  MarkupWriter other;
  const GripMap empty = read_map(*none.source, 0);
  EXPECT_EQ(empty.best(), nullptr);
  write_maps(other, *none.source, 0, empty, map_scales({empty}), {}, "v");
  EXPECT_NE(other.written().find("nothing to map"), std::string::npos);
}

}  // namespace
}  // namespace wholehand

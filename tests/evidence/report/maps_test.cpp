// SPDX-License-Identifier: MIT
// Maps against the file's values gone through one by one, and the text where the file lacks some.
// sanitizers: address
#include "evidence/report/maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>

#include "core/reader/reader.h"
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
  std::uint64_t unsplit = 0;
  for (std::size_t v = 0; v < 2; ++v) {
    sweeps::GripCounts counts, wanted;
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
    unsplit += counts.through_table + counts.self_overlap + counts.only_deep;
  }
  EXPECT_EQ(unsplit, 0u) << "the file does not keep why grips are implausible";
  sweeps::GripCounts counts;
  EXPECT_FALSE(read_counts(*SweptScene(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"reason\"]")).source, 0, counts));
}

// As a sweep counts them, where the file has what makes a grip implausible.
TEST(ReportMaps, ImplausibleGripsAreToldApartWhereTheFileHasWhy) {
  const SweptScene swept(edited(RESULT_SCENE, "[output]", "[table]\n[output]\nalso = [\"through_table\", \"self_overlap\"]"));
  const auto reasons = read_values(swept.path, "reason"), plausible = read_values(swept.path, "plausible"),
             table = read_values(swept.path, "through_table"), overlap = read_values(swept.path, "self_overlap");
  sweeps::GripCounts counts, wanted;
  ASSERT_TRUE(read_counts(*swept.source, 0, counts));
  for (std::size_t at = 0; at < swept.plan->grips(); ++at) {
    if (reasons[at] != 0 || plausible[at] != 0) continue;
    wanted.through_table += table[at] == 1;
    wanted.self_overlap += overlap[at] == 1;
    wanted.only_deep += table[at] != 1 && overlap[at] != 1;
  }
  EXPECT_GT(wanted.through_table, 0u);
  EXPECT_GT(wanted.only_deep, 0u);
  EXPECT_EQ(counts.through_table, wanted.through_table);
  EXPECT_EQ(counts.self_overlap, wanted.self_overlap);
  EXPECT_EQ(counts.only_deep, wanted.only_deep);
}

// Any variable of one real a grip stands for the worst effort here: its values are the test's, by the grip and its place.
struct MappedEfforts {
  explicit MappedEfforts(const std::function<double(const GripInput& grip, std::uint64_t stored)>& effort) : swept(RESULT_SCENE) {
    for (std::uint64_t i = 0; i < 2 * swept.plan->stored_grips(); ++i)
      values.push_back(effort(swept.plan->grip(0, i % swept.plan->grips()), i));
    swept.change("gap", values);
    map = std::make_unique<GripMap>(read_map(*swept.source, 0, swept.result->find("gap")));
  }
  std::string written() const {
    MarkupWriter html;
    write_maps(html, *swept.source, 0, *map, map_scales({*map}), swept.result->best(0), "v");
    EXPECT_TRUE(html.is_closed());
    return html.written();
  }
  // The chart of efforts alone.
  std::string chart() const {
    const std::string html = written();
    const std::size_t at = html.find("id=\"v-worst-effort-title\"");
    EXPECT_NE(at, std::string::npos);
    return at == std::string::npos ? "" : html.substr(at);
  }
  SweptScene swept;
  std::vector<double> values;
  std::unique_ptr<GripMap> map;
};

// The cells of a roll: -90, -30 or 0 degrees.
std::size_t column_of(const GripInput& grip) { return grip.roll < radians(-60) ? 0 : grip.roll < radians(-15) ? 1 : 2; }

TEST(ReportMaps, EffortOfACellIsTheLeastOfItsGrips) {
  // no order in it, many infinite, some missing; of one roll all are missing
  const MappedEfforts efforts([](const GripInput& grip, std::uint64_t i) {
    const std::uint64_t k = i * 7919 % 101;
    if (column_of(grip) == 2 || k >= 90) return std::nan("");
    return k < 60 ? INFINITY : static_cast<double>(k) / 100;
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
  EXPECT_GT(infinite, 0);
  EXPECT_GE(missing, 12);
}

// A cell has one kind of efforts alone, by its roll: with kinds mixed in a cell the least of them would be finite everywhere.
TEST(ReportMaps, EffortsThatNothingHoldsAndMissingOnesAreDrawnApart) {
  const auto by_roll = [](const std::array<double, 3>& efforts) {
    return MappedEfforts([efforts](const GripInput& grip, std::uint64_t) { return efforts[column_of(grip)]; });
  };
  const auto has = [](const std::string& text, const char* wanted) { return text.find(wanted) != std::string::npos; };
  const MappedEfforts apart = by_roll({INFINITY, std::nan(""), 0.3});
  std::array<int, 3> infinite{}, missing{}, finite{};  // by roll
  for (std::size_t k = 0; k < apart.map->cells.size(); ++k) {
    const double effort = apart.map->cells[k].effort;
    ++(std::isinf(effort) ? infinite : std::isnan(effort) ? missing : finite)[k % 3];
  }
  EXPECT_GT(infinite[0], 0);
  EXPECT_EQ(infinite[1] + infinite[2], 0);
  EXPECT_EQ(missing[1], 12);
  EXPECT_GT(finite[2], 0);
  EXPECT_EQ(finite[0] + finite[1], 0);
  const std::string chart = apart.chart();
  for (const char* text : {">worst effort</text>", ">nothing holds</text>", ">none plausible</text>", "class=\"cell hollow\""})
    EXPECT_TRUE(has(chart, text)) << text;
  EXPECT_TRUE(has(chart, (" In " + std::to_string(infinite[0]) + " of 36 cells no force of the hand holds the vessel.").c_str()));
  // the legend names what there is and nothing else
  const std::string held = by_roll({0.2, std::nan(""), 0.3}).chart();
  for (const char* text : {">nothing holds</text>", "class=\"cell hollow\"", " no force of the hand holds"})
    EXPECT_FALSE(has(held, text)) << text;
  EXPECT_TRUE(has(held, ">none plausible</text>"));
  const MappedEfforts known = by_roll({INFINITY, 0.2, 0.3});
  const bool is_whole =
      std::none_of(known.map->cells.begin(), known.map->cells.end(), [](const MapCell& cell) { return std::isnan(cell.effort); });
  EXPECT_TRUE(is_whole);
  EXPECT_TRUE(has(known.chart(), ">nothing holds</text>"));
  EXPECT_FALSE(has(known.chart(), ">none plausible</text>"));
  const std::string never = by_roll({INFINITY, INFINITY, INFINITY}).chart();
  EXPECT_TRUE(has(never, "no grip holds the vessel. In "));
  EXPECT_TRUE(has(never, ">nothing holds</text>"));
}

TEST(ReportMaps, GreatEffortsHaveTheColorOfTheLargestShown) {
  const MappedEfforts efforts([](const GripInput&, std::uint64_t i) { return i % 2 == 0 ? 0.21 : 700; });
  const MapScales scales = map_scales({*efforts.map});
  EXPECT_EQ(scales.effort.low, 0.2);
  EXPECT_LE(scales.effort.high, MOST_MAPPED_EFFORT);
  const MappedEfforts all([](const GripInput&, std::uint64_t) { return 700; });
  EXPECT_EQ(map_scales({*all.map}).effort.high, MOST_MAPPED_EFFORT);
  EXPECT_NE(all.written().find("Efforts above 2 have the color of 2."), std::string::npos);
}

TEST(ReportMaps, DamagedEffortsAreNone) {
  const MappedEfforts efforts([](const GripInput&, std::uint64_t i) { return i % 2 == 0 ? -1.0 : -INFINITY; });
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

TEST(ReportMaps, ColorsMeanTheSameForAllVessels) {
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

// SPDX-License-Identifier: MIT
// The scenes of examples/extreme on every backend against the core in double, and that against long double.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "evidence/check/extreme.h"
#include "tests/support/extreme_scenes.h"
#include "tests/support/long_double.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

// Where float is not within its tolerances, and why.
const std::map<std::string, std::string> FLOAT_EXCEPTIONS{
    {"along_the_axis", "2e-8 off the axis is nearer than float's DEGENERATE_SINE and further than double's"},
    {"far_off", "at 25 m from an arc's center float's distances step by 2 um, more than its stop tolerance: proxies do not settle"},
    {"weak_and_strong",
     "strengths are in the ratio of 1 to 100,000: in the unit of the strongest the weakest is near float's rounding"},
};

void expect_holds(const ExtremeRow& row) {
  const std::string who = row.name + ", " + row.backend + (row.precision == Precision::single ? " float" : " double");
  EXPECT_EQ(row.misplaced, 0u) << who << ": " << row.first_misplaced;
  EXPECT_EQ(row.reasons[REASON_NOT_CONVERGED], 0u) << who;
  EXPECT_EQ(row.unsettled_fingers, 0u) << who;
  const bool excepted = row.precision == Precision::single && FLOAT_EXCEPTIONS.count(row.name) > 0;
  EXPECT_EQ(row.holds, !excepted) << who << (excepted ? ": no longer an exception" : "");
  if (row.precision == Precision::full) {
    EXPECT_EQ(row.unsettled_proxies, 0u) << who;
    EXPECT_EQ(row.touch_flips + row.feasible_flips, 0u) << who;
  }
  for (const Comparison& c : row.comparisons)
    if (c.outside > 0 && !excepted)
      ADD_FAILURE() << who << ": " << c.quantity << " worst " << c.worst << " " << c.unit << ", tolerance " << c.tolerance
                    << " at #" << c.grip;
}

TEST(Extreme, EveryBackendHolds) {
  const std::vector<std::string> names = extreme_names();
  std::vector<ExtremeRow> all;
  for (const std::string& name : names) {
    ExtremeOptions options;
    options.grips = 90;  // of each vessel
    for (const ExtremeRow& row : evaluate_extreme(extreme_case(extreme_scene(name)), options)) {
      expect_holds(row);
      all.push_back(row);
    }
  }
  EXPECT_EQ(all.size(), 4 * names.size());
  const std::string csv = extreme_csv(all);
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), all.size() + 1);
}

// What double itself costs where it is in question: all but the outline of a thousand elements, which adds nothing but time.
TEST(Extreme, DoubleIsWithinItsTolerancesOfLongDouble) {
  for (const std::string& name : extreme_names()) {
    if (name == "thousand_elements") continue;
    const AnsweredScene full(extreme_scene(name));
    const auto wide = core_ld::make_evaluator(full.scene, {});
    Comparer comparer(full.scene, *full.core, allowance(Precision::full));
    for (std::size_t v = 0; v < full.planes.size(); ++v) {
      comparer.add(v, full.grips[v], full.planes[v], gather(*wide, full.fields, v, full.grips[v]));
      if (full.scene.liquid) comparer.add_liquid(v, core_liquid(full.scene, *full.core, v), core_liquid(full.scene, *wide, v));
    }
    EXPECT_TRUE(comparer.holds()) << name << "\n" << table_of(comparer);
  }
}

// The CSV has a field for every column of its head.
TEST(Extreme, RowsHaveTheColumnsOfTheHead) {
  ExtremeOptions options;
  options.on = "core";
  const auto rows = evaluate_extreme(extreme_case(extreme_scene("center_of_mass")), options);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_GT(rows[0].trace_steps, 0);
  EXPECT_GT(rows[0].advance_steps, 0);
  EXPECT_EQ(rows[0].posed, 0);
  EXPECT_GT(rows[1].posed, 0);
  EXPECT_EQ(rows[0].grips, 4u);
  const std::string csv = extreme_csv(rows);
  std::size_t commas[3] = {0, 0, 0}, line = 0;
  bool quoted = false;
  for (const char c : csv) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) ++commas[line];
    if (c == '\n') ++line;
  }
  EXPECT_EQ(line, 3u);
  EXPECT_EQ(commas[1], commas[0]);
  EXPECT_EQ(commas[2], commas[0]);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Maps of rendered walls against the theory that is drawn over them.
// sanitizers: none
#include "device/loop/wall_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/result_reader.h"

namespace wholehand::device {
namespace {

const WallSheet& sheet_named(const std::vector<WallSheet>& sheets, const std::string& name) {
  return *std::find_if(sheets.begin(), sheets.end(), [&](const WallSheet& sheet) { return sheet.name == name; });
}

void every_passive_point_settles(const std::vector<WallSheet>& sheets) {
  std::size_t passive = 0;
  for (const WallColumn& column : sheet_named(sheets, "stiffness_damping_rate").columns)
    for (const WallPoint& point : column.points) {
      if (!(point.stiffness < column.theory.passive)) continue;
      ++passive;
      EXPECT_TRUE(point.settles()) << point.stiffness << " N/m at " << point.device.rate << " Hz, B " << point.device.wall_damping;
    }
  EXPECT_GT(passive, 1000u);
}

// The two points of a column that the limit lies between, on every sheet that theory covers: no encoder, no friction, exact motion.
void the_linear_limit_lies_where_it_changes(const std::vector<WallSheet>& sheets) {
  std::size_t columns = 0;
  for (const char* name : {"stiffness_damping_rate", "delay", "finger"})
    for (const WallColumn& column : sheet_named(sheets, name).columns) {
      ++columns;
      const auto next = std::find_if(column.points.begin(), column.points.end(), [](const WallPoint& p) { return !p.settles(); });
      ASSERT_NE(next, column.points.end()) << name;
      const WallDevice& device = next->device;
      EXPECT_LE(column.theory.linear, next->stiffness * 1.01) << name << " at " << device.rate << " Hz, B " << device.wall_damping;
      if (next == column.points.begin()) continue;
      EXPECT_GE(column.theory.linear, 0.99 * column.theory.simulated)
          << name << " at " << device.rate << " Hz, B " << device.wall_damping;
    }
  EXPECT_GT(columns, 150u);
}

// What friction and a fine encoder allow is at least Abbott and Okamura's bound.
void encoder_and_friction_settle_up_to_their_bound(const std::vector<WallSheet>& sheets) {
  for (const WallColumn& column : sheet_named(sheets, "encoder").columns)
    for (const WallPoint& point : column.points)
      if (point.stiffness < column.theory.coulomb) {
        EXPECT_TRUE(point.settles()) << point.stiffness << " N/m, step " << point.device.encoder_step;
      }
}

// Explicit Euler takes from the limit, semi-implicit adds to it, and both come nearer with their sub-steps, to first order.
TEST(WallSweep, IntegratorsMoveTheLimit) {
  WallDevice device;
  const double exact = integrator_limit(device, LOOP_EXACT, 1);
  EXPECT_NEAR(exact / wall_theory(device).linear, 1, 1e-3);
  for (const int integrator : {LOOP_EULER, LOOP_SEMI_IMPLICIT}) {
    double before = 0;
    for (const int substeps : {8, 16, 32}) {
      const double off = integrator_limit(device, integrator, substeps) / exact - 1;
      EXPECT_EQ(off < 0, integrator == LOOP_EULER) << substeps;
      if (before != 0) {
        EXPECT_NEAR(before / off, 2, 0.2) << substeps;
      }
      before = off;
    }
  }
  EXPECT_LT(integrator_limit(device, LOOP_EULER, 1), 0.7 * exact);
  EXPECT_GT(integrator_limit(device, LOOP_SEMI_IMPLICIT, 2), 1.5 * exact);
}

void tables_have_a_row_a_point_and_a_row_a_column(const std::vector<WallSheet>& sheets) {
  const auto lines = [](const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')); };
  EXPECT_EQ(lines(wall_csv(sheets)), 1 + count_points(sheets));
  std::size_t columns = 0;
  for (const WallSheet& sheet : sheets) columns += sheet.columns.size();
  const std::string limits = wall_limits_csv(sheets, "a,b,c,d");
  EXPECT_EQ(lines(limits), 1 + columns);
  const std::string head = limits.substr(0, limits.find('\n')), row = limits.substr(limits.find('\n') + 1);
  EXPECT_EQ(std::count(head.begin(), head.end(), ','),
            std::count(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(row.find('\n')), ','));
}

// One test, since the maps are what takes time.
TEST(WallSweep, MapsAgreeWithTheory) {
  std::vector<WallSheet> sheets = wall_sheets(true, 1);
  run_walls(sheets);
  every_passive_point_settles(sheets);
  the_linear_limit_lies_where_it_changes(sheets);
  encoder_and_friction_settle_up_to_their_bound(sheets);
  tables_have_a_row_a_point_and_a_row_a_column(sheets);
}

TEST(WallSheets, AFullRunHasMoreThanAHundredThousandPoints) {
  const auto sheets = wall_sheets(false, 1);
  EXPECT_GE(sheet_named(sheets, "stiffness_damping_rate").columns.size() * 96, 100000u);
}

}  // namespace
}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// Pictures of walls and of held grips: what the tables say, where it is.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/charts/colors.h"
#include "base/files/pictures.h"
#include "device/loop/grip_loop.h"
#include "evidence/check/grip_loop_picture.h"
#include "evidence/check/wall_picture.h"
#include "tests/support/drawn.h"
#include "tests/support/files.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

const char* const LIMIT = "#1f4e79";

// What theory says settles, and nothing else.
std::vector<device::WallSheet> sheets_by_theory() {
  std::vector<device::WallSheet> sheets = device::wall_sheets(true, 1);
  for (device::WallSheet& sheet : sheets)
    for (device::WallColumn& column : sheet.columns)
      for (device::WallPoint& point : column.points) point.energy = point.stiffness <= column.theory.linear ? 0 : 2;
  return sheets;
}

TEST(WallPicture, HasFourMapsWithTheirLimits) {
  const std::string svg = wall_picture(sheets_by_theory());
  expect_well_formed(svg);
  EXPECT_TRUE(has(svg, std::string(PICTURE_MARK)));
  for (const char* text : {"A rendered wall on a device of 100 g, 1 N s/m", "no wall damping", "rate (Hz)", ">250<", ">8,000<",
                           ">10⁴<", "wall damping B (N s/m)", "delay (samples)", "encoder step D (µm)", "stiffness K (N/m)",
                           "settles", "does not", "linear limit", "b = KT/2 + |B|", "min(2b/T, 2f_c/D)"})
    EXPECT_TRUE(has(svg, text)) << text;
  const auto axes = drawn_axes(svg);
  ASSERT_EQ(axes.size(), 4u);
  // the linear limit lies between what settles and what does not, in every column of every map
  const auto settled = drawn_boxes(svg, tint(okabe_ito::BLUE, 0.28));
  const auto lines = drawn_lines(svg, LIMIT);
  ASSERT_EQ(lines.size(), 1u + axes.size()) << "one in the legend";
  int compared = 0;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    for (const auto& point : lines[k + 1]) {
      for (const auto& box : settled) {
        const bool is_of_point =
            box[0] < point[0] && point[0] < box[2] && box[1] >= axes[k].top && box[3] <= axes[k].top + axes[k].height + 1;
        if (!is_of_point) continue;
        EXPECT_NEAR(box[1], point[1], 8) << "a step of the stiffness";
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 15);
  EXPECT_FALSE(drawn_boxes(svg, tint(okabe_ito::ORANGE, 0.4)).empty());
}

TEST(WallPicture, WhereNothingSettlesThereIsNoSuchArea) {
  std::vector<device::WallSheet> sheets = device::wall_sheets(true, 1);
  for (device::WallSheet& sheet : sheets)
    for (device::WallColumn& column : sheet.columns) {
      for (device::WallPoint& point : column.points) point.energy = std::nan("");
      column.theory.linear = HUGE_VAL;
      column.theory.passive = 0;
    }
  const std::string svg = wall_picture(sheets);
  expect_well_formed(svg);
  EXPECT_TRUE(drawn_boxes(svg, tint(okabe_ito::BLUE, 0.28)).empty());
  EXPECT_EQ(drawn_lines(svg, LIMIT).size(), 1u) << "in the legend";
}

TEST(IntegratorPicture, HasALimitForEverySubStep) {
  const std::string svg = integrator_picture(device::wall_sheets(true, 1));
  expect_well_formed(svg);
  for (const char* text : {"explicit Euler", "semi-implicit Euler", "exact", "sub-steps of a sample", ">16<"})
    EXPECT_TRUE(has(svg, text)) << text;
  const auto lines = drawn_lines(svg, LIMIT);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(drawn_marks(svg, LIMIT), lines[1].size() + 1) << "and one in the legend";
  // more sub-steps, nearer to the exact limit, from above
  for (std::size_t k = 1; k < lines[1].size(); ++k) EXPECT_GT(lines[1][k][1], lines[1][k - 1][1]);
  EXPECT_EQ(drawn_lines(svg, "#404040").at(1).size(), 2u);
}

TEST(GripLoopPicture, ShowsWhoHolds) {
  const std::string svg = grip_loop_picture();
  expect_well_formed(svg);
  for (const char* text :
       {"k_open (N/m)", "reaction time of the user (s)", "settles", "oscillates", "user, by theory", "sampling, by theory"})
    EXPECT_TRUE(has(svg, text)) << text;
  const DrawnAxes axes = drawn_axes(svg).at(0);
  const auto y_of = [&](double k_open) { return axes.top + axes.height * (1 - std::log(k_open / 40) / std::log(30000.0 / 40)); };
  EXPECT_NEAR(drawn_lines(svg, "#404040").at(1).at(0)[1], y_of(device::sampled_k_open(device::GripLoop{})), 0.1);
  // an ordinary user settles
  const device::GripLoop usual;
  const double x = axes.left + axes.width * usual.reaction / 0.605, y = y_of(usual.k_open);
  const auto settles = drawn_boxes(svg, tint(okabe_ito::SKY_BLUE, 0.5));
  EXPECT_TRUE(std::any_of(settles.begin(), settles.end(),
                          [&](const auto& box) { return box[0] <= x && x <= box[2] && box[1] <= y && y <= box[3]; }));
}

}  // namespace
}  // namespace wholehand

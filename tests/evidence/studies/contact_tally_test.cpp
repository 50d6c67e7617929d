// SPDX-License-Identifier: MIT
// Statistics of a few made grasps, of which the answers are known.
#include "evidence/studies/contact_tally.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace wholehand {
namespace {

constexpr double TALLY_ROUNDING = 1e-12;

std::map<std::string, double> tally_values(const std::vector<ContactGrasp>& grasps) {
  ContactTally tally;
  for (const ContactGrasp& grasp : grasps) tally.add(grasp);
  std::map<std::string, double> values;
  const std::vector<double> all = tally.values();
  EXPECT_EQ(all.size(), contact_statistics().size());
  for (std::size_t k = 0; k < all.size(); ++k)
    values[contact_statistics()[k].name + " " + contact_statistics()[k].subject] = all[k];
  return values;
}

// `count` bits from bit `first` on.
std::uint32_t low_bits(int count, int first = 0) { return ((1u << count) - 1) << first; }

// Five that hold, and one that does not and so is nowhere but in the share.
std::vector<ContactGrasp> few_grasps() {
  const double heights[] = {0.03, 0.05, 0.06, 0.08, 0.09}, distances[] = {0.02, 0.005, 0.01, 0.03, 0.015};
  const int fingers[] = {2, 3, 3, 5, 4}, points[] = {3, 4, 5, 7, 6};
  const std::uint32_t thumb_mcp[] = {0, 1, 1, 1, 0};
  std::vector<ContactGrasp> grasps;
  for (int i = 0; i < 5; ++i)
    grasps.push_back({heights[i], distances[i], thumb_mcp[i] << 1 | low_bits(points[i] - static_cast<int>(thumb_mcp[i]), 4), 0, 0,
                      0, low_bits(fingers[i]), true, i != 3});
  grasps[1].tip_mask = 1u << 13;
  grasps[2].tip_mask = 1u << 13 | 1u << 18;
  grasps[2].inner_mask = 1u << 12;
  grasps.push_back({0.2, 0.5, low_bits(24), low_bits(24), low_bits(24), low_bits(24), low_bits(5), false, false});
  return grasps;
}

// By exact fractions in Python.
TEST(ContactTally, OfAFewGrasps) {
  const auto values = tally_values(few_grasps());
  EXPECT_DOUBLE_EQ(values.at("held_share "), 5.0 / 6);
  EXPECT_DOUBLE_EQ(values.at("plausible_share "), 4.0 / 5);
  EXPECT_NEAR(values.at("mean_fingers "), 3.4, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("mean_points "), 5, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("pearson_fingers_height "), 0.8816620300447741, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("pearson_fingers_distance "), 0.5243548654756862, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("pearson_points_height "), 0.9271726499455307, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("pearson_points_distance "), 0.4931969619160718, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("point_biserial_height thumb_mcp"), 0.07647191129018725, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("point_biserial_distance thumb_mcp"), -0.14237369936287483, TALLY_ROUNDING);
  EXPECT_NEAR(values.at("touch_share thumb_mcp"), 0.6, TALLY_ROUNDING);
}

TEST(ContactTally, CountsProjectedPointsByRole) {
  const auto values = tally_values(few_grasps());
  EXPECT_DOUBLE_EQ(values.at("projected_share "), 2.0 / 5);
  EXPECT_DOUBLE_EQ(values.at("projected_tip_share "), 3.0 / 4);
  EXPECT_DOUBLE_EQ(values.at("projected_finger_share "), 0);
  EXPECT_DOUBLE_EQ(values.at("projected_inner_share "), 1.0 / 4);
  EXPECT_DOUBLE_EQ(values.at("grasps_projected_tip_share "), 2.0 / 5);
  EXPECT_DOUBLE_EQ(values.at("grasps_projected_finger_share "), 0);
  EXPECT_DOUBLE_EQ(values.at("grasps_projected_inner_share "), 1.0 / 5);
}

// index_cmc touches in all of them, thumb_tip in none.
TEST(ContactTally, WhatAlwaysOrNeverTouchesHasNoCorrelation) {
  const auto values = tally_values(few_grasps());
  EXPECT_DOUBLE_EQ(values.at("touch_share index_cmc"), 1);
  EXPECT_DOUBLE_EQ(values.at("touch_share thumb_tip"), 0);
  for (const char* point : {"index_cmc", "thumb_tip"})
    EXPECT_TRUE(std::isnan(values.at(std::string("point_biserial_height ") + point))) << point;
}

TEST(ContactTally, OfNoGraspHasNothing) {
  for (const auto& [name, value] : tally_values({})) EXPECT_TRUE(std::isnan(value)) << name;
  std::vector<ContactGrasp> lost(3);
  for (const auto& [name, value] : tally_values(lost)) {
    if (name == "held_share ") {
      EXPECT_EQ(value, 0);
    } else {
      EXPECT_TRUE(std::isnan(value)) << name;
    }
  }
}

// Counts and no running means: 171 of 4,000 are 0.04275 to the bit.
TEST(ContactTally, SharesAreCounted) {
  std::vector<ContactGrasp> grasps;
  for (std::uint32_t i = 0; i < 4000; ++i)
    grasps.push_back({1e-5 * i, 0, i * 171 / 4000 != (i + 1) * 171 / 4000 ? 2u : 0u, 0, 0, 0, i % 4 == 0 ? 3u : 1u, true, false});
  const auto values = tally_values(grasps);
  EXPECT_EQ(values.at("touch_share thumb_mcp"), 0.04275);
  EXPECT_EQ(values.at("mean_points "), 0.04275);
  EXPECT_EQ(values.at("mean_fingers "), 1.25);
}

// What is left of a search for a contact is no scatter of a hand.
TEST(ContactTally, DistancesVaryByMoreThanTheSearchForContactsLeaves) {
  for (const double apart : {3e-9, 1e-5}) {
    std::vector<ContactGrasp> grasps = few_grasps();
    for (std::size_t k = 0; k < grasps.size(); ++k) grasps[k].distance = apart * static_cast<double>(k % 2);
    const auto values = tally_values(grasps);
    EXPECT_EQ(std::isnan(values.at("pearson_points_distance ")), apart < 1e-7);
    EXPECT_EQ(std::isnan(values.at("point_biserial_distance thumb_mcp")), apart < 1e-7);
    EXPECT_FALSE(std::isnan(values.at("point_biserial_height thumb_mcp")));
  }
}

// Each grasp three times.
TEST(ContactTally, WeighsTheGraspsOfAnother) {
  ContactTally one, sum, thrice;
  for (const ContactGrasp& grasp : few_grasps()) {
    one.add(grasp);
    for (int copy = 0; copy < 3; ++copy) thrice.add(grasp);
  }
  sum.add(one, 3);
  EXPECT_EQ(sum.grasps(), 18);
  EXPECT_EQ(sum.held(), 15);
  const std::vector<double> values = sum.values(), expected = thrice.values();
  for (std::size_t k = 0; k < values.size(); ++k) {
    EXPECT_EQ(std::isnan(values[k]), std::isnan(expected[k])) << contact_statistics()[k].name;
    if (std::isnan(values[k])) continue;
    EXPECT_NEAR(values[k], expected[k], TALLY_ROUNDING) << contact_statistics()[k].name;
  }
}

}  // namespace
}  // namespace wholehand

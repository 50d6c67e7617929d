// SPDX-License-Identifier: MIT
// Best grips at the ends of the axes: which axes are named, and where an end is none.
// sanitizers: address
#include "sweeps/plan/edge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/fake_backend.h"

namespace wholehand::sweeps {
namespace {

using Keys = std::vector<std::string>;

// The number of the grip at these places of the axes azimuth, obliquity, roll, offset, hand scale, height.
std::uint64_t numbered(const Plan& plan, std::array<std::uint64_t, 6> places) {
  std::uint64_t number = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const bool is_left_out = k == PLACE_AZIMUTH && plan.copies() > 1;
    number = number * (is_left_out ? 1 : plan.axes()[k].values.size()) + places[k];
  }
  return number;
}

// Keys that the sweep names when the best grip is at these places of fake_scene's axes: 5 obliquities, 4 rolls, 2 offsets, 1 hand
// scale, 7 heights.
Keys keys_at(const Scene& scene, std::array<std::uint64_t, 6> places) {
  const Plan plan(scene, false);
  return edge_axes(scene, plan, 0, {{0.9, numbered(plan, places)}, {0.5, 0}});
}

Scene one_offset() {
  Scene scene = fake_scene();
  scene.grips.offset.values = {0};
  return scene;
}

TEST(Edge, AnAxisIsNamedAtEitherEndAndNotBetween) {
  const Scene scene = one_offset();
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 3}), Keys());
  EXPECT_EQ(keys_at(scene, {0, 2, 0, 0, 0, 3}), Keys({"roll_deg"}));
  EXPECT_EQ(keys_at(scene, {0, 2, 3, 0, 0, 3}), Keys({"roll_deg"}));
  EXPECT_EQ(keys_at(scene, {0, 0, 3, 0, 0, 6}), Keys({"height_fraction", "obliquity_deg", "roll_deg"}));
  EXPECT_EQ(keys_at(fake_scene(), {0, 2, 1, 1, 0, 3}), Keys({"offset_mm"}));
}

TEST(Edge, TheEndsOfAListAreItsSmallestAndLargest) {
  Scene scene = one_offset();
  scene.grips.roll.values = {radians(-30), radians(-90), radians(30), radians(0)};
  scene.grips.roll.is_range = false;
  EXPECT_EQ(keys_at(scene, {0, 2, 0, 0, 0, 3}), Keys()) << "the first of the list is not its smallest";
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 3}), Keys({"roll_deg"}));
  EXPECT_EQ(keys_at(scene, {0, 2, 2, 0, 0, 3}), Keys({"roll_deg"}));
}

TEST(Edge, NoEndWhereNothingGoesOn) {
  Scene scene = one_offset();
  scene.grips.height = range_axis(0, 1, 7);
  scene.grips.obliquity = range_axis(radians(-90), radians(80), 5);
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 0}), Keys()) << "the lowest point";
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 6}), Keys()) << "the mouth";
  EXPECT_EQ(keys_at(scene, {0, 0, 1, 0, 0, 3}), Keys()) << "a vertical line";
  EXPECT_EQ(keys_at(scene, {0, 4, 1, 0, 0, 3}), Keys({"obliquity_deg"}));
  scene.grips.height_is_fraction = false;
  scene.grips.height = range_axis(0.02, 0.11, 7);  // up to the mouth of the first vessel
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 0}), Keys({"height_mm"}));
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 6}), Keys());
  const Plan plan(scene, false);
  EXPECT_EQ(edge_axes(scene, plan, 1, {{0.9, numbered(plan, {0, 2, 1, 0, 0, 6})}}), Keys({"height_mm"})) << "the other is higher";
}

TEST(Edge, AllTheWayRoundHasNoEnds) {
  Scene scene = one_offset();
  for (VesselData& vessel : scene.vessels) {  // so that azimuth matters
    vessel.mass = 0.1;
    vessel.center_of_mass = {0.01, 0, 0};
  }
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 3}), Keys({"azimuth_deg"})) << "a quarter of the way";
  scene.grips.azimuth = range_axis(0, radians(345), 24);
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 3}), Keys());
  scene.grips.azimuth = range_axis(0, radians(360), 25);
  EXPECT_EQ(keys_at(scene, {24, 2, 1, 0, 0, 3}), Keys());
  scene.grips.azimuth = range_axis(0, radians(330), 24);
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 3}), Keys({"azimuth_deg"})) << "a wider gap than between any two";
  scene.grips.roll = range_axis(radians(-180), radians(150), 12);
  EXPECT_EQ(keys_at(scene, {1, 2, 0, 0, 0, 3}), Keys());
}

TEST(Edge, WhatStandsForAllAzimuthsAndWhoseHandItIsAreNoQuestion) {
  Scene scene = one_offset();
  scene.grips.hand_scale.values = {0.9, 1, 1.1};
  ASSERT_GT(Plan(scene, false).copies(), 1u);
  EXPECT_EQ(keys_at(scene, {0, 2, 1, 0, 0, 3}), Keys());
}

TEST(Edge, OneOfEquallyGoodGripsBetweenIsEnough) {
  const Scene scene = one_offset();
  const Plan plan(scene, false);
  const std::uint64_t end = numbered(plan, {0, 2, 3, 0, 0, 3}), other_end = numbered(plan, {0, 2, 0, 0, 0, 3}),
                      between = numbered(plan, {0, 2, 1, 0, 0, 3});
  EXPECT_EQ(edge_axes(scene, plan, 0, {{0.9, end}, {0.9, between}}), Keys());
  EXPECT_EQ(edge_axes(scene, plan, 0, {{0.9, end}, {0.9, other_end}, {0.8, between}}), Keys({"roll_deg"}));
  EXPECT_EQ(edge_axes(scene, plan, 0, {}), Keys());
}

TEST(Edge, SobolPointsAreAtAnEndWithinHalfAStepOfAsManyGrips) {
  Scene scene = one_offset();
  scene.grips.azimuth.values = {0};
  scene.grips.azimuth.is_range = false;
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 1000;  // of three ranges: 10 values each, half a step is an 18th of the range
  const Plan plan(scene, false);
  int named = 0;
  for (std::uint64_t grip = 0; grip < plan.grips(); ++grip) {
    const Keys keys = edge_axes(scene, plan, 0, {{0.9, grip}});
    double roll = 0;
    plan.coordinates(PLACE_ROLL, grip, 1, &roll);
    const double share = (roll - radians(-90)) / radians(120);
    const bool is_near = share <= 1 / 18.0 || share >= 1 - 1 / 18.0;
    EXPECT_EQ(std::count(keys.begin(), keys.end(), "roll_deg"), is_near ? 1 : 0) << share;
    named += is_near;
  }
  EXPECT_NEAR(named, 1000 / 9, 5);
}

TEST(Edge, TheLineNamesThemAll) {
  EXPECT_EQ(edge_line({}), "");
  EXPECT_EQ(edge_line({"roll_deg"}), "the best grip lies on the edge of roll_deg; widen it?");
  EXPECT_EQ(edge_line({"height_mm", "roll_deg"}), "the best grip lies on the edge of height_mm and roll_deg; widen them?");
}

}  // namespace
}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
#include "sweeps/plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/support/fake_backend.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

std::vector<GripInput> grips(const Plan& plan, std::size_t vessel, std::uint64_t first, std::size_t count) {
  std::vector<GripInput> out(count);
  plan.fill(vessel, first, count, out.data());
  return out;
}

bool same(const GripInput& a, const GripInput& b) {
  return a.height == b.height && a.azimuth == b.azimuth && a.obliquity == b.obliquity && a.roll == b.roll && a.offset == b.offset &&
         a.hand_scale == b.hand_scale;
}

std::string refusal(const Scene& scene, double bytes, double free, ExitCode code = ExitCode::usage) {
  return refusal_line([&] { check_sweep_size(scene, sweep_size(scene, bytes), free); }, code);
}

TEST(Plan, GridCountsWithAzimuthSlowestAndHeightFastest) {
  const Scene scene = fake_scene();
  const Plan plan(scene, true);
  ASSERT_EQ(plan.grips(), 3u * 7 * 5 * 4 * 2);
  EXPECT_EQ(plan.copies(), 1u);
  std::uint64_t index = 0;
  const GripsData& g = scene.grips;
  for (const double azimuth : g.azimuth.values)
    for (const double obliquity : g.obliquity.values)
      for (const double roll : g.roll.values)
        for (const double offset : g.offset.values)
          for (const double height : g.height.values) {
            const GripInput expected{height * 0.14, azimuth, obliquity, roll, offset, 1};
            EXPECT_TRUE(same(plan.grip(1, index), expected)) << index;
            ++index;
          }
}

TEST(Plan, AnyRangeIsThatPartOfTheWhole) {
  for (const Sampling sampling : {Sampling::grid, Sampling::sobol}) {
    Scene scene = fake_scene();
    scene.grips.sampling = sampling;
    scene.grips.count = 777;
    const Plan plan(scene, true);
    const auto all = grips(plan, 0, 0, plan.grips());
    for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{255}, std::size_t{300}, all.size() - 1}) {
      const auto part = grips(plan, 0, first, all.size() - first);
      for (std::size_t i = 0; i < part.size(); ++i) ASSERT_TRUE(same(part[i], all[first + i])) << first << " + " << i;
    }
  }
}

TEST(Plan, CoordinatesAreTheAxesOfTheGrips) {
  for (const Sampling sampling : {Sampling::grid, Sampling::sobol}) {
    Scene scene = fake_scene();
    scene.grips.sampling = sampling;
    scene.grips.count = 600;
    const Plan plan(scene, true);
    const auto all = grips(plan, 0, 0, plan.grips());
    std::vector<double> height(all.size()), roll(all.size());
    plan.coordinates(PLACE_HEIGHT, 0, all.size(), height.data());
    plan.coordinates(PLACE_ROLL, 0, all.size(), roll.data());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(height[i] * 0.11, all[i].height);
      EXPECT_EQ(roll[i], all[i].roll);
    }
  }
}

TEST(Plan, AbsoluteHeightsDoNotDependOnTheVessel) {
  Scene scene = fake_scene();
  scene.grips.height_is_fraction = false;
  const Plan plan(scene, true);
  EXPECT_EQ(plan.grip(0, 0).height, 0.1);
  EXPECT_EQ(plan.grip(1, 0).height, 0.1);
  EXPECT_EQ(plan.axes()[PLACE_HEIGHT].name, "height");
  EXPECT_EQ(plan.axes()[PLACE_HEIGHT].units, "m");
}

TEST(Plan, FractionsCountFromTheLowestPoint) {
  Scene scene = fake_scene();
  scene.vessels[1].base = -0.02;
  scene.vessels[1].height = 0.08;
  const Plan plan(scene, true);
  std::vector<double> fraction(plan.grips());
  plan.coordinates(PLACE_HEIGHT, 0, fraction.size(), fraction.data());
  for (std::uint64_t i = 0; i < plan.grips(); ++i) EXPECT_EQ(plan.grip(1, i).height, -0.02 + fraction[i] * 0.1);
}

TEST(Plan, AzimuthIsLeftOutWhereNothingDependsOnIt) {
  Scene scene = fake_scene();
  const Plan plan(scene, false);
  EXPECT_EQ(plan.copies(), 3u);
  EXPECT_EQ(plan.grips(), 7u * 5 * 4 * 2);
  EXPECT_EQ(plan.stored_grips(), 3u * 7 * 5 * 4 * 2);
  for (const GripInput& grip : grips(plan, 0, 0, plan.grips())) EXPECT_EQ(grip.azimuth, 0);

  EXPECT_EQ(Plan(scene, true).copies(), 1u) << "a kept vector turns with the azimuth";
  scene.vessels[1].mass = 0.2;
  scene.vessels[1].center_of_mass = {0, 0.05, 0};
  EXPECT_EQ(Plan(scene, false).copies(), 3u) << "a given mass on the axis";
  scene.vessels[1].center_of_mass = {0, 0.05, 1e-3};
  EXPECT_EQ(Plan(scene, false).copies(), 1u) << "a centre of mass off the axis";
  scene.vessels[1].mass.reset();
  scene.vessels[1].mesh = MeshData{};
  EXPECT_EQ(Plan(scene, false).copies(), 1u) << "a mesh";
}

TEST(Plan, SobolFillsRangesPicksFromListsAndKeepsNumbers) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 1024;
  scene.grips.height.values = {0.4};
  scene.grips.height.is_range = false;
  scene.grips.offset.values = {1e-3, 2e-3, 3e-3, 4e-3};
  const Plan plan(scene, false);
  EXPECT_EQ(plan.copies(), 1u);
  ASSERT_EQ(plan.grips(), 1024u);
  std::vector<int> offsets(5), rolls(16);
  for (const GripInput& grip : grips(plan, 0, 0, 1024)) {
    EXPECT_EQ(grip.height, 0.4 * 0.11);
    ++offsets[std::lround(grip.offset * 1e3)];
    EXPECT_GT(grip.roll, radians(-90));
    EXPECT_LT(grip.roll, radians(30));
    ++rolls[static_cast<int>((grip.roll - radians(-90)) / radians(120) * 16)];
  }
  EXPECT_EQ(offsets, (std::vector<int>{0, 256, 256, 256, 256}));
  for (const int count : rolls) EXPECT_EQ(count, 64);
}

TEST(Plan, OpeningAnAxisLeavesTheOthersAsTheyWere) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 100;
  scene.grips.hand_scale.values = {1};
  const auto before = grips(Plan(scene, false), 0, 0, 100);
  scene.grips.hand_scale = range_axis(0.8, 1.2, 2);
  const auto after = grips(Plan(scene, false), 0, 0, 100);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(before[i].height, after[i].height);
    EXPECT_EQ(before[i].azimuth, after[i].azimuth);
    EXPECT_EQ(before[i].roll, after[i].roll);
    EXPECT_NE(before[i].hand_scale, after[i].hand_scale);
  }
}

TEST(Plan, SeedRepeats) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 10;
  scene.grips.seed = 42;
  EXPECT_EQ(Plan(scene, false).grip(0, 9).roll, Plan(scene, false).grip(0, 9).roll);
  const double roll = Plan(scene, false).grip(0, 9).roll;
  scene.grips.seed = 43;
  EXPECT_NE(Plan(scene, false).grip(0, 9).roll, roll);
}

TEST(Plan, TooManyGripsAreRefusedWithTheSizes) {
  Scene scene = fake_scene();
  scene.vessels.resize(1);
  scene.grips.azimuth = scene.grips.obliquity = scene.grips.roll = scene.grips.offset = range_axis(0, 1, 1000);
  scene.grips.height.values = {0.5};
  const std::string line = refusal(scene, 200, 1e30);
  EXPECT_NE(line.find("1.0e+12 grips"), std::string::npos) << line;
  EXPECT_NE(line.find("8.0e+12 states"), std::string::npos) << line;
  EXPECT_NE(line.find("200 TB"), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_THROW(Plan(scene, false), Error);
}

TEST(Plan, CountsThatOverflowIntegersAreRefused) {
  Scene scene = fake_scene();
  scene.grips.azimuth = scene.grips.height = scene.grips.obliquity = scene.grips.roll = scene.grips.offset =
      scene.grips.hand_scale = range_axis(0, 1, 10000);  // 1e24 a vessel
  EXPECT_NE(refusal(scene, 1e3, 1e300), "");
  EXPECT_THROW(Plan(scene, false), Error);
  scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = ~std::uint64_t{0};
  EXPECT_NE(refusal(scene, 1, 1e300), "");
  scene.grips.count = SOBOL_LARGEST_COUNT + 1;
  EXPECT_THROW(Plan(scene, false), Error) << "more than the sequence has";
  scene.grips.count = SOBOL_LARGEST_COUNT;
  EXPECT_EQ(Plan(scene, false).grips(), SOBOL_LARGEST_COUNT);
  scene.grips.count = 0;
  EXPECT_THROW(Plan(scene, false), Error);
}

TEST(Plan, ResultsThatDoNotFitTheDiskAreRefused) {
  const Scene scene = fake_scene();  // 1,680 grips
  EXPECT_EQ(refusal(scene, 100, 168000), "");
  const std::string line = refusal(scene, 100, 167999, ExitCode::failure);
  EXPECT_NE(line.find("1,680 grips"), std::string::npos) << line;
  EXPECT_NE(line.find("168 kB"), std::string::npos) << line;
}

}  // namespace
}  // namespace wholehand

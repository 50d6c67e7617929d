// SPDX-License-Identifier: MIT
// Which grips a check evaluates.
// sanitizers: address
#include "evidence/check/check_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

CheckSample sample_of(const Scene& scene) { return check_sample(scene, sweeps::Plan(scene, true), 0); }

std::pair<double, double> ends(const CheckSample& sample, const std::function<double(const GripInput&)>& axis) {
  std::set<double> values;
  for (std::size_t i = sample.own; i < sample.grips.size(); ++i) values.insert(axis(sample.grips[i]));
  return {*values.begin(), *values.rbegin()};
}

TEST(CheckSample, FewGripsAreFilledUpBetweenTheirValues) {
  const Scene scene = scene_from("[grips]\nheight_mm = [20, 30, 60]\nroll_deg = { from = -90, to = 0, count = 4 }\n" + VESSEL);
  const CheckSample sample = sample_of(scene);
  EXPECT_EQ(sample.own, 12u);
  EXPECT_EQ(sample.grips.size(), FEWEST_CHECKED_GRIPS);
  const sweeps::Plan plan(scene, true);
  for (std::size_t i = 0; i < sample.own; ++i) {
    EXPECT_EQ(sample.grips[i].height, plan.grip(0, i).height);
    EXPECT_EQ(sample.grips[i].roll, plan.grip(0, i).roll);
  }
  const auto heights = ends(sample, [](const GripInput& g) { return g.height; });
  EXPECT_GE(heights.first, 20e-3);
  EXPECT_LT(heights.first, 21e-3);
  EXPECT_LE(heights.second, 60e-3);
  EXPECT_GT(heights.second, 59e-3);
  const auto rolls = ends(sample, [](const GripInput& g) { return degrees(g.roll); });
  EXPECT_GE(rolls.first, -90);
  EXPECT_LE(rolls.second, 0);
}

TEST(CheckSample, AnAxisOfOneValueIsWidened) {
  const Scene scene =
      scene_from("[hand]\nscale = 2\n[grips]\nheight_fraction = 0.98\nobliquity_deg = 88\nhand_scale = 0.8\n" + VESSEL);
  const CheckSample sample = sample_of(scene);
  EXPECT_EQ(sample.own, 1u);
  const auto expect_ends = [&](const std::function<double(const GripInput&)>& axis, double low, double high, const char* what) {
    const auto [least, most] = ends(sample, axis);
    EXPECT_GE(least, low) << what;
    EXPECT_LE(most, high) << what;
    EXPECT_GT(most - least, 0.99 * (high - low)) << what;
  };
  expect_ends([](const GripInput& g) { return g.height; }, 0.93 * 0.11, 0.11, "height, of 110 mm");
  expect_ends([](const GripInput& g) { return degrees(g.azimuth); }, -15, 15, "azimuth");
  expect_ends([](const GripInput& g) { return degrees(g.obliquity); }, 83, 90, "obliquity");
  expect_ends([](const GripInput& g) { return degrees(g.roll); }, -15, 15, "roll");
  expect_ends([](const GripInput& g) { return g.offset; }, -10e-3, 10e-3, "offset");
  expect_ends([](const GripInput& g) { return g.hand_scale; }, 0.76, 0.84, "hand scale");
}

TEST(CheckSample, AHandScaleIsNotWidenedPastWhatIsAskedOfFloatOrMeshes) {
  const auto scales = [](const Scene& scene) { return ends(sample_of(scene), [](const GripInput& g) { return g.hand_scale; }); };
  const auto hand = [](const std::string& scale, const std::string& hand_scale) {
    return scene_from("[hand]\nscale = " + scale + "\n[grips]\nheight_mm = 50\nhand_scale = " + hand_scale + "\n" + VESSEL);
  };
  const auto large = scales(hand("20", "4.95")), small = scales(hand("0.2", "0.51"));
  EXPECT_LE(large.second, 5);
  EXPECT_GT(large.second, 4.99);
  EXPECT_LT(large.first, 4.71);
  EXPECT_GE(small.first, 0.5);
  EXPECT_LT(small.first, 0.501);
  EXPECT_GT(small.second, 0.53);
  Scene mesh = hand("1", "1");
  mesh.vessels[0].mesh.emplace();
  EXPECT_LE(scales(mesh).second, 1);
  EXPECT_LT(scales(mesh).first, 0.96);
}

TEST(CheckSample, ManyGripsAreTheScenesOwn) {
  const auto sampled = [](int count) {
    const Scene scene = scene_from("[grips]\nsampling = \"sobol\"\ncount = " + std::to_string(count) +
                                   "\nheight_fraction = { from = 0.2, to = 0.8 }\n" + VESSEL);
    return sample_of(scene);
  };
  EXPECT_EQ(sampled(1024).own, 1024u);
  EXPECT_EQ(sampled(1024).grips.size(), 1024u);
  EXPECT_EQ(sampled(1500).grips.size(), 1500u);
  EXPECT_EQ(sampled(100000).own, MOST_CHECKED_GRIPS);
  EXPECT_EQ(sampled(100000).grips.size(), MOST_CHECKED_GRIPS);
  // a few points of the sequence, and others of another one beside them
  const CheckSample few = sampled(10);
  std::set<double> heights;
  for (const GripInput& grip : few.grips) heights.insert(grip.height);
  EXPECT_EQ(few.own, 10u);
  EXPECT_EQ(heights.size(), few.grips.size()) << "no grip twice";
}

}  // namespace
}  // namespace wholehand

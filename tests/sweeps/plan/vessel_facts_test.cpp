// SPDX-License-Identifier: MIT
#include "sweeps/plan/vessel_facts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/text/error.h"
#include "tests/support/fake_backend.h"

namespace wholehand::sweeps {
namespace {

std::vector<VesselFacts> facts_of(const Scene& scene) {
  FakeBackend backend(scene, make_field_set({}, scene), Precision::full, 100);
  return vessel_facts(scene, backend, FakeEvaluator(scene));
}

TEST(VesselFacts, ComeFromCoreAndBackend) {
  const auto facts = facts_of(fake_scene());
  ASSERT_EQ(facts.size(), 2u);
  EXPECT_EQ(facts[1].capacity, 2e-4);
  EXPECT_EQ(facts[1].empty_mass, 0.2);
  EXPECT_EQ(facts[1].empty_center_of_mass, (Triple{0, 0.1, 0}));
  ASSERT_EQ(facts[0].pouring_tilt.size(), 2u);
  EXPECT_TRUE(std::isnan(facts[0].pouring_tilt[0]));
  ASSERT_EQ(facts[1].liquid.size(), 2u * 4);
  EXPECT_EQ(facts[1].liquid[7].volume, FakeEvaluator(fake_scene()).liquid(1, 0.5, radians(90)).volume);
}

TEST(VesselFacts, LiquidNeedsLiquidAndItsStatesTilts) {
  Scene scene = fake_scene();
  scene.tilts.clear();
  EXPECT_EQ(facts_of(scene)[0].pouring_tilt.size(), 2u);
  EXPECT_TRUE(facts_of(scene)[0].liquid.empty());
  scene.liquid.reset();
  EXPECT_TRUE(facts_of(scene)[0].pouring_tilt.empty());
}

TEST(VesselFacts, TableOfAnotherSizeIsAnError) {
  Scene dry = fake_scene();
  dry.liquid.reset();
  FakeBackend backend(dry, make_field_set({}, dry), Precision::full, 100);
  EXPECT_THROW(vessel_facts(fake_scene(), backend, FakeEvaluator(dry)), Error);
}

}  // namespace
}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// Random scenes: float agrees with double to the comparisons' tolerances, or a sweep in float warns; and a device agrees
// with the core. The whole of it: WHOLEHAND_RANDOM_SCENES=2000 and WHOLEHAND_RANDOM_DEVICE_SCENES=200 of the environment. One scene:
// WHOLEHAND_RANDOM_SCENES=1 WHOLEHAND_RANDOM_SEED=77.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/domain.h"
#include "evidence/check/check_sample.h"
#include "evidence/check/compare.h"
#include "tests/support/random_scenes.h"
#include "tests/support/vulkan_listener.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

constexpr std::size_t GRIPS = 60;  // of a vessel

std::size_t asked_scenes(const char* variable, std::size_t portion) {
  const char* asked = std::getenv(variable);
  return asked ? static_cast<std::size_t>(std::strtoull(asked, nullptr, 10)) : portion;
}

// The scene's own grips, some of them where there are many, and of those between them where there are few.
std::vector<GripInput> some_grips(const Scene& scene, std::size_t vessel) {
  const CheckSample sample = check_sample(scene, sweeps::Plan(scene, true), vessel);
  const std::size_t step = std::max<std::size_t>(1, sample.own / GRIPS);
  std::vector<GripInput> grips;
  for (std::size_t i = 0; i < GRIPS; ++i) grips.push_back(sample.grips[i * step]);
  return grips;
}

using Side = std::function<GatheredPlanes(std::size_t vessel, const std::vector<GripInput>& grips)>;
using LiquidSide = std::function<std::vector<LiquidResult>(std::size_t vessel)>;

Side side_of(const Scene& scene, const Evaluator& core) {
  return [fields = compared_fields(scene), &core](std::size_t v, const std::vector<GripInput>& grips) {
    return gather(core, fields, v, grips);
  };
}

Comparer compared(const Scene& scene, const Evaluator& core, Allowance allowed, const Side& a, const Side& b,
                  const LiquidSide& liquid_a, const LiquidSide& liquid_b) {
  Comparer comparer(scene, core, allowed);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto grips = some_grips(scene, v);
    comparer.add(v, grips, a(v, grips), b(v, grips));
    if (!scene.tilts.empty()) comparer.add_liquid(v, liquid_a(v), liquid_b(v));
  }
  return comparer;
}

TEST(RandomScenes, AreTheSameEachTimeAndOfEveryKind) {
  EXPECT_EQ(random_scene(3).text, random_scene(3).text);
  std::size_t arcs = 0, shells = 0, left = 0, dry = 0, still = 0, strong = 0, on_a_table = 0, until_poured = 0, poses[3] = {};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = random_scene(seed);
    ++poses[static_cast<int>(scene.pose)];
    left += scene.hand.handedness == Handedness::left;
    dry += !scene.liquid;
    still += scene.tilts.empty();
    strong += scene.strength.has_value();
    on_a_table += scene.table.has_value();
    until_poured += scene.until_poured.has_value();
    for (const VesselData& vessel : scene.vessels) {
      shells += vessel.surface == Surface::shell;
      for (const OutlineElement& element : vessel.outline) arcs += element.is_arc;
    }
  }
  for (const std::size_t count : {arcs, shells, left, dry, still, strong, on_a_table, until_poured, poses[0], poses[1], poses[2]})
    EXPECT_GT(count, 5u);
}

TEST(RandomScenes, WhereFloatIsNotEnoughASweepWarns) {
  const std::size_t scenes = asked_scenes("WHOLEHAND_RANDOM_SCENES", 60), first = asked_scenes("WHOLEHAND_RANDOM_SEED", 0);
  std::size_t beyond = 0, warned = 0;
  std::uint64_t grips = 0, feasible = 0;
  for (std::size_t seed = first; seed < first + scenes; ++seed) {
    const Scene scene = random_scene(seed);
    const auto core = make_core_evaluator(scene), single = make_core_float_evaluator(scene);
    const Comparer cost = compared(
        scene, *core, float_against_double(), side_of(scene, *single), side_of(scene, *core),
        [&](std::size_t v) { return core_liquid(scene, *single, v); }, [&](std::size_t v) { return core_liquid(scene, *core, v); });
    const bool warns = !domain_warnings(scene, Precision::single).empty();
    EXPECT_TRUE(cost.holds() || warns) << "seed " << seed << "\n" << table_of(cost) << scene.text;
    beyond += cost.holds() ? 0 : 1;
    warned += warns ? 1 : 0;
    grips += cost.grips();
    feasible += cost.feasible();
  }
  std::printf("  %zu scenes: float is not enough in %zu, %zu warn; %zu of %zu grips feasible\n", scenes, beyond, warned,
              static_cast<std::size_t>(feasible), static_cast<std::size_t>(grips));
  EXPECT_GT(2 * feasible, grips);
  EXPECT_LT(3 * warned, scenes) << "a warning of everything says nothing";
}

TEST(RandomScenes, DeviceComputesWhatTheCoreComputes) {
  const std::size_t scenes = asked_scenes("WHOLEHAND_RANDOM_DEVICE_SCENES", 4);
  for (std::size_t seed = 0; seed < scenes; ++seed) {
    const Scene scene = random_scene(1000000 + seed);
    const auto truth = make_core_evaluator(scene);
    for (const Precision precision : {Precision::single, Precision::full}) {
      const auto core = core_of(scene, precision);
      const auto device = backend_of(scene, compared_fields(scene), precision);
      const Comparer comparer = compared(
          scene, *truth, allowance(precision),
          [&](std::size_t v, const std::vector<GripInput>& grips) { return gather(*device, v, grips); }, side_of(scene, *core),
          [&](std::size_t v) { return device->liquid(v); }, [&](std::size_t v) { return core_liquid(scene, *core, v); });
      EXPECT_TRUE(comparer.holds()) << "seed " << seed << (precision == Precision::single ? ", float\n" : ", double\n")
                                    << table_of(comparer) << scene.text;
    }
  }
}

}  // namespace
}  // namespace wholehand

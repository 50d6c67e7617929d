// SPDX-License-Identifier: MIT
// The backend around the kernels: ways of moving data, pipelines that are made side by side, what goes to the core instead. What
// the kernels compute is compared in tests/shaders/parity_test.cpp.
// sanitizers: thread
#include "host/grip_backend.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <thread>

#include "core/core_backend.h"
#include "evidence/check/compare.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

using host::GripBackend;
using host::GripBackendOptions;

Scene wet(std::vector<VesselData> vessels, const HandData& hand = paper_hand()) {
  Scene scene = scene_of(std::move(vessels), Pose::articulated, hand);
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 0.6};
  scene.tilts = {0, radians(40), radians(110)};
  return scene;
}

std::unique_ptr<GripBackend> backend_of(const Scene& scene, const FieldSet& fields, const GripBackendOptions& options = {}) {
  return std::make_unique<GripBackend>(scene, make_core_evaluator(scene), fields, "vulkan", options);
}

const std::vector<int> FEW{FIELD_SCORE, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_PEAK_FORCE};

std::size_t differences(const GatheredPlanes& a, const GatheredPlanes& b) {
  std::size_t count = a.reals.size() == b.reals.size() && a.uints.size() == b.uints.size() ? 0 : 1;
  for (std::size_t k = 0; k < std::min(a.reals.size(), b.reals.size()); ++k)
    count += std::bit_cast<std::uint64_t>(a.reals[k]) != std::bit_cast<std::uint64_t>(b.reals[k]) ? 1 : 0;
  for (std::size_t k = 0; k < std::min(a.uints.size(), b.uints.size()); ++k) count += a.uints[k] != b.uints[k] ? 1 : 0;
  return count;
}

// However the data reach the device, the same pipelines give the same bits.
TEST(GripBackend, StagedTransfersGiveTheSameBits) {
  const Scene scene = wet({beaker1(), beaker3()}, left_hand());  // a left hand's planes are turned on the host
  const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_STATUS, FIELD_MIDPOINT, FIELD_PEAK_FORCE}, scene);
  GripBackendOptions staged;
  staged.device.unified_memory = false;
  const auto direct = backend_of(scene, fields), copied = backend_of(scene, fields, staged);
  EXPECT_FALSE(copied->device().unified_memory);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto grips = sample_grips(scene.vessels[v], 3000, 7 + v);
    EXPECT_EQ(differences(gather(*direct, v, grips), gather(*copied, v, grips)), 0u);
  }
}

// The bits do not depend on how many grips an invocation has, nor on how many are left for the last ones. The states take two dispatches, and the
// second begins within a fill.
TEST(GripBackend, ForcesOfGripsTogetherHaveTheBitsOfForcesOneByOne) {
  Scene scene = wet({beaker1()});
  scene.liquid->fills = {0, 0.3, 0.6};
  scene.tilts.clear();
  for (int k = 0; k < 100; ++k) scene.tilts.push_back(radians(k));
  ASSERT_GT(scene.tilts.size() * scene.liquid->fills.size(), std::size_t{STATES_IN_BLOCK});
  const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_STATUS, FIELD_PEAK_FORCE, FIELD_PEAK_TILT, FIELD_LARGEST_HOLD,
                                          FIELD_SAFE_TILT, FIELD_TORQUE, FIELD_HOLD_FORCE},
                                         scene);
  for (const bool all_states : {true, false}) {
    if (!all_states) scene.until_poured = 0.95;
    std::vector<std::unique_ptr<GripBackend>> backends;
    for (const std::uint32_t together : {1u, 3u, 4u}) {
      GripBackendOptions options;
      options.forces_together = together;
      backends.push_back(backend_of(scene, fields, options));
    }
    for (const std::size_t count : {1u, 2u, 3u, 5u, 257u}) {
      const auto grips = sample_grips(scene.vessels[0], count, 3);
      const GatheredPlanes one_by_one = gather(*backends[0], 0, grips);
      for (const std::size_t k : {1u, 2u})
        EXPECT_EQ(differences(one_by_one, gather(*backends[k], 0, grips)), 0u) << count << " grips";
    }
  }
}

// One device for a liquid that drains, as advice needs it: to the bits of a device that was opened for each fill.
TEST(GripBackend, OtherFillsGiveTheBitsOfADeviceOpenedWithThem) {
  Scene scene = wet({beaker1(), beaker3()});
  scene.strength = StrengthData{};
  scene.until_poured = 0.95;
  const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_WORST_EFFORT, FIELD_STATUS}, scene);
  const auto moving = backend_of(scene, fields);
  CoreBackend core(make_core_evaluator(scene), scene, fields, Precision::full, 2);
  Scene other = scene;
  other.vessels[0].fills = {0.1, 0.3};
  other.vessels[1].fills = {0.2, 0.9};
  const auto fresh = backend_of(other, fields);
  CoreBackend fresh_core(make_core_evaluator(other), other, fields, Precision::full, 2);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto grips = sample_grips(scene.vessels[v], 200, 17 + v);
    ASSERT_TRUE(moving->use_fills_of(scene) && core.use_fills_of(scene));
    const GatheredPlanes before = gather(*moving, v, grips);
    ASSERT_TRUE(moving->use_fills_of(other) && core.use_fills_of(other));
    EXPECT_EQ(differences(gather(*moving, v, grips), gather(*fresh, v, grips)), 0u);
    EXPECT_EQ(differences(gather(core, v, grips), gather(fresh_core, v, grips)), 0u);
    EXPECT_GT(differences(before, gather(*moving, v, grips)), 0u) << "fills change nothing here";
    EXPECT_EQ(moving->liquid(v)[0].volume, fresh->liquid(v)[0].volume);
  }
  other.vessels[0].fills = {0.1};
  EXPECT_FALSE(moving->use_fills_of(other) || core.use_fills_of(other));
}

TEST(GripBackend, EachVesselHasItsOwnFills) {
  Scene scene = wet({beaker1(), beaker3()});
  scene.liquid->fills.clear();
  scene.liquid->volumes = {0, 60e-6};
  scene.vessels[0].fills = {0, 0.12};
  scene.vessels[1].fills = {0, 0.31};
  const auto core = make_core_evaluator(scene);
  const auto device = backend_of(scene, make_field_set(FEW, scene));
  for (std::size_t v = 0; v < 2; ++v) {
    const std::vector<LiquidResult> table = device->liquid(v);
    ASSERT_EQ(table.size(), 6u);
    const double capacity = core->capacity(v);
    EXPECT_NEAR(table[3].volume, scene.vessels[v].fills[1] * capacity, 1e-12 * capacity);
    EXPECT_EQ(table[0].volume, 0);
  }
}

TEST(GripBackend, TwoAtOnceDoNotDisturbEachOther) {
  const Scene scene = wet({beaker1(), beaker2(), beaker3()});
  const auto grips = sample_grips(scene.vessels[1], 2000, 3);
  const FieldSet fields = make_field_set(FEW, scene);
  const GatheredPlanes alone = gather(*backend_of(scene, fields), 1, grips);
  std::vector<GatheredPlanes> found(2);
  std::vector<std::thread> threads;
  for (GatheredPlanes& planes : found) threads.emplace_back([&] { planes = gather(*backend_of(scene, fields), 1, grips); });
  for (std::thread& thread : threads) thread.join();
  for (const GatheredPlanes& planes : found) EXPECT_EQ(differences(planes, alone), 0u);
}

// A belly of straight pieces.
VesselData faceted(int pieces) {
  std::vector<OutlineElement> outline{line_to(20, 0)};
  for (int i = 1; i <= pieces; ++i) {
    const double y = 100.0 * i / pieces;
    outline.push_back(line_to(20 + 18 * std::sin(PI * y / 110), y));
  }
  outline.push_back(line_to(0, 100));
  return vessel_of("faceted", outline, 1);
}

// Drivers that run on the processor end a loop after 65,535 iterations without a word: an outline that is looped over goes to the
// core.
TEST(GripBackend, LongOutlinesGoToTheCoreOnACpuDriver) {
  for (const int pieces : {30, 31, 200, 900}) {
    const Scene scene = scene_of({faceted(pieces)});
    const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_GAP}, scene);
    const auto core = make_core_evaluator(scene);
    const auto backend = backend_of(scene, fields);
    const auto grips = sample_grips(scene.vessels[0], 300, pieces);
    RunRequest request;
    request.last = grips.size();
    request.best = 5;
    request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
      std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
    };
    std::size_t differ = 0, compared = 0;
    const GatheredPlanes on_core = gather(*core, fields, 0, grips);
    request.sink = [&](const PlaneChunk& chunk) {
      for (std::size_t i = 0; i < chunk.count; ++i) {
        const std::size_t grip = chunk.first + i;
        ++compared;
        differ += chunk.uint(fields.plane[FIELD_TOUCH_MASK], i) != on_core.uint(FIELD_TOUCH_MASK, grip) ? 1 : 0;
        const double gap = chunk.real(fields.plane[FIELD_GAP], i), truth = on_core.real(fields.plane[FIELD_GAP], grip);
        differ += std::isnan(gap) == std::isnan(truth) && !(gap != static_cast<float>(truth) && !std::isnan(gap)) ? 0 : 1;
      }
    };
    const RunResult result = backend->run(request);
    EXPECT_EQ(compared, grips.size());
    EXPECT_EQ(result.done, grips.size());
    EXPECT_FALSE(result.best.empty()) << pieces;
    if (!backend->info().is_cpu) continue;  // a GPU loops over as many as there are, and its answers are its own
    const bool long_one = pieces + 2 > MAX_OUTLINE;
    EXPECT_EQ(result.notes.empty(), !long_one) << pieces;
    if (!long_one) continue;
    EXPECT_EQ(differ, 0u) << pieces << " pieces: the core's own answers, rounded to float";
    EXPECT_NE(result.notes[0].find("an outline of " + std::to_string(pieces + 2) + " elements is evaluated on the core"),
              std::string::npos)
        << result.notes[0];
  }
}

TEST(GripBackend, SaysWhatItMadeAndWhatAGripTakes) {
  const Scene scene = wet({beaker1()}), dry = scene_of({beaker1()});
  const auto with = backend_of(scene, make_field_set(FEW, scene));
  EXPECT_TRUE(with->pipelines(0).force);
  EXPECT_GT(with->info().compile_seconds, 0);
  const FieldSet scored = make_field_set({FIELD_SCORE}, dry);
  const auto without = backend_of(dry, scored);
  EXPECT_FALSE(without->pipelines(0).force);
  constexpr int HANDED_ON = 3 * JOINTS + PLACED_STRIDE;  // the posed points, and how the hand is placed
  EXPECT_EQ(without->bytes_per_grip(), 4u * (GRIP_AXES + scored.real_planes + HANDED_ON + scored.uint_planes));
  EXPECT_LT(without->bytes_per_grip(), with->bytes_per_grip());
}

}  // namespace
}  // namespace wholehand

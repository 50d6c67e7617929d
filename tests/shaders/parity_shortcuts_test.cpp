// SPDX-License-Identifier: MIT
// Shortcuts change nothing on the way of a grip on a device: how the outline is read, what is left out, what is selected, chunks,
// faults.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "evidence/check/compare.h"
#include "host/grip_backend.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

using host::GripBackend;
using host::GripBackendOptions;

// ---- the same bits ----

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

void expect_same_planes(const GatheredPlanes& a, const GatheredPlanes& b, const std::string& what) {
  ASSERT_EQ(a.reals.size(), b.reals.size()) << what;
  std::size_t differ = 0;
  for (std::size_t k = 0; k < a.reals.size(); ++k) differ += same_bits(a.reals[k], b.reals[k]) ? 0 : 1;
  EXPECT_EQ(differ, 0u) << what << ": of " << a.reals.size() << " numbers";
  EXPECT_EQ(a.uints, b.uints) << what;
}

// `count` planes of a field of both from the given ones on.
void expect_same_field(const GatheredPlanes& a, const GatheredPlanes& b, int field, int count, const std::string& what) {
  ASSERT_TRUE(a.fields.has(field) && b.fields.has(field)) << what << " field " << field;
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.count; ++i)
    for (int p = 0; p < count; ++p)
      differ += field >= REAL_FIELDS
                    ? (a.uint(field, i) == b.uint(field, i) ? 0 : 1)
                    : (same_bits(a.real(a.fields.plane[field] + p, i), b.real(b.fields.plane[field] + p, i)) ? 0 : 1);
  EXPECT_EQ(differ, 0u) << what << ": field " << field;
}

// The first planes of fields, as asked for.
using FieldPlanes = std::vector<std::pair<int, int>>;

// Two pipelines' answers to the same grips: the same bits on a CPU driver. Elsewhere Vulkan does not promise that two pipelines
// round alike, and what the comparison allows between two evaluations is asked for.
void expect_same_or_close(bool is_cpu, const Scene& scene, Precision precision, const std::vector<GripInput>& grips,
                          const GatheredPlanes& all, const GatheredPlanes& few, const FieldPlanes& compared,
                          const std::string& what) {
  GatheredPlanes merged = all;
  for (const auto& [field, planes] : compared) {
    if (is_cpu) {
      expect_same_field(few, all, field, planes, what);
    } else if (field < REAL_FIELDS) {
      std::copy_n(few.reals.begin() + static_cast<std::ptrdiff_t>(few.fields.plane[field] * few.count), planes * few.count,
                  merged.reals.begin() + static_cast<std::ptrdiff_t>(all.fields.plane[field] * all.count));
    } else {
      std::copy_n(few.uints.begin() + static_cast<std::ptrdiff_t>(few.fields.plane[field] * few.count), few.count,
                  merged.uints.begin() + static_cast<std::ptrdiff_t>(all.fields.plane[field] * all.count));
    }
  }
  if (is_cpu) return;
  const auto core = make_core_evaluator(scene);
  Comparer comparer(scene, *core, allowance(precision));
  comparer.add(0, grips, merged, all);
  EXPECT_TRUE(comparer.holds()) << what << "\n" << table_of(comparer);
}

FieldPlanes whole_fields(const std::vector<int>& fields, const Scene& scene) {
  FieldPlanes result;
  for (const int field : fields)
    result.push_back({field, field < REAL_FIELDS ? field_planes(field, scene_fills(scene), scene.tilts.size()) : 1});
  return result;
}

std::vector<int> fields_of(const FieldSet& set) {
  std::vector<int> fields;
  for (int field = 0; field < FIELDS; ++field)
    if (set.has(field)) fields.push_back(field);
  return fields;
}

TEST(ParityShortcuts, EverySourceOfTheOutlineGivesTheSamePlanes) {
  for (const Precision precision : {Precision::single, Precision::full}) {
    const Scene scene = wet_scene({precision == Precision::single ? vase() : shell_of(beaker1())}, Pose::articulated);
    const FieldSet fields = all_fields(scene);
    const auto copied = backend_of(scene, fields, precision);
    GripBackendOptions options;
    options.outline = OUTLINE_BUFFER;
    const auto other = backend_of(scene, fields, precision, options);
    EXPECT_EQ(other->pipelines(0).outline, OUTLINE_BUFFER);
    const auto grips = grips_of(scene, 0, 150);
    expect_same_or_close(other->info().is_cpu, scene, precision, grips, gather(*copied, 0, grips), gather(*other, 0, grips),
                         whole_fields(fields_of(fields), scene), "read in the loop");
  }
}

// Vessels of unlike outlines share the kernels that copy them; the last elements of the shorter one lie far away.
TEST(ParityShortcuts, ACopiedOutlineMayBeLongerThanTheVessels) {
  const Scene both = scene_of({beaker1(), vase()}, Pose::articulated), alone = scene_of({beaker1()}, Pose::articulated);
  const FieldSet fields = all_fields(alone);
  const auto shared = backend_of(both, fields, Precision::single), own = backend_of(alone, fields, Precision::single);
  const auto grips = grips_of(alone, 0, 150);
  expect_same_or_close(own->info().is_cpu, alone, Precision::single, grips, gather(*own, 0, grips), gather(*shared, 0, grips),
                       whole_fields(fields_of(fields), alone), "a longer outline");
}

// What every driver but llvmpipe takes, on llvmpipe. Its loops may take more turns than this driver grants, so that grips are few.
TEST(ParityShortcuts, TheSmallBuildIsHeldToTheCore) {
  Scene bare = wet_scene({beaker1(), shell_of(beaker2())}, Pose::articulated),
        whole = wet_scene({beaker1(), vase()}, Pose::articulated);
  whole.hand.between = 2;
  whole.table = TableData{};
  whole.arm = ArmData{};
  whole.strength = StrengthData{};
  for (const Scene& scene : {bare, whole}) {
    const FieldSet fields = compared_fields(scene);
    EXPECT_EQ(fields.has(FIELD_FRICTION_NEEDED), scene.strength.has_value());
    const auto truth = make_core_evaluator(scene);
    for (const Precision precision : {Precision::single, Precision::full}) {
      GripBackendOptions options;
      options.build = BUILD_SMALL;
      const auto backend = backend_of(scene, fields, precision, options);
      EXPECT_EQ(backend->pipelines(0).outline, OUTLINE_BUFFER);
      Comparer comparer(scene, *truth, allowance(precision));
      for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
        const auto grips = grips_of(scene, v, 60);
        comparer.add(v, grips, gather(*backend, v, grips), gather(*truth, fields, v, grips));
      }
      EXPECT_GT(5 * comparer.feasible(), comparer.grips());
      EXPECT_TRUE(comparer.holds()) << table_of(comparer);
    }
  }
}

TEST(ParityShortcuts, OutlinesTooLongToCopyComeFromABuffer) {
  const Scene scene = scene_of({beaker1(), facets()}, Pose::rigged);
  const auto backend = backend_of(scene, make_field_set({FIELD_SCORE}, scene), Precision::single);
  EXPECT_EQ(backend->pipelines(0).outline, OUTLINE_COPIED);
  EXPECT_EQ(backend->pipelines(1).outline, OUTLINE_BUFFER);
}

// ---- leaving out ----

const std::vector<std::vector<int>> FEW_FIELDS{{FIELD_SCORE},
                                               {FIELD_TERMS, FIELD_STATUS, FIELD_USED_MASK},
                                               {FIELD_POSED, FIELD_BONE_STRETCH},
                                               {FIELD_HOLD_FORCE, FIELD_SAFE_TILT, FIELD_INNER_MASK, FIELD_CONTACT_ANGLES}};

TEST(ParityShortcuts, FieldsLeftOutChangeNothingInTheRest) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    const Scene scene = wet_scene({pose == Pose::paper ? beaker2() : beaker3()}, pose);
    const auto grips = grips_of(scene, 0, 200);
    const auto core = make_core_evaluator(scene);
    const GatheredPlanes on_core = gather(*core, all_fields(scene), 0, grips);
    const auto full = backend_of(scene, all_fields(scene), Precision::single);
    const GatheredPlanes on_device = gather(*full, 0, grips);
    for (const auto& kept : FEW_FIELDS) {
      if (pose == Pose::paper && std::ranges::find(kept, FIELD_POSED) == kept.end()) continue;  // what the pose decides
      const FieldSet few = make_field_set(kept, scene);
      const GatheredPlanes few_on_core = gather(*core, few, 0, grips);
      const auto backend = backend_of(scene, few, Precision::single);
      EXPECT_LT(backend->bytes_per_grip(), full->bytes_per_grip());
      const GatheredPlanes few_on_device = gather(*backend, 0, grips);
      for (const int field : kept)
        expect_same_field(few_on_core, on_core, field, field_planes(field, scene_fills(scene), scene.tilts.size()), "core");
      expect_same_or_close(full->info().is_cpu, scene, Precision::single, grips, on_device, few_on_device,
                           whole_fields(kept, scene), "device");
    }
  }
}

// What a scene lacks changes nothing in what it has; and it is not there.
TEST(ParityShortcuts, LiquidAndTiltsLeftOutChangeNothingInTheRest) {
  const Scene wet = wet_scene({beaker2()}, Pose::articulated);
  Scene dry = wet, untilted = wet;
  dry.liquid.reset();
  untilted.tilts.clear();
  Scene bare = dry;
  bare.tilts.clear();
  const auto grips = grips_of(wet, 0, 200);
  const std::vector<int> geometry{FIELD_T_INDEX,        FIELD_T_THUMB,       FIELD_GAP,        FIELD_MIDPOINT,     FIELD_CLOSURE,
                                  FIELD_CONTACT_ANGLES, FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH, FIELD_BONE_STRETCH, FIELD_JOINTS,
                                  FIELD_POSED,          FIELD_PROXIES,       FIELD_SEPARATION, FIELD_STATUS,       FIELD_TOUCH_MASK,
                                  FIELD_TIP_MASK,       FIELD_FINGER_MASK,   FIELD_INNER_MASK, FIELD_USED_MASK};
  for (const bool device : {false, true}) {
    const std::string where = device ? "device" : "core";
    bool bitwise = true;
    const auto planes_of = [&](const Scene& scene, bool force) {
      if (!device) return gather(*make_core_evaluator(scene), all_fields(scene), 0, grips);
      const auto backend = backend_of(scene, all_fields(scene), Precision::single);
      bitwise = backend->info().is_cpu;
      EXPECT_EQ(backend->pipelines(0).force, force);
      return gather(*backend, 0, grips);
    };
    const GatheredPlanes all = planes_of(wet, true);
    const GatheredPlanes without_liquid = planes_of(dry, true);
    FieldPlanes untouched = whole_fields(geometry, wet);
    untouched.push_back({FIELD_TERMS, 4});  // fingers, contacts, depth, posture
    for (const GatheredPlanes& fewer : {without_liquid, planes_of(untilted, false), planes_of(bare, false)})
      expect_same_or_close(bitwise, wet, Precision::single, grips, all, fewer, untouched, where);
    // the empty glass is the first fill
    const int tilts = static_cast<int>(wet.tilts.size());
    const FieldPlanes empty{{FIELD_PIVOT_LENGTH, tilts},
                            {FIELD_TORQUE, tilts},
                            {FIELD_EXACT_TORQUE, tilts},
                            {FIELD_HOLD_FORCE, tilts},
                            {FIELD_LARGEST_HOLD, 1}};
    expect_same_or_close(bitwise, wet, Precision::single, grips, all, without_liquid, empty, where);
  }
}

// Whether a grip is plausible is also up to a part of the scene that sets `bit` of the status. The device leaves the part out, which changes
// nothing but the status, the score and `also`. Returns the planes with the part.
GatheredPlanes expect_only_the_bit(const Scene& bare, const Scene& whole, std::uint32_t bit, const std::vector<GripInput>& grips,
                                   const std::vector<int>& also = {}) {
  const auto without = backend_of(bare, all_fields(bare), Precision::single);
  const auto with = backend_of(whole, all_fields(whole), Precision::single);
  EXPECT_LT(without->bytes_per_grip(), with->bytes_per_grip());
  GatheredPlanes all = gather(*with, 0, grips);
  const GatheredPlanes fewer = gather(*without, 0, grips);
  std::vector<int> fields = fields_of(fewer.fields);
  for (const int field : {FIELD_SCORE, FIELD_STATUS}) std::erase(fields, field);
  for (const int field : also) std::erase(fields, field);
  expect_same_or_close(with->info().is_cpu, whole, Precision::single, grips, all, fewer, whole_fields(fields, bare), "device");
  std::size_t found = 0;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    EXPECT_EQ(fewer.uint(FIELD_STATUS, i) & bit, 0u);
    if ((all.uint(FIELD_STATUS, i) & bit) == 0) continue;
    ++found;
    EXPECT_EQ(all.uint(FIELD_STATUS, i) & STATUS_PLAUSIBLE, 0u);
    EXPECT_EQ(all.real(all.fields.plane[FIELD_SCORE], i), 0);
  }
  EXPECT_GT(found, 20u);
  EXPECT_LT(found, grips.size() - 20);
  return all;
}

TEST(ParityShortcuts, TheTableLeftOutChangesNothingInTheRest) {
  const Scene bare = wet_scene({beaker1()}, Pose::articulated);
  Scene table = bare;
  table.table.emplace();
  expect_only_the_bit(bare, table, STATUS_THROUGH_TABLE, grips_of(bare, 0, 200));
}

// The share of the arm is in the posture term too.
TEST(ParityShortcuts, TheArmLeftOutChangesNothingInTheRest) {
  const Scene bare = wet_scene({beaker1()}, Pose::articulated);
  Scene arm = bare;
  arm.arm.emplace();
  const auto grips = grips_of(bare, 0, 300);
  const GatheredPlanes all = expect_only_the_bit(bare, arm, STATUS_BEYOND_WRIST, grips, {FIELD_TERMS});
  for (std::size_t i = 0; i < grips.size(); ++i)
    EXPECT_EQ((all.uint(FIELD_STATUS, i) & STATUS_BEYOND_WRIST) != 0, all.real(all.fields.plane[FIELD_WRIST_SHARE], i) > 1);
}

// ---- top-N ----

TEST(ParityShortcuts, BestAreThoseOfTheFullSort) {
  const Scene scene = scene_of({beaker1()}, Pose::rigged);
  std::vector<GripInput> grips = grips_of(scene, 0, 4321);
  // three times the same grip: equal scores, far apart and next to each other
  for (std::size_t i = 0; i < 700; ++i) grips[3000 + i] = grips[i];
  for (std::size_t i = 0; i < 600; ++i) grips[2000 + i] = grips[2000];
  const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_STATUS}, scene);
  host::GripBackendOptions small;
  small.stream.first_items = 192;
  small.stream.slot_bytes = 40'000;
  for (const bool chunked : {false, true}) {
    host::GripBackendOptions options = chunked ? small : host::GripBackendOptions{};
    if (!chunked) options.stream.first_items = 8192;
    const auto backend = backend_of(scene, fields, Precision::single, options);
    const GatheredPlanes planes = gather(*backend, 0, grips);
    std::vector<Candidate> sorted;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      const std::uint32_t status = planes.uint(FIELD_STATUS, i);
      if ((status & STATUS_REASON_MASK) == REASON_NONE && (status & STATUS_PLAUSIBLE) != 0)
        sorted.push_back({planes.real(fields.plane[FIELD_SCORE], i), i});
    }
    std::ranges::stable_sort(sorted, [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    ASSERT_GT(sorted.size(), 400u);
    for (const std::size_t best : {1, 20, 64, 65, 300}) {
      RunRequest request;
      request.last = grips.size();
      request.best = best;
      request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
        std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
      };
      const RunResult result = backend->run(request);
      EXPECT_GE(result.chunks, chunked ? 2u : 1u);  // how many depends on the machine
      ASSERT_EQ(result.best.size(), best);
      for (std::size_t k = 0; k < best; ++k) {
        ASSERT_EQ(result.best[k].index, sorted[k].index) << "place " << k << " of " << best;
        ASSERT_EQ(result.best[k].score, sorted[k].score);
      }
    }
  }
}

TEST(ParityShortcuts, FewerThanAskedForAreAllThereAre) {
  const Scene scene = scene_of({beaker1()}, Pose::rigged);
  const auto backend = backend_of(scene, make_field_set({FIELD_SCORE}, scene), Precision::single);
  RunRequest request;
  request.last = 100;
  request.best = 20;
  request.grips = [](std::size_t, std::uint64_t, std::size_t count, GripInput* out) {
    GripInput above;
    above.height = 1;  // misses
    std::fill_n(out, count, above);
  };
  EXPECT_TRUE(backend->run(request).best.empty());
}

// ---- chunks and faults ----

struct Streamed {
  GatheredPlanes planes;
  std::vector<std::string> notes;
  std::uint64_t chunks = 0;
};

Streamed stream_through(const Scene& scene, const std::vector<GripInput>& grips, const host::StreamOptions& options) {
  GripBackendOptions backend_options;
  backend_options.stream = options;
  const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_POSED, FIELD_STATUS, FIELD_TOUCH_MASK}, scene);
  const auto backend = backend_of(scene, fields, Precision::single, backend_options);
  Streamed streamed;
  streamed.planes = {fields, grips.size(), std::vector<double>(fields.real_kept * grips.size(), 12345),
                     std::vector<std::uint32_t>(fields.uint_kept * grips.size())};
  RunRequest request;
  request.last = grips.size();
  request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
    std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
  };
  std::uint64_t next = 0;
  request.sink = [&](const PlaneChunk& chunk) {
    EXPECT_EQ(chunk.first, next);
    next += chunk.count;
    for (std::size_t i = 0; i < chunk.count; ++i) {
      for (int p = 0; p < fields.real_kept; ++p) streamed.planes.reals[p * grips.size() + chunk.first + i] = chunk.real(p, i);
      for (int p = 0; p < fields.uint_kept; ++p) streamed.planes.uints[p * grips.size() + chunk.first + i] = chunk.uint(p, i);
    }
  };
  const RunResult result = backend->run(request);
  EXPECT_EQ(result.done, grips.size());
  EXPECT_EQ(next, grips.size());
  streamed.notes = result.notes;
  streamed.chunks = result.chunks;
  return streamed;
}

class ParityStream : public testing::Test {
 protected:
  Scene scene = wet_scene({beaker3()}, Pose::articulated, left_hand());
  std::vector<GripInput> grips = grips_of(scene, 0, 1501);
  host::StreamOptions whole() const {
    host::StreamOptions options;
    options.first_items = 2048;
    return options;
  }
  host::StreamOptions tiny() const {
    host::StreamOptions options;
    options.first_items = 64;
    options.slot_bytes = 100'000;
    return options;
  }
};

TEST_F(ParityStream, ChunksDoNotChangeValues) {
  const Streamed once = stream_through(scene, grips, whole()), often = stream_through(scene, grips, tiny());
  EXPECT_EQ(once.chunks, 1u);
  EXPECT_GT(often.chunks, 5u);
  expect_same_planes(once.planes, often.planes, "chunks");
}

TEST_F(ParityStream, FaultsDoNotChangeValues) {
  const Streamed sound = stream_through(scene, grips, tiny());
  EXPECT_TRUE(sound.notes.empty());
  for (const host::SubmitFault fault :
       {host::SubmitFault::out_of_memory, host::SubmitFault::device_lost, host::SubmitFault::timeout}) {
    host::StreamOptions options = tiny();
    options.inject = [fault](std::size_t submit) { return submit == 3 ? fault : host::SubmitFault::none; };
    const Streamed mended = stream_through(scene, grips, options);
    EXPECT_FALSE(mended.notes.empty());
    expect_same_planes(sound.planes, mended.planes, "fault " + std::to_string(static_cast<int>(fault)));
  }
}

// No device lasts: the core's answers, in the device's precision, through the same sink.
TEST_F(ParityStream, WithoutDeviceTheCoreAnswers) {
  host::StreamOptions options = tiny();
  options.inject = [](std::size_t) { return host::SubmitFault::device_lost; };
  const Streamed streamed = stream_through(scene, grips, options);
  EXPECT_FALSE(streamed.notes.empty());
  GatheredPlanes core = gather(*make_core_evaluator(scene), streamed.planes.fields, 0, grips);
  core.reals.resize(streamed.planes.reals.size());  // the kept ones come first
  core.uints.resize(streamed.planes.uints.size());
  for (double& value : core.reals) value = static_cast<double>(static_cast<float>(value));
  expect_same_planes(streamed.planes, core, "core");
}

}  // namespace
}  // namespace wholehand

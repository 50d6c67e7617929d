// The whole way of a grip on a device against the core, in float and in double; that shortcuts change nothing: how the outline is read,
// what is left out, chunks, faults; and that a broken constant, or a hand moved by micrometres, is noticed.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "app/paths.h"
#include "app/scene_reader.h"
#include "host/grip_backend.h"
#include "sweeps/compare.h"
#include "sweeps/plan.h"
#include "sweeps/variables.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

using host::GripBackend;
using host::GripBackendOptions;

// ---- scenes ----

// A belly of straight pieces: more elements than a pipeline's constants hold, and more pieces of cavity than the device integrates.
VesselData facets() {
  constexpr int PIECES = 40;
  std::vector<OutlineElement> outline{line_to(20, 0)};
  for (int i = 1; i <= PIECES; ++i) {
    const double y = 100.0 * i / PIECES;
    outline.push_back(line_to(20 + 18 * std::sin(PI * y / 110), y));
  }
  outline.push_back(line_to(0, 100));
  return vessel_of("facets", outline, 1);
}

Scene wet_scene(std::vector<VesselData> vessels, Pose pose, const HandData& hand = {}) {
  Scene scene = scene_of(std::move(vessels), pose, hand);
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 0.4, 1};
  scene.tilts = {0, radians(20), radians(75), radians(90), radians(180)};
  return scene;
}

// No multiple of a work group; hands of several sizes.
std::vector<GripInput> grips_of(const Scene& scene, std::size_t vessel, int count) {
  std::vector<GripInput> grips = sample_grips(scene.vessels[vessel], count, 1000 + vessel);
  Random random(2000 + vessel);
  for (GripInput& grip : grips) grip.hand_scale = random.uniform(0.85, 1.2);
  grips.front().obliquity = PI / 2;  // along the axis: degenerate
  return grips;
}
constexpr int COUNT = 203;

std::unique_ptr<GripBackend> backend_of(const Scene& scene, const FieldSet& fields, Precision precision,
                                        GripBackendOptions options = {}) {
  options.precision = precision;
  return std::make_unique<GripBackend>(scene, make_core_evaluator(scene, options.evaluator), fields, "vulkan", options);
}

std::unique_ptr<Evaluator> core_of(const Scene& scene, Precision precision) {
  return precision == Precision::single ? make_core_float_evaluator(scene) : make_core_evaluator(scene);
}

std::vector<LiquidResult> core_liquid(const Scene& scene, const Evaluator& core, std::size_t vessel) {
  std::vector<LiquidResult> states;
  if (!scene.liquid) return states;
  for (const double fill : scene.liquid->fills)
    for (const double tilt : scene.tilts) states.push_back(core.liquid(vessel, fill, tilt));
  return states;
}

// ---- what a comparison found ----

std::string table_of(const Comparer& comparer) {
  std::ostringstream text;
  text.precision(4);
  for (const Comparison& row : comparer.rows())
    text << row.kernel << " " << row.quantity << ": worst " << row.worst << " " << row.unit << " (tolerance " << row.tolerance
         << ", largest share " << row.worst_ratio << ") at vessel " << row.vessel << " #" << row.grip << "; " << row.outside
         << " of " << row.compared << " outside\n";
  text << comparer.grips() << " grips, " << comparer.grazing() << " grazing, " << comparer.excluded() << " excluded\n";
  return text.str();
}

void expect_parity(const Scene& scene, const std::string& name, int count = COUNT) {
  const FieldSet fields = all_fields(scene);
  const auto truth = make_core_evaluator(scene);
  for (const Precision precision : {Precision::single, Precision::full}) {
    const auto backend = backend_of(scene, fields, precision);
    const auto core = core_of(scene, precision);
    Comparer comparer(scene, *truth, allowance(precision));
    std::size_t feasible = 0;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const auto grips = grips_of(scene, v, count);
      const GatheredPlanes device = gather(*backend, v, grips);
      comparer.add(v, grips, device, gather(*core, fields, v, grips));
      comparer.add_liquid(v, backend->liquid(v), core_liquid(scene, *core, v));
      for (std::size_t i = 0; i < grips.size(); ++i)
        feasible += (device.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) == REASON_NONE ? 1 : 0;
    }
    const std::string label = name + (precision == Precision::single ? "_float" : "_double");
    EXPECT_TRUE(comparer.holds()) << label << "\n" << table_of(comparer);
    EXPECT_GT(5 * feasible, comparer.grips()) << "too few feasible grips to tell anything";
    testing::Test::RecordProperty(label, table_of(comparer));
  }
}

// ---- parity ----

TEST(Parity, ArticulatedHand) {
  expect_parity(wet_scene({beaker1(), beaker2(), beaker3(), shell_of(beaker3()), vase(), facets()}, Pose::articulated),
                "articulated");
}

// Wide ranges by Sobol points: off the axis, in hands of several sizes, a shell's rim, a near-empty glass.
TEST(Parity, SobolScene) {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  for (VesselData& vessel : scene.vessels) vessel.surface = Surface::shell;
  scene.liquid->fills = {0.01, 1};
  scene.tilts = linspace(0, PI, 5);
  const auto range = [](Axis& axis, double from, double to) {
    axis.is_range = true;
    axis.from = from;
    axis.to = to;
  };
  range(scene.grips.height, 0.02, 1.1);
  range(scene.grips.azimuth, -PI, PI);
  range(scene.grips.obliquity, -1, 1);
  range(scene.grips.roll, -PI, PI);
  range(scene.grips.offset, -0.03, 0.03);
  range(scene.grips.hand_scale, 0.8, 1.3);
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 512;
  const Plan plan(scene, true);
  const FieldSet fields = all_fields(scene);
  const auto truth = make_core_evaluator(scene);
  for (const Precision precision : {Precision::single, Precision::full}) {
    const auto backend = backend_of(scene, fields, precision);
    Comparer comparer(scene, *truth, allowance(precision));
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      std::vector<GripInput> grips(plan.grips());
      plan.fill(v, 0, grips.size(), grips.data());
      comparer.add(v, grips, gather(*backend, v, grips), gather(*truth, fields, v, grips));
    }
    EXPECT_GT(3 * comparer.feasible(), comparer.grips());
    EXPECT_TRUE(comparer.holds()) << table_of(comparer);
  }
}

TEST(Parity, PaperPoseExactTorquePerGrip) {
  Scene scene = wet_scene({beaker1(), beaker2(), beaker3()}, Pose::paper);
  scene.force.torque = Torque::exact;
  scene.force.reference = TorqueReference::per_grip;
  expect_parity(scene, "paper");
}

TEST(Parity, RiggedHandPouringTowards) {
  Scene scene = wet_scene({beaker1(), beaker2(), beaker3()}, Pose::rigged);
  scene.force.reference = TorqueReference::per_grip;
  scene.liquid->pour = Pour::towards;
  expect_parity(scene, "rigged");
}

TEST(Parity, LeftHandOffCenterVessel) {
  Scene scene = wet_scene({lopsided(), beaker2()}, Pose::articulated, left_hand());
  scene.force.torque = Torque::exact;
  expect_parity(scene, "left");
}

// Another hand in every number, vessels without a cavity, no liquid, no tilts.
TEST(Parity, OddHandDryAndUntilted) {
  expect_parity(scene_of({ledges()}, Pose::articulated, odd_hand()), "odd");
  Scene tilted = scene_of({ledges()}, Pose::paper, odd_hand());
  tilted.tilts = linspace(0, PI, 7);
  expect_parity(tilted, "odd_tilted");
}

// More states than a block of the force kernel holds: fills are cut in the middle, and go on from where they were cut.
TEST(Parity, StatesOfManyBlocks) {
  Scene scene = wet_scene({beaker2()}, Pose::rigged);
  scene.tilts = linspace(0, PI, 300);
  scene.force.max = scene.force.base + 0.3 * scene.force.range;  // so that safe tilts end within a fill
  expect_parity(scene, "many", 60);
  scene.liquid.reset();
  scene.tilts = linspace(0, PI, 600);
  expect_parity(scene, "many_dry", 60);
}

TEST(Parity, GridDistance) {
  const Scene scene = scene_of({beaker2()});
  const FieldSet fields = all_fields(scene);
  GripBackendOptions options;
  options.evaluator.grid_samples = 64;
  const auto backend = backend_of(scene, fields, Precision::full, options);
  const auto core = make_core_evaluator(scene, options.evaluator);
  Comparer comparer(scene, *core, allowance(Precision::full));
  const auto grips = grips_of(scene, 0, 100);
  comparer.add(0, grips, gather(*backend, 0, grips), gather(*core, fields, 0, grips));
  EXPECT_TRUE(comparer.holds()) << table_of(comparer);
}

// Exactly upright, level and inverted; nothing, as good as nothing, brim-full.
TEST(Parity, LiquidAtItsEnds) {
  Scene scene = wet_scene({beaker1(), beaker2(), beaker3(), vase(), facets()}, Pose::rigged);
  scene.liquid->fills = {0, 1e-12, 1e-3, 0.5, 1};
  scene.tilts = {0, 1e-7, radians(30), radians(60), PI / 2, radians(120), PI};
  const FieldSet fields = make_field_set({FIELD_SCORE}, scene);
  const auto truth = make_core_evaluator(scene);
  for (const Precision precision : {Precision::single, Precision::full}) {
    const auto backend = backend_of(scene, fields, precision);
    const auto core = core_of(scene, precision);
    Comparer comparer(scene, *truth, allowance(precision));
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const auto device = backend->liquid(v);
      comparer.add_liquid(v, device, core_liquid(scene, *core, v));
      ASSERT_EQ(device.size(), 35u);
      for (std::size_t t = 0; t < scene.tilts.size(); ++t) {
        EXPECT_EQ(device[t].volume, 0);  // of an empty vessel
        EXPECT_EQ(device[t].mass, 0);
        EXPECT_GE(device[4 * 7 + t].poured, 0);  // of a full one
      }
      EXPECT_NEAR(device[4 * 7].volume, truth->capacity(v), 1e-5 * truth->capacity(v));  // upright, all of it
      EXPECT_EQ(device[4 * 7 + 6].volume, 0);                                            // inverted, nothing
    }
    EXPECT_TRUE(comparer.holds()) << table_of(comparer);
    RecordProperty(precision == Precision::single ? "liquid_float" : "liquid_double", table_of(comparer));
  }
}

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

// Two pipelines' answers to the same grips: the same bits on a CPU driver. Elsewhere Vulkan does not promise that two pipelines round alike,
// and what the comparison allows between two evaluations is asked for.
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

TEST(Parity, EverySourceOfTheOutlineGivesTheSamePlanes) {
  for (const Precision precision : {Precision::single, Precision::full}) {
    const Scene scene = wet_scene({precision == Precision::single ? vase() : shell_of(beaker1())}, Pose::articulated);
    const FieldSet fields = all_fields(scene);
    const auto specialized = backend_of(scene, fields, precision);
    for (const OutlineSource source : {OUTLINE_BUFFER, OUTLINE_HOISTED}) {
      GripBackendOptions options;
      options.outline = source;
      const auto other = backend_of(scene, fields, precision, options);
      EXPECT_EQ(other->pipelines(0).outline, source);
      const auto grips = grips_of(scene, 0, 150);
      expect_same_or_close(other->info().is_cpu, scene, precision, grips, gather(*specialized, 0, grips), gather(*other, 0, grips),
                           whole_fields(fields_of(fields), scene), "source " + std::to_string(source));
    }
  }
}

TEST(Parity, OutlinesTooLongForConstantsComeFromABuffer) {
  const Scene scene = scene_of({beaker1(), facets()}, Pose::rigged);
  const auto backend = backend_of(scene, make_field_set({FIELD_SCORE}, scene), Precision::single);
  EXPECT_EQ(backend->pipelines(0).outline, OUTLINE_SPECIALIZED);
  EXPECT_EQ(backend->pipelines(1).outline, OUTLINE_BUFFER);
}

// ---- leaving out ----

const std::vector<std::vector<int>> FEW_FIELDS{{FIELD_SCORE},
                                               {FIELD_TERMS, FIELD_STATUS, FIELD_USED_MASK},
                                               {FIELD_POSED, FIELD_BONE_STRETCH},
                                               {FIELD_HOLD_FORCE, FIELD_SAFE_TILT, FIELD_INNER_MASK, FIELD_CONTACT_ANGLES}};

TEST(Parity, FieldsLeftOutChangeNothingInTheRest) {
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
TEST(Parity, LiquidAndTiltsLeftOutChangeNothingInTheRest) {
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
    const auto planes_of = [&](const Scene& scene, bool force, bool liquid) {
      if (!device) return gather(*make_core_evaluator(scene), all_fields(scene), 0, grips);
      const auto backend = backend_of(scene, all_fields(scene), Precision::single);
      bitwise = backend->info().is_cpu;
      EXPECT_EQ(backend->pipelines(0).force, force);
      EXPECT_EQ(backend->pipelines(0).liquid, liquid);
      EXPECT_EQ(backend->liquid(0).empty(), !liquid);
      return gather(*backend, 0, grips);
    };
    const GatheredPlanes all = planes_of(wet, true, true);
    const GatheredPlanes without_liquid = planes_of(dry, true, false);
    FieldPlanes untouched = whole_fields(geometry, wet);
    untouched.push_back({FIELD_TERMS, 4});  // fingers, contacts, depth, posture
    for (const GatheredPlanes& fewer : {without_liquid, planes_of(untilted, false, false), planes_of(bare, false, false)})
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

// ---- top-N ----

TEST(Parity, BestAreThoseOfTheFullSort) {
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

TEST(Parity, FewerThanAskedForAreAllThereAre) {
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
  for (const host::Fault fault : {host::Fault::out_of_memory, host::Fault::device_lost, host::Fault::timeout}) {
    host::StreamOptions options = tiny();
    options.inject = [fault](std::size_t submit) { return submit == 3 ? fault : host::Fault::none; };
    const Streamed mended = stream_through(scene, grips, options);
    EXPECT_FALSE(mended.notes.empty());
    expect_same_planes(sound.planes, mended.planes, "fault " + std::to_string(static_cast<int>(fault)));
  }
}

// No device lasts: the core's answers, in the device's precision, through the same sink.
TEST_F(ParityStream, WithoutDeviceTheCoreAnswers) {
  host::StreamOptions options = tiny();
  options.inject = [](std::size_t) { return host::Fault::device_lost; };
  const Streamed streamed = stream_through(scene, grips, options);
  EXPECT_FALSE(streamed.notes.empty());
  GatheredPlanes core = gather(*make_core_evaluator(scene), streamed.planes.fields, 0, grips);
  core.reals.resize(streamed.planes.reals.size());  // the kept ones come first
  core.uints.resize(streamed.planes.uints.size());
  for (double& value : core.reals) value = static_cast<double>(static_cast<float>(value));
  expect_same_planes(streamed.planes, core, "core");
}

// ---- what must be noticed ----

// Whether planes of `broken`, by the device or by the core in float, pass for the core's of `scene`.
bool passes(const Scene& scene, const Scene& broken, bool device) {
  const FieldSet fields = all_fields(scene);
  const auto truth = make_core_evaluator(scene), core = make_core_float_evaluator(scene);
  const auto grips = grips_of(scene, 0, COUNT);
  Comparer comparer(scene, *truth, allowance(Precision::single));
  const auto against = [&](const GatheredPlanes& planes, const std::vector<LiquidResult>& liquid) {
    comparer.add(0, grips, planes, gather(*core, fields, 0, grips));
    comparer.add_liquid(0, liquid, core_liquid(scene, *core, 0));
  };
  if (device) {
    const auto backend = backend_of(broken, fields, Precision::single);
    against(gather(*backend, 0, grips), backend->liquid(0));
  } else {
    const auto other = make_core_float_evaluator(broken);
    against(gather(*other, fields, 0, grips), core_liquid(broken, *other, 0));
  }
  return comparer.holds();
}

TEST(Parity, AConstantBrokenOnOneSideIsNoticed) {
  const Scene scene = wet_scene({beaker2()}, Pose::articulated);
  EXPECT_TRUE(passes(scene, scene, true));
  EXPECT_TRUE(passes(scene, scene, false));
  Scene tolerance = scene, radius = scene, segment = scene, gravity = scene, density = scene, wall = scene, friction = scene,
        limit = scene;
  tolerance.hand.contact_tolerance += 50e-6;
  radius.hand.fingers[3].radii[4] += 50e-6;
  segment.hand.fingers[2].segments[2] += 50e-6;
  gravity.gravity = 9.81;
  density.liquid->density = 998;
  wall.vessels[0].wall += 5e-6;
  friction.force.friction += 1e-3;
  limit.hand.max_angle -= radians(1);
  EXPECT_FALSE(passes(scene, tolerance, true)) << "contact tolerance";
  EXPECT_FALSE(passes(scene, radius, true)) << "a fingertip's radius";
  EXPECT_FALSE(passes(scene, segment, false)) << "a segment's length";
  EXPECT_FALSE(passes(scene, gravity, false)) << "gravity";
  EXPECT_FALSE(passes(scene, density, false)) << "density of the liquid";
  EXPECT_FALSE(passes(scene, wall, false)) << "wall";
  EXPECT_FALSE(passes(scene, friction, false)) << "friction";
  EXPECT_FALSE(passes(scene, limit, false)) << "a joint's largest turn";
}

// A joint out of place by 20 um is noticed, one coordinate of it alone too, and in nearly every grip; noise of single precision is not.
TEST(Parity, ShiftsAreNoticedAndNoiseIsNot) {
  const Scene scene = wet_scene({beaker3()}, Pose::articulated);
  const FieldSet fields = all_fields(scene);
  const auto truth = make_core_evaluator(scene);
  const auto grips = grips_of(scene, 0, COUNT);
  const GatheredPlanes planes = gather(*truth, fields, 0, grips);
  std::size_t feasible = 0;
  for (std::size_t i = 0; i < grips.size(); ++i)
    feasible += (planes.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) == REASON_NONE ? 1 : 0;
  ASSERT_GT(feasible, 100u);
  const auto compared = [&](Precision precision, const GatheredPlanes& other) {
    Comparer comparer(scene, *truth, allowance(precision));
    comparer.add(0, grips, other, planes);
    return comparer;
  };

  for (const int joint : {0, THUMB_TIP, INDEX_TIP, 13, 18, 23}) {
    GatheredPlanes shifted = planes;
    for (std::size_t i = 0; i < grips.size(); ++i)
      shifted.reals[(fields.plane[FIELD_POSED] + 3 * joint + 1) * planes.count + i] += 20e-6;
    for (const Precision precision : {Precision::single, Precision::full}) {
      const Comparer comparer = compared(precision, shifted);
      EXPECT_FALSE(comparer.holds());
      // those that it passes are grips in which a finger ends at grazing incidence
      const auto row = std::ranges::find(comparer.rows(), "posed joints", &Comparison::quantity);
      ASSERT_NE(row, comparer.rows().end());
      EXPECT_GE(10 * row->outside, (precision == Precision::single ? 8 : 10) * feasible) << "joint " << joint;
    }
  }

  const auto noisy = [&](auto change) {
    GatheredPlanes other = planes;
    Random random(7);
    for (const int field : {FIELD_MIDPOINT, FIELD_JOINTS, FIELD_POSED, FIELD_SEPARATION, FIELD_PROXIES})
      for (int p = 0; p < field_planes(field, scene_fills(scene), scene.tilts.size()); ++p)
        for (std::size_t i = 0; i < grips.size(); ++i) {
          double& value = other.reals[(fields.plane[field] + p) * other.count + i];
          value = change(value, random);
        }
    return other;
  };
  const GatheredPlanes rounded = noisy([](double value, Random&) { return static_cast<double>(static_cast<float>(value)); });
  const GatheredPlanes hissing = noisy([](double value, Random& random) { return value + random.uniform(-1e-7, 1e-7); });
  EXPECT_TRUE(compared(Precision::single, rounded).holds());
  EXPECT_TRUE(compared(Precision::single, hissing).holds());
  EXPECT_FALSE(compared(Precision::full, hissing).holds());
}

}  // namespace
}  // namespace wholehand

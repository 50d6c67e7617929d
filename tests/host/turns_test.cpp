// SPDX-License-Identifier: MIT
// No kernel takes more turns of loops than every driver grants; the core computes what would take more. A meter after each kernel (meter.glsl)
// measures the count of a driver that ends loops after so many turns, as llvmpipe does. On every other driver the meter must measure 0.
// sanitizers: none
#include "host/turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>

#include "core/candidates.h"
#include "core/evaluator.h"
#include "evidence/check/compare.h"
#include "host/grip_backend.h"
#include "host/grip_program.h"
#include "host/run_once.h"
#include "shaders/status.h"
#include "tests/shaders/probe_shaders.h"
#include "tests/support/scene_texts.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand {
namespace {

using host::loop_turns;

const std::vector<host::Constant> COMMON{{CONST_GROUP_SIZE, std::uint32_t(GROUP_SIZE)}};
constexpr std::uint32_t PROBE_INVOCATIONS = 4 * GROUP_SIZE;

class Meter {
 public:
  explicit Meter(const host::Device& on) : on_(on), missing_(on, sizeof(std::uint32_t)) {
    const host::Kernel probe(on, test_shader("probe_turns"), COMMON, "probe_turns");
    idle_ = missing(probe_loops(probe, 0, 0));
    EXPECT_EQ(counts(), on.info().name.starts_with("llvmpipe")) << on.info().name << ": whether it ends loops is not as known";
    for (const auto& [outer, inner] : std::vector<std::array<std::uint32_t, 2>>{{100, 0}, {1, 40000}, {100, 300}, {30000, 0}}) {
      const std::int64_t known = loop_turns(outer, loop_turns(inner)), idle = loop_turns(0);
      const std::int64_t found = missing(probe_loops(probe, outer, inner)) - idle_;
      EXPECT_GE(found, counts() ? known - idle : 0) << outer << " times " << inner;
      EXPECT_LE(found, counts() ? known : 0) << outer << " times " << inner;
    }
  }

  // Whether the driver ends loops; it must grant the budget.
  bool counts() const { return idle_ > 0; }

  void bind(host::Commands& commands) const { commands.bind(BINDING_LANES, missing_); }

  // Turns of the vector that took most of them.
  std::int64_t turns(const host::Commands& step) { return missing(step) - idle_; }

 private:
  std::int64_t missing(const host::Commands& step) {
    missing_.write(std::vector<std::uint32_t>{0});
    host::run_once(on_, step);
    return missing_.read_as<std::uint32_t>(1)[0];
  }

  host::Commands probe_loops(const host::Kernel& probe, std::uint32_t outer, std::uint32_t inner) {
    host::Commands commands;
    bind(commands);
    commands.bind(BINDING_UINT_OUT, out_);
    commands.dispatch(probe, host::groups_for(on_, probe, PROBE_INVOCATIONS), Push{PROBE_INVOCATIONS, 0, outer, inner});
    return commands;
  }

  const host::Device& on_;
  host::Buffer missing_;
  host::Buffer out_{on_, PROBE_INVOCATIONS * sizeof(std::uint32_t)};
  std::int64_t idle_ = 0;
};

// Most turns of each kernel for some grips of the first vessel, the 64 best of them selected.
std::map<std::string, std::int64_t> turns_of(const Scene& scene, const FieldSet& fields, const std::vector<GripInput>& grips,
                                             host::GripBackendOptions options, bool& counts) {
  options.shaders = metered_shaders();
  const auto core = make_core_evaluator(scene, options.evaluator);
  host::GripProgram program(scene, host::make_scene_arrays(scene, *core, options.evaluator), fields, "vulkan", options);
  Meter meter(program.on);
  counts = meter.counts();
  host::Chunk chunk;
  chunk.count = grips.size();
  chunk.stride = (chunk.count + GROUP_SIZE - 1) / GROUP_SIZE * GROUP_SIZE;
  std::vector<float> axes(GRIP_AXES * chunk.stride);
  for (std::size_t i = 0; i < chunk.count; ++i) {
    const GripInput& g = grips[i];
    const std::array<double, GRIP_AXES> values{g.height, g.azimuth, g.obliquity, g.roll, g.offset, g.hand_scale};
    for (std::size_t axis = 0; axis < GRIP_AXES; ++axis) axes[axis * chunk.stride + i] = static_cast<float>(values[axis]);
  }
  const host::Buffer in = host::Buffer::of(program.on, axes),
                     real_out(program.on, program.real_planes * chunk.stride * sizeof(float)),
                     uint_out(program.on, program.fields.uint_planes * chunk.stride * sizeof(std::uint32_t)),
                     scores(program.on, 2 * host::SELECT_LARGEST * sizeof(float)),
                     indices(program.on, 2 * host::SELECT_LARGEST * sizeof(float));
  host::Commands commands;
  commands.bind(BINDING_GRIPS, in);
  commands.bind(BINDING_REAL_OUT, real_out);
  commands.bind(BINDING_UINT_OUT, uint_out);
  commands.bind(BINDING_CANDIDATES, scores);
  commands.bind(BINDING_INDICES, indices);
  meter.bind(commands);
  program.record(0, chunk, host::SELECT_LARGEST, NO_LEAST_SCORE, NO_LEAST_SCORE, commands);
  std::map<std::string, std::int64_t> most;
  for (std::size_t step = 0; step < commands.steps().size(); ++step) {
    std::int64_t& turns = most[commands.steps()[step].kernel->name()];
    turns = std::max(turns, meter.turns(commands.only(step)));
  }
  return most;
}

void expect_bounds(const std::map<std::string, std::int64_t>& turns, const std::map<std::string, std::int64_t>& bounds) {
  for (const auto& [kernel, taken] : turns) {
    const auto bound = bounds.find(kernel);
    ASSERT_NE(bound, bounds.end()) << kernel << " has no bound";
    EXPECT_LE(taken, bound->second) << kernel;
    EXPECT_LE(bound->second, host::TURN_BUDGET) << kernel;
    testing::Test::RecordProperty(kernel, std::to_string(taken));
  }
}

// Expects that a kernel took more turns than `least`, where the driver counts them. A driver that ends no loops counts no turns.
void expect_worst(bool counts, std::int64_t turns, std::int64_t least, const std::string& kernel) {
  EXPECT_GE(turns, counts ? least + 1 : 0) << kernel << ": not its worst";
  EXPECT_LE(turns, counts ? host::TURN_BUDGET : 0) << kernel;
}

// A flask with 20 fills and 69 tilts, so that 256 states are in a dispatch. At two thirds of its height its pinch takes thousands of solves.
Scene flask_of_many_states() {
  Scene scene = scene_from(R"(
[scene]
name = "flask"
[[vessel]]
name = "flask"
shape = "flask"
diameter_mm = 85
neck_mm = 34
height_mm = 140
wall_mm = 1.5
force_range_N = 3
[table]
[liquid]
fills = [0, 1]
[grips]
height_fraction = 0.5
[strength]
thumb_N = 40
index_N = 25
middle_N = 35
ring_N = 25
little_N = 14
palm_N = 80
[tilts]
deg = { from = 0, to = 170, count = 69 }
)");
  scene.liquid->fills.clear();
  for (int i = 0; i < 20; ++i) scene.liquid->fills.push_back(std::round(1e4 * i / 19) / 1e4);
  return scene;
}

VesselData belly_of(int elements) {
  std::vector<OutlineElement> outline{line_to(20, 0)};
  const int pieces = elements - 2;
  for (int i = 1; i <= pieces; ++i) outline.push_back(line_to(20 + 18 * std::sin(PI * i / (1.1 * pieces)), 100.0 * i / pieces));
  outline.push_back(line_to(0, 100));
  return vessel_of("belly", outline, 1);
}

GripInput grip_at(double height) {
  GripInput grip;
  grip.height = height;
  grip.obliquity = radians(-20);
  grip.roll = radians(-90);
  return grip;
}

constexpr std::size_t HARD_GRIP = 10;  // of 16 heights

const std::vector<int> EFFORTS{FIELD_SCORE,     FIELD_STATUS, FIELD_WORST_EFFORT,   FIELD_TIPS_WORST_EFFORT,
                               FIELD_SAFE_TILT, FIELD_PUSH,   FIELD_FRICTION_NEEDED};

// ---- what runs out is the core's ----

TEST(Turns, AGripWhoseTurnsRunOutIsTheCores) {
  const Scene scene = flask_of_many_states();
  const FieldSet fields = make_field_set(EFFORTS, scene);
  const auto core = make_core_evaluator(scene);
  host::GripBackend device(scene, make_core_evaluator(scene), fields, "vulkan", {});
  std::vector<GripInput> grips;
  for (int i = 0; i < 16; ++i) grips.push_back(grip_at((0.10 + 0.85 * i / 15) * 0.140));
  RunRequest request;
  request.last = grips.size();
  request.best = grips.size();
  request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
    std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
  };
  const GatheredPlanes truth = gather(*core, fields, 0, grips);
  int compared = 0;
  std::vector<Candidate> best;
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const std::uint32_t status = chunk.uint(fields.plane[FIELD_STATUS], i);
      EXPECT_EQ(status, truth.uint(FIELD_STATUS, chunk.first + i)) << i;
      if ((status & (STATUS_REASON_MASK | STATUS_PLAUSIBLE)) != STATUS_PLAUSIBLE) continue;
      if (is_eligible(status)) best.push_back({chunk.real(fields.plane[FIELD_SCORE], i), chunk.first + i});
      const int plane = fields.plane[FIELD_FRICTION_NEEDED];
      const double found = chunk.real(plane, i), right = truth.real(plane, chunk.first + i);
      EXPECT_NEAR(found, right, i == HARD_GRIP ? 1e-6 * right : 0.02 * right) << i;
      ++compared;
    }
  };
  const RunResult result = device.run(request);
  EXPECT_GT(compared, 3);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_EQ(result.notes[0].find("flask: "), 0u) << result.notes[0];
  EXPECT_NE(result.notes[0].find(" evaluated on the core: "), std::string::npos) << result.notes[0];
  std::ranges::sort(best, is_better);
  ASSERT_EQ(result.best.size(), best.size());
  for (std::size_t k = 0; k < best.size(); ++k) {
    EXPECT_EQ(result.best[k].index, best[k].index) << k;
    EXPECT_EQ(result.best[k].score, best[k].score) << k;
  }
}

// A copied outline has no loops. One of the largest size in a loop leaves a grip fewer steps than the core takes; a longer one is the core's.
TEST(Turns, ALongOutlineIsEvaluatedOnTheCore) {
  for (const int elements : {MAX_OUTLINE, MAX_OUTLINE + 1}) {
    Scene scene = scene_of({belly_of(elements)});
    scene.hand.between = MOST_BETWEEN;
    host::GripBackendOptions options;
    options.outline = OUTLINE_BUFFER;
    ASSERT_FALSE(host::are_granted({}, {elements, MOST_BETWEEN, true}));
    const FieldSet fields = make_field_set({FIELD_GAP, FIELD_PROXIES}, scene);
    const auto core = make_core_evaluator(scene);
    const auto grips = sample_grips(scene.vessels[0], 100, 3);
    host::GripBackend device(scene, make_core_evaluator(scene), fields, "vulkan", options);
    const GatheredPlanes truth = gather(*core, fields, 0, grips);
    RunRequest request;
    request.last = grips.size();
    request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
      std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
    };
    request.sink = [&](const PlaneChunk& chunk) {
      for (std::size_t i = 0; i < chunk.count; ++i) {
        const double found = chunk.real(fields.plane[FIELD_GAP], i), right = truth.real(fields.plane[FIELD_GAP], chunk.first + i);
        EXPECT_EQ(std::isnan(found), std::isnan(right)) << i;
        if (!std::isnan(right)) {
          EXPECT_NEAR(found, right, 1e-5) << i;
        }
      }
    };
    const std::vector<std::string> notes = device.run(request).notes;
    const bool is_whole = elements > MAX_OUTLINE && device.info().is_cpu;  // a GPU has no limit
    const std::string why = "belly: an outline of " + std::to_string(elements) +
                            " elements is evaluated on the core: its loops may be longer than " + device.info().device +
                            " runs them";
    EXPECT_EQ(std::ranges::count(notes, why), is_whole ? 1 : 0);
  }
}

// ---- every kernel at its worst ----

// With a bracket that rounding never lets close, a solve ends after its last pivot, and a state after two solves.
TEST(Turns, EffortsEndWithinTheirBounds) {
  const Scene scene = flask_of_many_states();
  const FieldSet fields = make_field_set(EFFORTS, scene);
  std::vector<GripInput> grips;
  for (int i = 0; i < 2 * GROUP_SIZE; ++i) grips.push_back(grip_at((0.10 + 0.85 * i / (2 * GROUP_SIZE - 1)) * 0.140));
  grips[5] = grip_at((0.10 + 0.85 * HARD_GRIP / 15) * 0.140);
  for (const double tolerance : {0.0, 1e-12}) {
    host::GripBackendOptions options;
    options.evaluator.effort_tolerance = tolerance;
    bool counts = false;
    const auto turns = turns_of(scene, fields, grips, options, counts);
    const host::GripLoops loops{0, scene.hand.between, false};
    expect_bounds(turns, {{"closure", host::closure_turns({}, loops)},
                          {"rest", host::rest_turns({}, loops)},
                          {"contact", host::contact_turns(loops)},
                          {"overlap", host::overlap_turns(loops)},
                          {"force", host::force_turns(STATES_IN_BLOCK)},
                          {"effort", host::effort_turns(20)},
                          {"reserve", host::reserve_turns()},
                          {"score", host::score_turns(20)},
                          {"select", host::select_turns(host::SELECT_LARGEST)}});
    expect_worst(counts, turns.at("reserve"), host::TURN_BUDGET / 2, "reserve");
  }
}

// Whole hands with as many spheres as there may be. A step that never ends near the wall takes all its turns, and an outline of the largest size in a
// loop leaves few.
TEST(Turns, GripsEndWithinTheirBounds) {
  Scene scene = scene_of({belly_of(MAX_OUTLINE)});
  scene.hand.between = MOST_BETWEEN;
  scene.table = TableData{};
  scene.arm = ArmData{};
  const auto grips = sample_grips(scene.vessels[0], 200, 3);
  for (const OutlineSource source : {OUTLINE_COPIED, OUTLINE_BUFFER})
    for (const double tolerance : {1e-7, 1e-30}) {
      const bool is_looped = source == OUTLINE_BUFFER, proxies = !is_looped;
      std::vector<int> wanted{FIELD_SCORE, FIELD_STATUS, FIELD_SELF_DEPTH};
      if (proxies) wanted.push_back(FIELD_PROXIES);
      host::GripBackendOptions options;
      options.outline = source;
      options.evaluator.stop_tolerance = tolerance;
      bool counts = false;
      const auto turns = turns_of(scene, make_field_set(wanted, scene), grips, options, counts);
      const host::GripLoops loops{is_looped ? MAX_OUTLINE : 0, MOST_BETWEEN, proxies, ARM_AZIMUTHS};
      expect_bounds(turns, {{"closure", is_looped ? host::TURN_BUDGET : host::closure_turns({}, loops)},
                            {"rest", is_looped ? host::TURN_BUDGET : host::rest_turns({}, loops)},
                            {"contact", host::contact_turns(loops)},
                            {"overlap", host::overlap_turns(loops)},
                            {"score", host::score_turns(1)},
                            {"select", host::select_turns(host::SELECT_LARGEST)}});
      expect_worst(counts, turns.at("closure"), tolerance < 1e-20 ? TRACE_STEPS / 2 : 10, "closure");
      expect_worst(counts, turns.at("rest"), 100, "rest");
    }
}

// Scores in ascending order: each entry shifts a whole list.
TEST(Turns, SelectionsEndWithinTheirBounds) {
  const host::Device on;
  Meter meter(on);
  const auto words = host::find_shader("select", Precision::single, BUILD_WIDE, OUTLINE_NONE, metered_shaders());
  const std::vector<host::Constant> constants{
      COMMON[0], {CONST_PLANE + FIELD_SCORE, std::int32_t(0)}, {CONST_PLANE + FIELD_STATUS, std::int32_t(0)}};
  const host::Kernel kernel(on, words, constants, "select");
  std::vector<float> scores(SELECT_ENTRIES);
  std::iota(scores.begin(), scores.end(), 1.0f);
  const host::Buffer score = host::Buffer::of(on, scores);
  const host::Buffer status = host::Buffer::of(on, std::vector<std::uint32_t>(SELECT_ENTRIES, STATUS_PLAUSIBLE));
  const host::Buffer candidates(on, 2 * host::SELECT_LARGEST * sizeof(float)),
      indices(on, 2 * host::SELECT_LARGEST * sizeof(std::uint32_t));
  host::Commands commands;
  meter.bind(commands);
  commands.bind(BINDING_REAL_OUT, score);
  commands.bind(BINDING_UINT_OUT, status);
  commands.bind(BINDING_CANDIDATES, candidates);
  commands.bind(BINDING_INDICES, indices);
  const Push push{SELECT_ENTRIES, SELECT_ENTRIES, SELECT_SCORES_TO_FIRST, host::SELECT_LARGEST,
                  std::bit_cast<std::uint32_t>(-1.0f)};
  commands.dispatch(kernel, host::groups_for(on, kernel, 1), push);
  const std::int64_t turns = meter.turns(commands);
  EXPECT_LE(turns, host::select_turns(host::SELECT_LARGEST));
  expect_worst(meter.counts(), turns, SELECT_ENTRIES * (host::SELECT_LARGEST - 1), "select");
  const auto best = indices.read_as<std::uint32_t>(host::SELECT_LARGEST);
  for (std::uint32_t k = 0; k < host::SELECT_LARGEST; ++k) EXPECT_EQ(best[k], SELECT_ENTRIES - 1 - k);
}

}  // namespace
}  // namespace wholehand

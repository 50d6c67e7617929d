// SPDX-License-Identifier: MIT
// A sweep that keeps no variable judges only the grips that may reach its lists, and the lists are those of a sweep that judges all.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/fields.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "host/grip_backend.h"
#include "host/open_backend.h"
#include "shaders/status.h"
#include "sweeps/lists/robust.h"
#include "sweeps/plan/plan.h"
#include "sweeps/run/run.h"
#include "tests/support/files.h"
#include "tests/support/natural_scenes.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

Scene one_beaker() {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  scene.vessels.resize(1);
  scene.robust.reset();
  take_few_grips(scene);
  return scene;
}

struct Judged {
  double score, effort;
  std::uint32_t status;
};

std::vector<Judged> judge(Backend& backend, const Plan& plan, const std::atomic<double>* least_score) {
  std::vector<Judged> grips;
  RunRequest request;
  request.last = plan.grips();
  request.grips = [&](std::size_t v, std::uint64_t first, std::size_t count, GripInput* out) { plan.fill(v, first, count, out); };
  request.least_score = least_score;
  const FieldSet& fields = backend.fields();
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i)
      grips.push_back({chunk.real(fields.plane[FIELD_SCORE], i), chunk.real(fields.plane[FIELD_WORST_EFFORT], i),
                       chunk.uint(fields.plane[FIELD_STATUS], i)});
  };
  backend.run(request);
  return grips;
}

// In small chunks, so that the first ones are there before the last ones begin.
std::unique_ptr<Backend> open_on(const std::string& on, const Scene& scene, const FieldSet& fields) {
  if (on == "core") return open_backend(scene, fields, on, Precision::full, 1);
  host::GripBackendOptions options;
  options.stream.first_items = 64;
  options.stream.target_seconds = 1e-9;
  return std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), fields, on, options);
}

// Counts the grips that it leaves unjudged.
struct CountsUnjudged final : Backend {
  CountsUnjudged(std::unique_ptr<Backend> backend, std::uint64_t& count) : own(std::move(backend)), unjudged(count) {}
  const BackendInfo& info() const override { return own->info(); }
  const FieldSet& fields() const override { return own->fields(); }
  std::vector<LiquidResult> liquid(std::size_t vessel) override { return own->liquid(vessel); }
  RunResult run(const RunRequest& request) override {
    RunRequest asked = request;
    asked.sink = [&](const PlaneChunk& chunk) {
      for (std::size_t i = 0; i < chunk.count && is_kept(fields(), FIELD_STATUS); ++i)
        unjudged += (chunk.uint(fields().plane[FIELD_STATUS], i) & STATUS_UNJUDGED) != 0;
      if (request.sink) request.sink(chunk);
    };
    return own->run(asked);
  }
  std::unique_ptr<Backend> own;
  std::uint64_t& unjudged;
};

struct Swept {
  std::string lists;
  std::uint64_t unjudged = 0;
};

Swept sweep_on(const std::string& on, const Scene& scene) {
  const TemporaryFolder folder;
  Swept swept;
  SweepParts parts;
  parts.open_backend = [&](const BackendChoice&, const FieldSet& fields) {
    return std::make_unique<CountsUnjudged>(open_on(on, scene, fields), swept.unjudged);
  };
  parts.open_evaluator = [&] { return make_core_evaluator(scene); };
  parts.open_core = open_core_for;
  const SweepOptions options{.output = folder / "swept.nc", .refine = false, .hooks = {.note = [](const std::string&) {}}};
  EXPECT_EQ(run_sweep(scene, options, parts), ExitCode::done);
  swept.lists = file_text(folder / "swept.best.csv");
  return swept;
}

// Expects the same lists with and without variables that are kept. Returns how many grips are left unjudged.
std::uint64_t expect_same_lists(const std::string& on, const Scene& scene) {
  Scene few = scene;
  few.output.keep.emplace();
  few.output.also.clear();
  const Swept all = sweep_on(on, scene), some = sweep_on(on, few);
  EXPECT_EQ(all.lists, some.lists);
  EXPECT_EQ(all.unjudged, 0u);
  return some.unjudged;
}

TEST(FewEfforts, AGripIsLeftUnjudgedWhereNoEffortTakesItToTheLeastScore) {
  const Scene scene = one_beaker();
  const Plan plan(scene, false);
  const std::atomic<double> least_score{0.9};
  for (const char* on : {"core", "vulkan"}) {
    SCOPED_TRACE(on);
    const auto backend = open_on(on, scene, make_field_set({FIELD_SCORE, FIELD_STATUS, FIELD_WORST_EFFORT}, scene));
    const std::vector<Judged> all = judge(*backend, plan, nullptr), few = judge(*backend, plan, &least_score);
    ASSERT_EQ(all.size(), plan.grips());
    ASSERT_EQ(few.size(), plan.grips());
    std::size_t unjudged = 0, judged = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((few[i].status & STATUS_UNJUDGED) != 0) {
        ++unjudged;
        EXPECT_TRUE(is_plausible(all[i].status) && !is_eligible(few[i].status)) << i;
        EXPECT_LT(all[i].score, least_score) << i;
        EXPECT_EQ(few[i].score, 0) << i;
        EXPECT_TRUE(std::isnan(few[i].effort)) << i;
        continue;
      }
      judged += is_plausible(all[i].status);
      EXPECT_EQ(few[i].status, all[i].status) << i;
      EXPECT_EQ(few[i].score, all[i].score) << i;
      EXPECT_TRUE(few[i].effort == all[i].effort || (std::isnan(few[i].effort) && std::isnan(all[i].effort))) << i;
    }
    EXPECT_GT(unjudged, 100u);
    EXPECT_GT(judged, 10u);
  }
}

TEST(FewEfforts, LeaveTheLists) {
  Scene scene = one_beaker();
  scene.output.best = 5;
  for (const char* on : {"core", "vulkan"}) {
    SCOPED_TRACE(on);
    scene.output.apart = 0.025;
    EXPECT_EQ(expect_same_lists(on, scene), 0u) << "lists of different grips take all of them";
    scene.output.apart = 0;
    EXPECT_GT(expect_same_lists(on, scene), 10u);
  }
}

TEST(FewEfforts, LeaveTheListsOfRandomScenes) {
  std::uint64_t on_core = 0, on_device = 0;  // grips that are left unjudged
  int scenes = 0;
  for (std::uint64_t seed = 1; scenes < 20; ++seed) {
    Scene scene = natural_scene(seed);
    if (!has_effort(scene)) continue;
    ++scenes;
    scene.robust.reset();
    scene.output.best = 3;
    scene.output.apart = 0;
    SCOPED_TRACE(seed);
    on_core += expect_same_lists("core", scene);
    if (scenes % 3 == 0) on_device += expect_same_lists("vulkan", scene);  // which compiles its kernels for each
  }
  EXPECT_GT(on_core, 100u);
  EXPECT_GT(on_device, 100u);
}

}  // namespace
}  // namespace wholehand::sweeps

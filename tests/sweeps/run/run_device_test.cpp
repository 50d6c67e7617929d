// SPDX-License-Identifier: MIT
// Different best grips of a sweep on a Vulkan device, after a break too, and those that `rank` lists of its result: against the
// definition, by all pairs of the file's scores and the core's hands.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "core/candidates.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "host/open_backend.h"
#include "sweeps/lists/different_grips.h"
#include "sweeps/lists/robust.h"
#include "sweeps/rank/rank.h"
#include "sweeps/result/sweep_result.h"
#include "sweeps/run/run.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

// Two vessels of 1,728 grips: more than the 1,024 of the first chunk, so that a sweep may end between two.
Scene choosy_beakers() {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  scene.vessels.resize(2);
  scene.strength.reset();  // costs most of the time, and the choice is the same
  scene.robust.reset();    // the list is that of the scores
  take_few_grips(scene);
  scene.output.best = 12;
  scene.output.apart = 0.025;
  return scene;
}

// Sends SIGINT with the second chunk.
struct Interrupted final : Backend {
  std::unique_ptr<Backend> own;
  int chunks = 0;

  explicit Interrupted(std::unique_ptr<Backend> backend) : own(std::move(backend)) {}
  const BackendInfo& info() const override { return own->info(); }
  const FieldSet& fields() const override { return own->fields(); }
  std::vector<LiquidResult> liquid(std::size_t vessel) override { return own->liquid(vessel); }
  RunResult run(const RunRequest& request) override {
    RunRequest asked = request;
    asked.sink = [&](const PlaneChunk& chunk) {
      request.sink(chunk);
      if (++chunks == 2) raise(SIGINT);
    };
    return own->run(asked);
  }
};

ExitCode sweep_on_device(const Scene& scene, SweepOptions options, bool is_interrupted) {
  SweepParts parts;
  parts.open_backend = [&](const BackendChoice&, const FieldSet& fields) -> std::unique_ptr<Backend> {
    auto backend = open_backend(scene, fields, "vulkan", Precision::single, 0);
    if (is_interrupted) return std::make_unique<Interrupted>(std::move(backend));
    return backend;
  };
  parts.open_evaluator = [&] { return make_core_evaluator(scene); };
  parts.open_core = open_core_for;
  options.refine = false;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const ExitCode code = run_sweep(scene, options, parts);
  testing::internal::GetCapturedStdout();
  testing::internal::GetCapturedStderr();
  return code;
}

// The grips of a vessel's list by the definition.
std::vector<std::uint64_t> listed(const std::string& file, const Scene& scene, const Plan& plan, std::size_t vessel) {
  const auto core = make_core_evaluator(scene);
  const auto scores = read_values(file, "score"), plausible = read_values(file, "plausible"), reasons = read_values(file, "reason");
  std::vector<Candidate> grips;
  for (std::uint64_t i = 0; i < plan.grips(); ++i) {
    const auto at = static_cast<std::size_t>(vessel * plan.stored_grips() + i);
    if (reasons[at] == 0 && plausible[at] == 1) grips.push_back({scores[at], i});
  }
  std::sort(grips.begin(), grips.end(), is_better);
  std::vector<std::uint64_t> taken;
  std::vector<std::optional<PosedHand>> hands;  // of these
  std::size_t left_out = 0;
  for (const Candidate& grip : grips) {
    const auto hand = core->posed(vessel, plan.grip(vessel, grip.index));
    const bool differs =
        std::all_of(hands.begin(), hands.end(), [&](const auto& other) { return are_different(hand, other, scene.output.apart); });
    left_out += differs ? 0 : 1;
    if (!differs) continue;
    taken.push_back(grip.index);
    hands.push_back(hand);
    if (taken.size() == static_cast<std::size_t>(scene.output.best)) break;
  }
  EXPECT_GT(left_out, 0u) << "else the best grips are all different, and nothing was chosen";
  return taken;
}

TEST(RunOnADevice, DifferentBestGripsAreThoseOfTheDefinitionAfterABreakToo) {
  const TemporaryFolder folder;
  const Scene scene = choosy_beakers();
  SweepOptions options;
  options.output = folder / "whole.nc";
  ASSERT_EQ(sweep_on_device(scene, options, false), ExitCode::done);
  options.output = folder / "parts.nc";
  // passes over the grips instead of one over the best of them
  options.tuning.pool = 3;
  options.tuning.cached_scores = 0;
  ASSERT_EQ(sweep_on_device(scene, options, true), ExitCode::interrupted);
  ASSERT_FALSE(file_exists(options.output));
  options.resume = true;
  ASSERT_EQ(sweep_on_device(scene, options, false), ExitCode::done);
  for (const char* name : {"whole.nc", "parts.nc"}) {
    const std::string file = folder / name;
    SweepResult result(file);
    const Plan plan(scene, keeps_vectors(result.variables()));
    result.use(scene, plan);
    RankRequest request;
    request.best = static_cast<std::size_t>(scene.output.best);
    request.apart = scene.output.apart;
    request.pool = 3;
    const Ranking ranking = rank_grips(result, scene, plan, request, [&] { return make_core_evaluator(scene); });
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const auto expected = listed(file, scene, plan, v);
      const auto best = result.best(v);
      ASSERT_EQ(best.size(), expected.size()) << name;
      ASSERT_EQ(ranking.lists[v].size(), expected.size()) << name;
      for (std::size_t rank = 0; rank < expected.size(); ++rank) {
        EXPECT_EQ(best[rank].index, expected[rank]) << name << " " << v << " " << rank;
        EXPECT_EQ(ranking.lists[v][rank].candidate.index, expected[rank]) << name << " " << v << " " << rank;
      }
    }
  }
  EXPECT_EQ(read_values(folder / "whole.nc", "best_grip"), read_values(folder / "parts.nc", "best_grip"));
}

}  // namespace
}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// All best grips of the default scene, as a user gets them, pass a check that shares no code with the kernels: no
// skin under the table, no bone deep in the glass, no two fingers through each other.
// sanitizers: none
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/result/grip_lists.h"
#include "sweeps/result/sweep_result.h"
#include "sweeps/run/run.h"
#include "tests/support/capsule_check.h"
#include "tests/support/files.h"

namespace wholehand {
namespace {

// m. The sweep decides in float (docs/evidence.md: places within 10 um), the check evaluates the same grip in double.
constexpr double FLOAT = 10e-6;

TEST(BestGrips, OfTheDefaultSceneAreThoseOfABody) {
  const Scene scene = read_scene_file(find_scene("three_beakers"));
  ASSERT_TRUE(scene.table);
  ASSERT_GT(scene.hand.between, 0);
  TemporaryFolder folder;
  const sweeps::SweepOptions options{.output = folder / "best.nc"};
  testing::internal::CaptureStdout();
  ASSERT_EQ(sweeps::run_sweep(scene, options), ExitCode::done);
  testing::internal::GetCapturedStdout();
  const sweeps::Plan plan(scene, true);
  sweeps::SweepResult result(options.output);
  result.use(scene, plan);
  const auto core = make_core_evaluator(scene);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const std::vector<Candidate> best = result.best(v);
    const auto refined = result.refined(v);
    ASSERT_EQ(best.size(), static_cast<std::size_t>(scene.output.best));
    ASSERT_EQ(refined.size(), best.size());
    for (std::size_t rank = 0; rank < best.size(); ++rank) {
      std::vector<GripInput> grips{plan.grip(v, best[rank].index)};
      if (refined[rank]) grips.push_back(refined[rank]->grip);
      for (const GripInput& grip : grips) {
        const std::string which = scene.vessels[v].name + " rank " + std::to_string(rank + 1);
        GripResult at;
        core->grip(v, grip, at);
        ASSERT_EQ(at.reason, Reason::none) << which;
        const CapsuleCheck check = check_capsules(scene, *core, v, grip, at);
        EXPECT_GT(check.lowest, scene.table->clearance - FLOAT) << which;
        EXPECT_LT(check.deepest, scene.hand.depth_limit + FLOAT) << which;
        EXPECT_LT(check.overlap, scene.hand.depth_limit + FLOAT)
            << which << ": bones " << check.overlapping[0] << ", " << check.overlapping[1];
      }
    }
  }
}

}  // namespace
}  // namespace wholehand

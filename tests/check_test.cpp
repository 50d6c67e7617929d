// sanitizers: none
#include "sweeps/check.h"

#include <gtest/gtest.h>

#include "app/paths.h"
#include "app/scene_reader.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

Scene small_scene() { return read_scene_file(find_scene("small")); }

TEST(Check, HoldsWhereTheTwinsAgree) { EXPECT_EQ(run_check(small_scene(), {}), ExitCode::done); }

TEST(Check, SaysNoWhereAConstantDiffersOnOneSide) {
  const Scene scene = small_scene();
  Scene broken = scene;
  broken.hand.fingers[2].radii[4] += 50e-6;  // the middle fingertip is 50 micrometres thicker on the device
  CheckOptions options;
  options.device_scene = &broken;
  EXPECT_EQ(run_check(scene, options), ExitCode::no);
}

TEST(Check, SaysNoWhereNothingCouldBeCompared) {
  Scene scene = small_scene();
  scene.grips.offset.values = {0.2};  // every line misses the vessel
  EXPECT_EQ(run_check(scene, {}), ExitCode::no);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Conditions of a discrete GPU: memory that the host does not see, queues that only copy, one grip an invocation. A layer presents lavapipe as such a
// device, and the validation layer above it judges everything that each queue gets.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "core/prepare.h"
#include "evidence/check/compare.h"
#include "host/grip_backend.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

Scene carried() {
  Scene scene = scene_of({beaker1(), beaker3()}, Pose::articulated, left_hand());
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 0.6};
  scene.tilts = {0, radians(40), radians(110)};
  scene.strength = StrengthData{};
  return scene;
}

std::unique_ptr<host::GripBackend> backend_of(const Scene& scene) {
  const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_STATUS, FIELD_MIDPOINT, FIELD_PEAK_FORCE, FIELD_WORST_EFFORT}, scene);
  host::GripBackendOptions options;
  options.stream.first_items = 512;
  return std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), fields, "vulkan", options);
}

std::vector<GatheredPlanes> planes_of(const Scene& scene, host::GripBackend& backend) {
  std::vector<GatheredPlanes> planes;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v)
    planes.push_back(gather(backend, v, sample_grips(scene.vessels[v], 3000, 7 + v)));
  return planes;
}

// Devices opened meanwhile are those of the layer, under the validation layer.
class Layered {
 public:
  Layered() {
    write_file(folder_ / "discrete_gpu.json",
               R"({"file_format_version": "1.2.0", "layer": {"name": "VK_LAYER_WHOLEHAND_discrete_gpu",
      "type": "GLOBAL", "library_path": ")" STAND_IN_DISCRETE_GPU R"(", "api_version": "1.3.0", "implementation_version": "1",
      "description": "lavapipe as a discrete GPU"}})");
  }

 private:
  const TemporaryFolder folder_;
  const ScopedVariable path_{"VK_LAYER_PATH",
                             ("/usr/share/vulkan/explicit_layer.d:" + folder_.path()).c_str()};  // from the program down
  const ScopedVariable layers_{"VK_INSTANCE_LAYERS",
                               "VK_LAYER_KHRONOS_validation:VK_LAYER_WHOLEHAND_discrete_gpu"};  // from the program down
};

bool have_same_bits(const GatheredPlanes& a, const GatheredPlanes& b) {
  const auto has_same_bits = [](double x, double y) { return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y); };
  return std::ranges::equal(a.reals, b.reals, has_same_bits) && a.uints == b.uints;
}

TEST(DiscreteGpu, GivesTheBitsOfTheSameDeviceWithOneQueueForAll) {
  const Scene scene = carried();
  const std::vector<GatheredPlanes> direct = planes_of(scene, *backend_of(scene));

  const Layered layered;
  const auto backend = backend_of(scene);
  ASSERT_EQ(backend->device().kind, host::DeviceKind::discrete);
  ASSERT_FALSE(backend->device().unified_memory);
  const std::vector<GatheredPlanes> staged = planes_of(scene, *backend);
  for (std::size_t v = 0; v < staged.size(); ++v) EXPECT_TRUE(have_same_bits(staged[v], direct[v])) << v;
}

// The layer grants 48 allocations.
TEST(DiscreteGpu, TakesFewAllocationsForHundredsOfVessels) {
  const auto wet = [](const std::vector<VesselData>& vessels) {
    Scene scene = scene_of(vessels, Pose::rigged, left_hand());
    scene.liquid = LiquidData{};
    scene.liquid->fills = {0, 0.6};
    scene.tilts = {0, radians(40)};
    return scene;
  };
  std::vector<VesselData> vessels(299, beaker1());
  vessels.push_back(beaker3());
  const Scene many = wet(vessels), one = wet({beaker3()});
  const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_STATUS, FIELD_MIDPOINT}, many);
  const auto grips = sample_grips(one.vessels[0], 300, 7);

  const Layered layered;
  const auto results_of_last = [&](const Scene& scene) {
    host::GripBackend backend(scene, make_core_evaluator(scene), fields, "vulkan");
    const std::size_t last = scene.vessels.size() - 1;
    return gather(backend, last, grips);
  };
  EXPECT_TRUE(have_same_bits(results_of_last(many), results_of_last(one)));
}

}  // namespace
}  // namespace wholehand

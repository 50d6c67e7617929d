// SPDX-License-Identifier: MIT
#include "tests/support/whole_parity.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace wholehand {

using host::GripBackend;
using host::GripBackendOptions;

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

Scene wet_scene(std::vector<VesselData> vessels, Pose pose, const HandData& hand) {
  Scene scene = scene_of(std::move(vessels), pose, hand);
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 0.4, 1};
  scene.tilts = {0, radians(20), radians(75), radians(90), radians(180)};
  return scene;
}

std::vector<GripInput> grips_of(const Scene& scene, std::size_t vessel, int count) {
  std::vector<GripInput> grips = sample_grips(scene.vessels[vessel], count, 1000 + vessel);
  Random random(2000 + vessel);
  for (GripInput& grip : grips) grip.hand_scale = random.uniform(0.85, 1.2);
  grips.front().obliquity = PI / 2;  // along the axis: degenerate
  return grips;
}
std::unique_ptr<GripBackend> backend_of(const Scene& scene, const FieldSet& fields, Precision precision,
                                        GripBackendOptions options) {
  options.precision = precision;
  return std::make_unique<GripBackend>(scene, make_core_evaluator(scene, options.evaluator), fields, "vulkan", options);
}

std::unique_ptr<Evaluator> core_of(const Scene& scene, Precision precision) {
  return precision == Precision::single ? make_core_float_evaluator(scene) : make_core_evaluator(scene);
}

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

void expect_parity(const Scene& scene, const std::string& name, int count) {
  const FieldSet fields = compared_fields(scene);
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
      for (std::size_t i = 0; i < grips.size(); ++i)
        feasible += (device.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) == REASON_NONE ? 1 : 0;
    }
    const std::string label = name + (precision == Precision::single ? "_float" : "_double");
    EXPECT_TRUE(comparer.holds()) << label << "\n" << table_of(comparer);
    EXPECT_GT(5 * feasible, comparer.grips()) << "too few feasible grips to tell anything";
    testing::Test::RecordProperty(label, table_of(comparer));
  }
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
// The core in double against the same core in long double: what double precision itself costs.
// sanitizers: none
#include <gtest/gtest.h>

#include <memory>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/compare.h"
#include "sweeps/plan/plan.h"
#include "tests/support/long_double.h"

namespace wholehand {
namespace {

std::vector<GripInput> some_grips(const Scene& scene, std::size_t vessel, std::uint64_t every) {
  const sweeps::Plan plan(scene, true);
  std::vector<GripInput> grips;
  for (std::uint64_t i = 0; i < plan.grips(); i += every) grips.push_back(plan.grip(vessel, i));
  return grips;
}

// The two may differ by what the check allows double against double: twice the stop tolerance through the kernels, and rounding.
TEST(LongDouble, DoubleIsWithinItsOwnTolerances) {
  for (const char* name : {"three_beakers", "small", "paper_pose"}) {
    const Scene scene = read_scene_file(find_scene(name));
    const auto core = make_core_evaluator(scene);
    const auto wide = core_ld::make_evaluator(scene, {});
    Comparer comparer(scene, *core, allowance(Precision::full));
    bool any = false;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const auto grips = some_grips(scene, v, name == std::string("three_beakers") ? 97 : 1);
      const FieldSet fields = all_fields(scene);
      const GatheredPlanes full = gather(*core, fields, v, grips), wider = gather(*wide, fields, v, grips);
      comparer.add(v, grips, full, wider);
      for (std::size_t k = 0; k < full.reals.size(); ++k) any |= full.reals[k] != wider.reals[k];
      for (std::size_t fill = 0; scene.liquid && fill < scene.liquid->fills.size(); ++fill)
        for (const double tilt : scene.tilts)
          comparer.add_liquid(v, {core->liquid(v, scene.liquid->fills[fill], tilt)},
                              {wide->liquid(v, scene.liquid->fills[fill], tilt)});
    }
    for (const Comparison& row : comparer.rows())
      EXPECT_EQ(row.outside, 0u) << name << ": " << row.kernel << " " << row.quantity << " worst " << row.worst << " " << row.unit
                                 << ", tolerance " << row.tolerance << " at #" << row.grip;
    EXPECT_TRUE(comparer.holds()) << name;
    EXPECT_TRUE(any) << "the wider core computes in double";
  }
}

}  // namespace
}  // namespace wholehand

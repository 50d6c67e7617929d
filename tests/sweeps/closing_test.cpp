// SPDX-License-Identifier: MIT
#include "sweeps/closing.h"

#include <gtest/gtest.h>

#include "tests/support/fake_backend.h"

namespace wholehand {
namespace {

TEST(Closing, OpeningSaysWhatIsEvaluatedAndWhere) {
  Scene scene = fake_scene();
  BackendInfo info{"vulkan", "llvmpipe", "Mesa", Precision::single, true};
  EXPECT_EQ(opening_lines(scene, Plan(scene, false), info),
            "fake: 560 grips of 2 vessels, 8 states each\n"
            "on llvmpipe, a CPU driver (Mesa), single precision\n"
            "one azimuth stands for all 3: the vessels are bodies of revolution\n");
  info.is_cpu = false;
  info.precision = Precision::full;
  scene.tilts.clear();
  scene.name.clear();
  scene.vessels.resize(1);
  EXPECT_EQ(opening_lines(scene, Plan(scene, true), info), "sweep: 840 grips of 1 vessel\non llvmpipe (Mesa), double precision\n");
}

TEST(Closing, VesselsSayWhatTheyHoldAndWeigh) {
  Scene scene = fake_scene();
  scene.vessels[0].wall = 1e-3;
  std::vector<VesselFacts> facts(2);
  facts[0].capacity = 446.7e-6;
  facts[0].empty_mass = 0.19;
  facts[1].empty_mass = 1.23456;
  EXPECT_EQ(vessel_lines(scene, facts), "first vessel: holds 447 mL, 0.190 kg empty\nsecond: holds nothing, 1.23 kg empty\n");
}

TEST(Closing, TimesAddUp) {
  const std::string text = closing_lines({"missing.nc", "missing.best.csv"}, {2.0, 1.25, 0.25, 50000000});
  EXPECT_EQ(text.substr(0, text.find("; CPU")),
            "wrote missing.nc (0 B), missing.best.csv\n"
            "2.00 s: kernels 1.25, file writing 0.250 (200 MB/s), everything else 0.50");
  EXPECT_NE(text.find("; peak memory "), std::string::npos);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Many rendered walls at once against the core's, one by one.
// sanitizers: none
#include "host/wall_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/text/error.h"
#include "core/wall_run.h"
#include "device/loop/wall.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

class WallMapTest : public testing::Test {};

WallDevice device_of(double mass, double damping, double rate) {
  WallDevice device;
  device.mass = mass;
  device.damping = damping;
  device.rate = rate;
  return device;
}

// Walls from soft to beyond every limit, with delays, encoders, friction and fingers among them.
std::vector<WallTrial> trials() {
  std::vector<WallTrial> all;
  for (const double share : {0.02, 0.3, 0.9, 1.1, 2.0, 30.0})
    for (int kind = 0; kind < 6; ++kind) {
      WallDevice device = device_of(0.1, 1, 1000);
      if (kind == 1) device.delay = 2;
      if (kind == 2) device.encoder_step = 1e-5, device.coulomb = 0.2;
      if (kind == 3) device.finger_mass = 0.01, device.finger_damping = 3, device.finger_stiffness = 500;
      if (kind == 4) device.wall_damping = 0.4;
      if (kind == 5) device.rate = 4000;
      const double limit = kind == 1 ? 350 : kind == 5 ? 8000 : 2000;
      all.push_back(wall_trial(device, share * limit));
    }
  return all;
}

std::vector<WallCase> cases_of(const std::vector<WallTrial>& trials) {
  std::vector<WallCase> cases;
  for (const WallTrial& trial : trials) cases.push_back(trial.press);
  return cases;
}

// In double a settling loop ends in the same rest to what rounding leaves: 20,000 samples of a contraction forget every error but
// the last ones'. Beyond its limit a loop is chaotic (it leaves the wall and returns), so that only the verdict is compared.
TEST_F(WallMapTest, GivesTheCoresVerdicts) {
  const auto all = trials();
  const auto cases = cases_of(all);
  for (const Precision precision : {Precision::single, Precision::full}) {
    host::WallMap map("vulkan", precision);
    const auto energies = map.late_energies(cases, WALL_SAMPLES, LATE_SAMPLES);
    int settled = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double core = core_f64::late_energy(cases[i], WALL_SAMPLES, LATE_SAMPLES);
      const bool settles = core <= all[i].allowed;
      EXPECT_EQ(energies[i] <= all[i].allowed, settles) << i << ": " << energies[i] << " " << core << " of " << all[i].allowed;
      settled += settles ? 1 : 0;
    }
    EXPECT_GE(settled, 14);
    EXPECT_LE(settled, 24);
    EXPECT_GT(map.kernel_seconds(), 0);
  }
}

// What a short run leaves, before anything is forgotten or has grown: to the roundings of its samples.
TEST_F(WallMapTest, GivesTheCoresEnergies) {
  const auto cases = cases_of(trials());
  constexpr int SAMPLES = 12;
  for (const Precision precision : {Precision::single, Precision::full}) {
    const double epsilon = precision == Precision::single ? 0x1p-23 : 0x1p-52;
    const auto energies = host::WallMap("vulkan", precision).late_energies(cases, SAMPLES, SAMPLES);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double core = core_f64::late_energy(cases[i], SAMPLES, SAMPLES);
      // a sample multiplies an error by at most 1 + K T^2 / m, which is 60 for the stiffest; few such samples fit in so short a run
      // before the mass has left the wall
      const double growth = 1 + cases[i].wall_stiffness * cases[i].period * cases[i].period / cases[i].mass;
      const double once =
          cases[i].encoder_step > 0 ? 2e-2 : 256 * epsilon * growth * growth;  // a reading may be either of two steps
      EXPECT_NEAR(energies[i], core, once * core) << i;
    }
  }
}

TEST_F(WallMapTest, SplitsChangeNothing) {
  const auto few = cases_of(trials());
  std::vector<WallCase> many;
  while (many.size() < 140000) many.insert(many.end(), few.begin(), few.end());
  host::WallMap map("vulkan");
  const auto alone = map.late_energies(few, 200, 50);
  const auto together = map.late_energies(many, 200, 50);
  for (std::size_t i = 0; i < many.size(); ++i) ASSERT_EQ(together[i], alone[i % few.size()]) << i;
}

TEST_F(WallMapTest, UnknownDeviceIsRefused) { EXPECT_THROW(host::WallMap("no such device"), Error); }

}  // namespace
}  // namespace wholehand

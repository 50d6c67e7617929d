#include "sweeps/gains.h"

#include <gtest/gtest.h>

#include "app/paths.h"
#include "app/scene_reader.h"
#include "core/error.h"

namespace wholehand {
namespace {

TEST(Gains, ShippedScenesAndDefaultsPassAtEveryRate) {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  for (const double rate : {1000.0, 4000.0, 8000.0}) {
    scene.live.rate = rate;
    EXPECT_NO_THROW(refuse_unstable_gains(scene, false)) << rate;
  }
}

TEST(Gains, BeyondTheirLimitsAreRefusedWithTheRemedy) {
  const GainLimits limits = gain_limits(1000, 1);
  for (const bool is_stiffness : {true, false}) {
    Scene scene;
    double& gain = is_stiffness ? scene.live.stiffness : scene.force.k_open;
    const double limit = is_stiffness ? limits.stiffness : limits.k_open;
    gain = 0.999 * limit;
    EXPECT_NO_THROW(refuse_unstable_gains(scene, false));
    gain = 1.001 * limit;
    try {
      refuse_unstable_gains(scene, false);
      ADD_FAILURE() << "a gain beyond its limit";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      const std::string line = error.what();
      EXPECT_NE(line.find(is_stiffness ? "K_N_m" : "k_open_N_m"), std::string::npos) << line;
      EXPECT_NE(line.find("--unsafe-gains"), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos);
    }
    EXPECT_NO_THROW(refuse_unstable_gains(scene, true));
  }
}

// Twice the rate bears about twice the stiffness: K_limit = (b + B) / (T / 2) where nothing else delays.
TEST(Gains, LimitsGrowWithTheRate) {
  for (const double rate : {250.0, 1000.0, 4000.0}) {
    EXPECT_NEAR(gain_limits(2 * rate, 1).k_open / gain_limits(rate, 1).k_open, 2, 0.1);
    EXPECT_NEAR(gain_limits(2 * rate, 1).stiffness / gain_limits(rate, 1).stiffness, 2, 0.2);
  }
}

}  // namespace
}  // namespace wholehand

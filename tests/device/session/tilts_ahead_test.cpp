// SPDX-License-Identifier: MIT
// Predicted efforts of a held vessel at tilts to come, against the session that then goes there.
// sanitizers: address
#include "device/session/tilts_ahead.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/live_script.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand::device {
namespace {

Scene strong_scene() {
  Scene scene = live_scene();
  scene.strength = StrengthData{};
  return scene;
}

// The first tick that holds the vessel at a tilt of at least `from`.
std::size_t tick_from(const std::vector<Tick>& record, double from) {
  for (std::size_t k = 0; k < record.size(); ++k)
    if (is_held(record[k].state) && record[k].tilt >= from) return k;
  return record.size();
}

std::array<Triple, JOINT_COUNT> posture(const LiveScene& live, const Tick& tick, const VesselPoses& poses) {
  core_f64::Hand yielding = live.hand;
  return hand_posture(live, tick, poses, yielding).posed;
}

// Without liquid only the tilt changes on the way: the prediction is what hand_hold finds there. A leaning vessel tilts on over the
// side to which it leans, an upright one over that to which the scene pours: the script tilts to there.
TEST(TiltsAhead, AreWhatTheHandThenNeeds) {
  Scene scene = strong_scene();
  scene.vessels[0].liquid_fill = 0;
  scene.vessels[0].mass = 0.2;
  scene.vessels[0].center_of_mass = {0, 45e-3, -20e-3};  // so that the two sides are not alike
  const LiveScene live(scene);
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const VesselHistory history(scene, record);
  for (const double from : {0.0, 12.0}) {
    const std::size_t first = tick_from(record, radians(from));
    ASSERT_LT(first, record.size());
    const VesselPoses poses = history.at(first);
    const auto ahead = tilts_ahead(live, record[first], posture(live, record[first], poses));
    ASSERT_TRUE(ahead);
    const auto passed = static_cast<std::size_t>(std::ceil(from / 10));  // tilts that lie behind
    ASSERT_EQ(ahead->count, TILTS_AHEAD - passed);
    for (const double tilt : {30.0, 60.0, 90.0}) {
      const std::size_t there = tick_from(record, radians(tilt));
      ASSERT_LT(there, record.size());
      const VesselPoses then = history.at(there);
      const auto hold = hand_hold(live, record[there], posture(live, record[there], then));
      ASSERT_TRUE(hold);
      const TiltAhead& said = ahead->tilts[static_cast<std::size_t>(tilt / 10) - passed];
      EXPECT_NEAR(degrees(said.tilt), tilt, 1e-9);
      const double passing = 0.02 * hold->effort;  // the script passes a tilt within a tick
      EXPECT_NEAR(said.effort, hold->effort, passing) << tilt << " from " << from;
      EXPECT_LT(std::abs(said.effort - hold->effort), 0.2 * std::abs(said.other - hold->effort)) << "the sides are exchanged";
    }
  }
}

// The prediction starts at the present tilt and ends where the vessel is as good as empty.
TEST(TiltsAhead, BeginAtThePresentTiltAndEndWhereItIsOut) {
  const Scene scene = strong_scene();
  const LiveScene live(scene);
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const VesselHistory history(scene, record);
  const std::size_t at = tick_from(record, radians(33));
  ASSERT_LT(at, record.size());
  const VesselPoses poses = history.at(at);
  const auto ahead = tilts_ahead(live, record[at], posture(live, record[at], poses));
  ASSERT_TRUE(ahead);
  ASSERT_GT(ahead->count, 2u);
  EXPECT_NEAR(degrees(ahead->tilts[0].tilt), 40, 1e-9);
  EXPECT_LT(degrees(ahead->tilts[ahead->count - 1].tilt), 100);
  ASSERT_TRUE(ahead->hardest());
  for (std::size_t k = 0; k < ahead->count; ++k) {
    EXPECT_LE(ahead->tilts[k].effort, ahead->hardest()->effort);
    EXPECT_LE(ahead->tilts[k].other, ahead->other_worst());
  }
}

TEST(TiltsAhead, AreOfHeldVesselsAndScenesWithStrength) {
  const Scene scene = strong_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const std::size_t at = tick_from(record, 0);
  const VesselPoses poses = VesselHistory(scene, record).at(at);
  const LiveScene live(scene), weak(live_scene());
  EXPECT_FALSE(tilts_ahead(live, record[0], {}));
  EXPECT_FALSE(tilts_ahead(weak, record[at], posture(weak, record[at], poses)));
}

}  // namespace
}  // namespace wholehand::device

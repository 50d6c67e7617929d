// SPDX-License-Identifier: MIT
// Where vessels are while a session reports one at a time.
// sanitizers: address
#include "device/session/vessel_tracker.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "device/session/session.h"
#include "tests/support/live_script.h"

namespace wholehand::device {
namespace {

void expect_same(const VesselPoses& a, const VesselPoses& b, std::size_t tick) {
  for (std::size_t v = 0; v < a.size(); ++v) {
    EXPECT_EQ(a[v].place, b[v].place) << "vessel " << v << ", tick " << tick;
    EXPECT_EQ(a[v].rotation, b[v].rotation) << "vessel " << v << ", tick " << tick;
  }
}

Tick seen(int vessel, double x) {
  Tick tick;
  tick.vessel = vessel;
  tick.vessel_place = {x, 0, 0};
  tick.vessel_rotation = turned('z', x);
  return tick;
}

TEST(VesselTracker, VesselsStandWhereTheSceneHasThem) {
  const Scene scene = live_scene();
  const VesselTracker tracker(scene);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    EXPECT_EQ(tracker.poses()[v].place, scene.vessels[v].place);
    EXPECT_EQ(tracker.poses()[v].rotation, NO_ROTATION);
  }
}

TEST(VesselTracker, AVesselStaysWhereItWasSeenLast) {
  VesselTracker tracker(live_scene());
  tracker.follow(seen(1, 0.3));
  tracker.follow(seen(0, 0.7));
  tracker.follow(seen(-1, 9));
  EXPECT_EQ(tracker.poses()[1].place, (Triple{0.3, 0, 0}));
  EXPECT_EQ(tracker.poses()[1].rotation, turned('z', 0.3));
  EXPECT_EQ(tracker.poses()[0].place, (Triple{0.7, 0, 0}));
}

TEST(VesselHistory, TellsAtAnyTickWhatTheTrackerHadThen) {
  const Scene scene = live_scene();
  std::vector<Tick> ticks;
  const int vessels[] = {-1, 0, 0, 0, -1, 1, 1, 0, 1, -1, -1, 0};
  for (std::size_t k = 0; k < std::size(vessels); ++k) ticks.push_back(seen(vessels[k], 0.1 * static_cast<double>(k + 1)));
  const VesselHistory history(scene, ticks);
  VesselTracker tracker(scene);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    tracker.follow(ticks[k]);
    expect_same(history.at(k), tracker.poses(), k);
  }
  expect_same(history.at(0), VesselTracker(scene).poses(), 0);  // asked again, out of order
  const std::size_t last = ticks.size() - 1;
  const VesselHistory part(scene, std::span(ticks).first(last));
  expect_same(part.at(last), history.at(last - 1), last);  // what follows its ticks is not known
}

TEST(VesselHistory, OfAWholeSessionIsTheSessions) {
  const Scene scene = live_scene();
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  Session session(scene, own_gap(scene.hand));
  std::vector<Tick> ticks(static_cast<std::size_t>(script.seconds() * script.rate));
  std::vector<VesselPoses> poses;
  for (std::size_t n = 0; n < ticks.size(); ++n) {
    const auto number = static_cast<std::int64_t>(n);
    session.step(script.at(number), number, ticks[n]);
    poses.push_back(session.poses());
  }
  const VesselHistory history(scene, ticks);
  for (std::size_t n = 0; n < ticks.size(); ++n) expect_same(history.at(n), poses[n], n);
  EXPECT_EQ(history.at(ticks.size() - 1)[0].rotation, NO_ROTATION) << "it slipped back to where it stood";
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(history.at(ticks.size() - 1)[0].place[k], scene.vessels[0].place[k], 1e-6);  // less a tick of its way
}

}  // namespace
}  // namespace wholehand::device

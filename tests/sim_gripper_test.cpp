// The simulated user in simulated time: whole sessions, everything up to the wire.
// sanitizers: address
#include "device/sim_gripper.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

#include "app/paths.h"
#include "app/scene_reader.h"
#include "core/error.h"
#include "device/haptic_loop.h"
#include "device/sim_user.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

struct SimSession {
  std::vector<Tick> ticks;
  LoopReport report;
};

SimSession play(const Scene& scene, std::uint64_t seed, double seconds = 120) {
  SimSession session;
  const auto gripper = open_sim(scene, seed);
  Session core(scene, gripper->limits().gap);
  LoopOptions options;
  options.is_simulated = true;
  options.seconds = seconds;
  HapticLoop loop(
      scene.live, *gripper, core,
      [&session](const Tick& tick) {
        session.ticks.push_back(tick);
        return true;
      },
      options);
  const std::atomic<bool> stop{false};
  loop.run(stop);
  session.report = loop.report();
  return session;
}

Scene shipped_live() { return read_scene_file(find_scene("mixing_board")); }

Scene beside_each_other(Scene scene) {
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) scene.vessels[v].place = {0.24 * static_cast<double>(v), 0, 0};
  return scene;
}

// The states that a vessel goes through while it is in the hand, each once a run of it.
std::vector<SessionState> states_of(const SimSession& session, int vessel) {
  std::vector<SessionState> states;
  for (const Tick& tick : session.ticks) {
    if (tick.vessel != vessel) continue;
    if (states.empty() || states.back() != tick.state) states.push_back(tick.state);
  }
  return states;
}

TEST(SimGripper, CompletesTheTaskOfTheShippedScene) {
  const Scene scene = shipped_live();
  for (const std::uint64_t seed : {1u, 7u}) {
    const SimSession session = play(scene, seed);
    const Tick& last = session.report.last;
    EXPECT_EQ(session.report.fault, Fault::none);
    EXPECT_EQ(last.state, SessionState::released) << "the user is done before the time is over";
    EXPECT_TRUE(last.task_done);
    EXPECT_EQ(last.grasps, 4);
    EXPECT_EQ(last.lost, 0);
    EXPECT_EQ(last.destinations, 1);
    double arrived = 0;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      EXPECT_EQ(last.spilt[v], 0) << v;
      arrived += last.arrived[v];
    }
    double wanted = 0;
    for (const auto& [liquid, volume] : scene.task->amounts) wanted += volume;
    EXPECT_NEAR(arrived, wanted, 3 * scene.task->tolerance);
  }
}

// Lift, tilt, pour (the tilt maintained meanwhile), return, on each of the three beakers; then the fingers open and the vessel goes back.
TEST(SimGripper, EachBeakerIsLiftedTiltedPouredAndReturned) {
  const Scene scene = shipped_live();
  const SimSession session = play(scene, 3);
  for (const int vessel : {1, 2, 3}) {
    const std::vector<SessionState> states = states_of(session, vessel);
    const std::set<SessionState> seen(states.begin(), states.end());
    for (const SessionState state : {SessionState::lift, SessionState::tilt, SessionState::maintain, SessionState::slipped})
      EXPECT_TRUE(seen.count(state)) << vessel << " was never in state " << SESSION_STATE_NAMES[static_cast<std::size_t>(state)];
    double poured = 0, highest = 0, steepest = 0;
    Triple place{};
    for (const Tick& tick : session.ticks) {
      if (tick.vessel != vessel) continue;
      highest = std::max(highest, tick.vessel_place[1]);
      steepest = std::max(steepest, tick.tilt);
      poured = tick.arrived[vessel];
      place = tick.vessel_place;
    }
    EXPECT_GT(highest, 0.05) << vessel;
    EXPECT_GT(steepest, radians(40)) << vessel;
    EXPECT_GT(poured, 40e-6) << vessel;
    // the last tick of its way is up to a period short of the end: 10 (T / 0.5 s)^3 of a centimetre
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(place[k], scene.vessels[vessel].place[k], 1e-8) << "back where it stood";
  }
}

TEST(SimGripper, ShowsEveryVesselOfASceneWithoutATask) {
  const SimSession session = play(beside_each_other(three_beakers()), 1);
  EXPECT_EQ(session.report.fault, Fault::none);
  EXPECT_EQ(session.report.last.grasps, 3);
  EXPECT_EQ(session.report.last.lost, 0);
  for (const int vessel : {0, 1, 2}) {
    double steepest = 0;
    for (const Tick& tick : session.ticks)
      if (tick.vessel == vessel) steepest = std::max(steepest, tick.tilt);
    EXPECT_NEAR(steepest, radians(75), radians(1)) << vessel;
  }
}

// A user who holds F_base and 3 N: the paper's stopped tightening at 3.76 +- 0.08 N.
TEST(SimGripper, HoldsItsGripForceWithinATremor) {
  const SimSession session = play(shipped_live(), 2);
  int held = 0;
  double sum = 0;
  for (const Tick& tick : session.ticks) {
    if (tick.state != SessionState::maintain) continue;
    sum += tick.user_force;
    ++held;
    EXPECT_NEAR(tick.user_force, 3.8, 0.6) << tick.number;
  }
  ASSERT_GT(held, 1000);
  EXPECT_NEAR(sum / held, 3.8, 0.05);
}

TEST(SimGripper, TheSameSeedGivesTheSameSessionToTheBitAndAnotherAnother) {
  const Scene scene = shipped_live();
  const SimSession a = play(scene, 5, 6), b = play(scene, 5, 6), c = play(scene, 6, 6);
  ASSERT_EQ(a.ticks.size(), b.ticks.size());
  bool differs = false;
  for (std::size_t k = 0; k < a.ticks.size(); ++k) {
    ASSERT_EQ(a.ticks[k].device.position, b.ticks[k].device.position) << k;
    ASSERT_EQ(a.ticks[k].written.grip, b.ticks[k].written.grip) << k;
    differs = differs || a.ticks[k].written.grip != c.ticks[k].written.grip;
  }
  EXPECT_TRUE(differs);
}

TEST(SimGripper, WorksAtEveryRateAndWithAMappedGapAndALeftHand) {
  for (const double rate : {1000.0, 4000.0}) {
    Scene scene = beside_each_other(three_beakers());
    scene.vessels.resize(1);
    scene.live.rate = rate;
    EXPECT_EQ(play(scene, 1).report.last.lost, 0) << rate;
    scene.device.has_gap = true;
    scene.device.gap = {0, 25e-3};
    scene.device.axes = {"z", "-x", "-y"};
    scene.device.origin = {0.1, 0.2, -0.1};
    scene.device.workspace_scale = 2;
    const SimSession mapped = play(scene, 1);
    EXPECT_EQ(mapped.report.fault, Fault::none) << rate;
    EXPECT_EQ(mapped.report.last.grasps, 1) << rate;
    scene.hand.handedness = Handedness::left;
    EXPECT_EQ(play(scene, 1).report.last.grasps, 1) << rate;
  }
}

// A band of a hundredth of a millimetre: every grip is lost at once; after three attempts the user gives up instead of going on for ever.
TEST(SimGripper, GivesUpWhatCannotBeHeld) {
  Scene scene = beside_each_other(three_beakers());
  scene.vessels.resize(1);
  scene.force.base = 60;
  scene.force.max = 60;
  scene.live.slip = 1e-4;
  const SimSession session = play(scene, 1);
  EXPECT_EQ(session.report.last.state, SessionState::released);
  EXPECT_LT(session.report.ticks, 60000) << "it ends by itself";
  EXPECT_GE(session.report.last.grasps, 3);
}

TEST(SimGripper, ASceneWithNothingToDoIsRefused) {
  Scene scene = three_beakers();
  scene.vessels.resize(1);
  scene.vessels[0] = scaled(scene.vessels[0], 5);  // no hand spans it
  try {
    open_sim(scene, 1);
    ADD_FAILURE() << "it opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("nothing to do"), std::string::npos) << error.what();
  }
}

TEST(SimUser, PlansWhatTheTaskAsksFor) {
  const std::vector<SimJob> jobs = plan_sim_jobs(shipped_live());
  ASSERT_EQ(jobs.size(), 4u);
  EXPECT_EQ(jobs[0].kind, SimJob::Kind::carry) << "the tutorial first";
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_EQ(jobs[k].kind, SimJob::Kind::pour);
    EXPECT_EQ(jobs[k].vessel, static_cast<int>(k));
  }
  EXPECT_DOUBLE_EQ(jobs[1].amount, 80e-6);
  EXPECT_DOUBLE_EQ(jobs[2].grip.height, 42e-3) << "of the guidance point";
}

}  // namespace
}  // namespace wholehand

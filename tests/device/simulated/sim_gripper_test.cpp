// SPDX-License-Identifier: MIT
// The simulated user in simulated time: whole sessions, everything up to the wire.
// sanitizers: none
#include "device/simulated/sim_gripper.h"
#include "core/held.h"
#include "core/joints.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <set>

#include "base/text/error.h"
#include "core/people/participant.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/loop/haptic_loop.h"
#include "device/session/hand_view.h"
#include "device/simulated/sim_user.h"
#include "sweeps/grips/hand_nodes.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

struct SimSession {
  std::vector<Tick> ticks;
  LoopReport report;
};

SimSession play(const Scene& scene, std::uint64_t seed, double seconds = 120, std::unique_ptr<Gripper> gripper = nullptr) {
  SimSession session;
  if (!gripper) gripper = open_sim(scene, seed);
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
    EXPECT_EQ(session.report.release, ReleaseResult::no_force) << "there is no device";
    EXPECT_EQ(last.state, SessionState::released) << "the user is done before the time is over";
    EXPECT_TRUE(last.task_done);
    EXPECT_EQ(last.grasps, 4);
    EXPECT_EQ(last.lost, 0);
    EXPECT_EQ(last.destinations, 1);
    double arrived = 0;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      EXPECT_EQ(last.spilled[v], 0) << v;
      arrived += last.arrived[v];
    }
    double wanted = 0;
    for (const auto& [liquid, volume] : scene.task->amounts) wanted += volume;
    EXPECT_NEAR(arrived, wanted, 3 * scene.task->tolerance);
  }
}

// How far a point is from the glass of the target, a cylinder of TARGET_WALL that stands on the table; negative inside of it.
double distance_to_target(const TaskData& task, double table, core_f64::Vec3 p) {
  const auto box = [](double x, double y, double half_x, double half_y) {  // from its middle
    const double dx = std::abs(x) - half_x, dy = std::abs(y) - half_y;
    return std::hypot(std::max(dx, 0.0), std::max(dy, 0.0)) + std::min(0.0, std::max(dx, dy));
  };
  const Triple& mouth = task.target_place;
  const double r = std::hypot(p.x - mouth[0], p.z - mouth[2]), inner = 0.5 * task.target_diameter, half = 0.5 * TARGET_WALL;
  const double wall = box(r - inner - half, p.y - 0.5 * (mouth[1] + table), half, 0.5 * (mouth[1] - table));
  return std::min(wall, box(r, p.y - table - half, inner, half));
}

// What moves with the held vessel, in its frame, and its least distance from the target's glass over all ticks. A tick is passed
// over only where what has moved since it was last measured cannot have come nearer than that.
struct HeldShape {
  static constexpr double REACH = 0.3;  // m: nothing that is held is further from the vessel's origin
  static constexpr double FAR = 0.02;   // m: what stays further off need not be known
  std::vector<HeldBall> balls;
  double least = FAR, last = -1, moved = 0;  // m
  std::int64_t least_at = -1;
  VesselPose before;

  void follow(const TaskData& task, double table, const Tick& tick) {
    double squares = 0;
    for (std::size_t k = 0; k < 9; ++k) squares += std::pow(tick.vessel_rotation[k] - before.rotation[k], 2);
    moved += glm::length(to_vec3(tick.vessel_place) - to_vec3(before.place)) + REACH * std::sqrt(squares);
    before = {tick.vessel_place, tick.vessel_rotation};
    if (last - moved > least) return;
    last = 1;
    moved = 0;
    const auto place = to_vec3(tick.vessel_place);
    const auto rotation = to_mat3(tick.vessel_rotation);
    for (const HeldBall& ball : balls)
      last = std::min(last, distance_to_target(task, table, place + rotation * ball.place) - ball.radius);
    if (last >= least) return;
    least = last;
    least_at = tick.number;
  }
};

// The hand's 24 points as drawn: of a hand that holds, in the vessel's frame; else in the world.
std::vector<HeldBall> hand_balls(const Scene& scene, const HandView& hand, const VesselPose& frame) {
  std::vector<HeldBall> balls;
  const auto back = glm::transpose(to_mat3(frame.rotation));
  for (int f = 0; f < FINGER_COUNT; ++f)
    for (int k = 0; k < finger_joints(f); ++k)
      balls.push_back({back * (to_vec3(hand.proxies[finger_start(f) + k]) - to_vec3(frame.place)),
                       scene.hand.scale * scene.hand.fingers[f].radii[k]});
  return balls;
}

struct Clearance {
  HeldShape vessel, hand;
};
Clearance clearance(const Scene& scene, const SimSession& session) {
  const LiveScene live(scene);
  const TaskData& task = *scene.task;
  const double table = table_height(scene);
  VesselTracker tracker(scene);
  Clearance all;
  int grasps = 0;
  for (const Tick& tick : session.ticks) {
    tracker.follow(tick);
    if (!is_held(tick.state)) {
      const double near = distance_to_target(task, table, to_vec3(tick.middle)) - 0.2;  // further than that is no point of a hand
      if (near > all.hand.least) continue;
      for (const HeldBall& ball : hand_balls(scene, hand_view(live, tick, tracker.poses()), {}))
        all.hand.least = std::min(all.hand.least, distance_to_target(task, table, ball.place) - ball.radius);
      continue;
    }
    if (tick.grasps > grasps) {
      grasps = tick.grasps;
      all.vessel.balls = held_vessel(scene.vessels[tick.vessel], {}, Handedness::right);
      all.hand.balls = hand_balls(scene, hand_view(live, tick, tracker.poses()), {tick.vessel_place, tick.vessel_rotation});
      all.vessel.last = all.hand.last = -1;
    }
    all.vessel.follow(task, table, tick);
    all.hand.follow(task, table, tick);
  }
  EXPECT_EQ(grasps, 4);
  return all;
}

// Both hands. The glass is sampled every 4 mm at most: what lies between samples is within 2 mm of one, so it cannot be in the wall.
TEST(SimGripper, KeepsVesselAndHandClearOfTheTargetsWall) {
  Scene scene = shipped_live();
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    scene.hand.handedness = handedness;
    const SimSession session = play(scene, 1);
    const Tick& last = session.report.last;
    const Clearance all = clearance(scene, session);
    EXPECT_GT(all.vessel.least, 4e-3) << "at " << static_cast<double>(all.vessel.least_at) / scene.live.rate << " s";
    EXPECT_GT(all.hand.least, 4e-3) << "at " << static_cast<double>(all.hand.least_at) / scene.live.rate << " s";
    EXPECT_LT(all.vessel.least, HeldShape::FAR) << "it is poured from near";
    EXPECT_EQ(last.grasps, 4);
    EXPECT_EQ(last.lost, 0);
    EXPECT_TRUE(last.task_done);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) EXPECT_EQ(last.spilled[v], 0) << v;
  }
}

// Eight vertices, and yet no place on the sides is far from a point; of points that coincide nearly, one is kept.
TEST(HeldVessel, AMeshIsSampledBetweenItsVertices) {
  const Triple low{-0.03, 0, -0.02}, high{0.05, 0.1, 0.04};
  const auto balls = held_vessel(vessel_of_mesh("box", box_mesh(low, high), 0), {}, Handedness::right);
  EXPECT_LT(balls.size(), 20000u);
  constexpr int STEPS = 7;
  for (int axis = 0; axis < 3; ++axis)
    for (const Triple& side : {low, high})
      for (int i = 0; i <= STEPS; ++i)
        for (int k = 0; k <= STEPS; ++k) {
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          Triple place = side;
          place[u] = low[u] + (high[u] - low[u]) * i / STEPS;
          place[v] = low[v] + (high[v] - low[v]) * k / STEPS;
          double nearest = 1;
          for (const HeldBall& ball : balls) nearest = std::min(nearest, glm::length(ball.place - to_vec3(place)));
          EXPECT_LT(nearest, 5e-3) << place[0] << ' ' << place[1] << ' ' << place[2];
        }
}

// Lift, tilt, pour (the tilt maintained meanwhile), return, on each of the three beakers; then the fingers open and the vessel goes
// back.
TEST(SimGripper, EachBeakerIsLiftedTiltedPouredAndReturned) {
  const Scene scene = shipped_live();
  const SimSession session = play(scene, 3);
  for (const int vessel : {1, 2, 3}) {
    const std::vector<SessionState> states = states_of(session, vessel);
    const std::set<SessionState> seen(states.begin(), states.end());
    for (const SessionState state : {SessionState::lift, SessionState::tilt, SessionState::maintain, SessionState::let_go})
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
    // the last tick of its way is up to a period short of the end: 10 (T / 0.5 s)^3 of a centimeter
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

// The whole force on a finger is what the person wants for this vessel, and the rise that keeps the margin where the torque opens
// the fingers. A control error of 2 % wanders slowly: the mean over some seconds, of which it changes a few times each, is off by
// less than 1 %, and single ticks by less than five deviations.
TEST(SimGripper, HoldsTheForceThatThePersonWants) {
  const Scene scene = shipped_live();
  const Traits traits = Participant(scene.people).person().traits;
  const LiveScene live(scene);
  const SimSession session = play(scene, 2);
  for (const int vessel : {1, 2, 3}) {
    const LiveVessel& held = live.vessels[static_cast<std::size_t>(vessel)];
    const double mass = core_f64::load_with(held.vessel, scene.liquid->density * held.volume, 0, 0).mass;
    const double first = first_force(traits, mass * scene.gravity);
    double sum = 0, wanted = 0;
    int ticks = 0;
    for (const Tick& tick : session.ticks) {
      if (tick.state != SessionState::maintain || tick.vessel != vessel) continue;
      const double goal = loaded_force(traits, first, tick.feedback - tick.user_force);
      EXPECT_NEAR(tick.feedback, goal, 5 * 0.02 * goal + 0.1) << tick.number << ": the liquid runs, and a reaction comes late";
      sum += tick.feedback;
      wanted += goal;
      ++ticks;
    }
    ASSERT_GT(ticks, 1000);
    EXPECT_NEAR(sum / wanted, 1, 0.02) << vessel;
  }
}

// A person who reckons with more friction than there is lets the vessel slip, feels it, and squeezes one reaction later.
TEST(SimGripper, SqueezesAReactionAfterASlip) {
  Scene scene = beside_each_other(shipped_live());
  scene.task.reset();
  scene.vessels.pop_back();  // the last one takes more than the gripper's 8 N
  scene.live.slide = true;
  scene.force.friction = 0.4;  // the median person reckons with 0.6, and a margin of a quarter
  scene.force.torsion = 0.02;
  const Traits traits = Participant(scene.people).grasp(0);
  const SimSession session = play(scene, 1);
  EXPECT_EQ(session.report.last.lost, 0);
  int slips = 0, lifted = 0;
  const std::vector<Tick>& ticks = session.ticks;
  for (std::size_t k = 1; k < ticks.size(); ++k) {
    if (!(ticks[k].slip_speed > FELT_SLIP) || ticks[k - 1].slip_speed > FELT_SLIP) continue;
    ++slips;
    const auto after = [&](double seconds) { return ticks.at(k + static_cast<std::size_t>(1e3 * seconds)); };
    const Tick caught = after(traits[Trait::reaction] + 2 * traits[Trait::response]);
    EXPECT_EQ(caught.slip_speed, 0) << k;
    EXPECT_GT(caught.safety_margin, 0) << k;
    if (ticks[k].state != SessionState::lift) continue;
    ++lifted;
    // tremor moves the force before, the squeeze after the reaction
    const double before = after(0.95 * traits[Trait::reaction]).user_force - ticks[k].user_force;
    EXPECT_LT(std::abs(before), 0.2 * (caught.user_force - ticks[k].user_force)) << k;
  }
  EXPECT_GT(slips, 3);
  EXPECT_EQ(lifted, 3);
}

// The same task by other people, each with a hand and habits of their own; and each person again to the bit.
TEST(SimGripper, PeopleDifferAndEachIsTheSameAgain) {
  const auto session_of = [](std::uint64_t number) {
    Scene scene = shipped_live();
    const Participant person(scene.people, 1, number, Experiment::live);
    scene.hand = person.hand(scene.hand);
    return play(scene, 1, 30, open_sim(scene, 1, person));
  };
  const auto force_of = [](const SimSession& session) {
    for (const Tick& tick : session.ticks)
      if (tick.vessel == 1 && tick.state == SessionState::tilt) return tick.user_force;
    return 0.0;
  };
  const SimSession a = session_of(3), again = session_of(3), b = session_of(4);
  ASSERT_EQ(a.ticks.size(), again.ticks.size());
  for (std::size_t k = 0; k < a.ticks.size(); ++k) ASSERT_EQ(a.ticks[k].written.grip, again.ticks[k].written.grip) << k;
  EXPECT_GT(force_of(a), 0);
  EXPECT_GT(std::abs(force_of(a) - force_of(b)), 0.1);
  EXPECT_NE(a.ticks.front().gap, b.ticks.front().gap) << "their hands open differently";
}

// Every person equals the mean person, and all grasps are alike.
TEST(SimGripper, WithoutScatterEverybodyIsOnePerson) {
  Scene one_vessel = beside_each_other(three_beakers());
  one_vessel.vessels.resize(1);
  one_vessel.people.scatter = 0;
  const auto session_of = [](Scene scene, std::uint64_t seed, std::uint64_t number) {
    const Participant person(scene.people, seed, number, Experiment::sessions);
    scene.hand = person.hand(scene.hand);
    return play(scene, 1, 12, open_sim(scene, 1, person));
  };
  const SimSession a = session_of(one_vessel, 1, 0), b = session_of(one_vessel, 9, 77);
  ASSERT_EQ(a.ticks.size(), b.ticks.size());
  for (std::size_t k = 0; k < a.ticks.size(); ++k) ASSERT_EQ(a.ticks[k].written.grip, b.ticks[k].written.grip) << k;
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

// A band of a hundredth of a millimeter: every grip is lost at once; after three attempts the user gives up instead of going on for
// ever.
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
}  // namespace wholehand::device

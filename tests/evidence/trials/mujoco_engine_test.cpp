// SPDX-License-Identifier: MIT
// Trials of grips: what is asked and what is answered.
// sanitizers: none
#include "evidence/trials/mujoco_engine.h"
#include "core/hand_size.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "base/text/error.h"
#include "core/grip_effort.h"
#include "core/joints.h"
#include "core/load.h"
#include "core/reader/reader.h"
#include "core/vectors.h"
#include "evidence/trials/grip_trial.h"
#include "sweeps/grips/holding.h"
#include "sweeps/grips/report.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// A beaker and a flask, each held with the whole hand.
const GripInput BEAKER{0.0942827124, 0, 0.250430391, 0.172007776, 0, 1};
const GripInput FLASK{0.106782336, 0, 0.170110667, -1.27048768, 0, 1};

std::vector<TrialCase> fill_tilt(double fill, const std::vector<double>& degrees) {
  std::vector<TrialCase> cases;
  for (const double tilt : degrees) cases.push_back({TrialProtocol::fill_tilt, fill, radians(tilt), 0, 0});
  return cases;
}

// Short holds: what is tested here needs no long ones.
TrialSettings quick(TrialModel model = TrialModel::hand) {
  TrialSettings settings;
  settings.model = model;
  settings.hold_time = 0.2;
  settings.push_time = 0.5;
  settings.tilt_rate = radians(100);
  return settings;
}

void expect_same(const TrialOutcome& a, const TrialOutcome& b) {
  EXPECT_EQ(a.held, b.held);
  EXPECT_EQ(a.discarded, b.discarded);
  EXPECT_EQ(a.reason, b.reason);
  for (const auto& [x, y] :
       {std::pair{a.slip, b.slip}, {a.move, b.move}, {a.turn, b.turn}, {a.when, b.when}, {a.tilt_lost, b.tilt_lost}})
    EXPECT_EQ(x, y);
}

// What `check` says of a vessel.
std::string usage_of(const TrialEngine& engine, std::size_t vessel) {
  try {
    engine.check(vessel);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "none";
}

// Grips of three_beakers whose trials once contradicted their efforts (docs/trials-model.md).
struct Grasped {
  std::size_t vessel;
  GripInput grip;
  double fill;
};
const Grasped SPHERE{1, {0.082, 0, 0.2617993878, -0.5934119457, 0, 1}, 0.75},
    SPHERE_TOO{1, {0.07633333333, 0, 0, -0.872664626, 0, 1}, 0.75},
    RIM{0, {0.100047619, 0, -0.3490658504, -1.291543646, 0, 1}, 0.25},
    CORNER{2, {0.1103611111, 0, 0.1745329252, -1.431169987, 0, 1}, 1};

// With the hand and the strengths of those trials.
Scene tried_scene() {
  Scene scene = read_scene_file(WHOLEHAND_SOURCE_DIR "/examples/scenes/three_beakers.toml");
  scene.hand = paper_hand();
  scene.strength->by_opening = false;
  return scene;
}

class MujocoEngine : public testing::Test {
 protected:
  Scene scene_ = tried_scene();
  std::unique_ptr<Evaluator> evaluator_ = make_core_evaluator(scene_);

  std::vector<TrialOutcome> run(std::size_t vessel, const GripInput& grip, const std::vector<TrialCase>& cases,
                                const TrialSettings& settings = quick(), std::vector<TrialTrack>* tracks = nullptr) const {
    return make_mujoco_engine(scene_, *evaluator_, settings)->run(vessel, grip, cases, tracks);
  }

  // Contacts of kernel 9.
  std::vector<core_f64::ContactPoint> contacts_of(const Grasped& one, GripResult& result) const {
    evaluator_->grip(one.vessel, one.grip, result);
    std::vector<core_f64::ContactPoint> contacts;
    for (const GripContact& found : evaluator_->contacts(one.vessel, result))
      contacts.push_back({to_vec3(found.point), to_vec3(found.normal), found.digit, found.is_tip});
    return contacts;
  }

  // In place of the vessel a small flat wall for each contact, which is what effort knows of it. The outcome of the last tilt.
  TrialOutcome run_on_walls(const Grasped& one, const std::vector<double>& degrees) const {
    constexpr double HALF = 6e-3, THICK = 5e-3;  // m
    GripResult result;
    BodyForm walls;
    for (const auto& [place, normal, digit, is_tip] : contacts_of(one, result)) {
      const std::string name = fmt::format("wall{}", walls.names.size());
      const core_f64::Vec3 middle = place + THICK * normal;
      walls.geoms += fmt::format("<geom name=\"{}\" type=\"box\" pos=\"{} {} {}\" size=\"{} {} {}\" zaxis=\"{} {} {}\"/>\n", name,
                                 middle.x, middle.y, middle.z, HALF, HALF, THICK, normal.x, normal.y, normal.z);
      walls.names.push_back(name);
    }
    const TrialSettings settings;
    std::vector<double> tilts;
    for (const double tilt : degrees) tilts.push_back(radians(tilt));
    GripTrial trial(load_mujoco(), scene_, *evaluator_, settings, one.vessel, walls, one.grip);
    return trial.tilt(one.fill, tilts, nullptr, nullptr).back();
  }

  // Upright, of the contacts of kernel 9 and of others.
  double effort_of(const Grasped& one, const std::vector<core_f64::ContactPoint>& others = {}) const {
    GripResult result;
    std::vector<core_f64::ContactPoint> contacts = contacts_of(one, result);
    contacts.insert(contacts.end(), others.begin(), others.end());
    const StateResult state = evaluator_->state(one.vessel, one.grip, result, evaluator_->liquid(one.vessel, one.fill, 0), 0);
    const core_f64::Wrench load =
        core_f64::wrench_at(to_vec3(state.center_of_mass), core_f64::Vec3(0, -state.mass * scene_.gravity, 0));
    const core_f64::HandStrength hand = core_f64::load_strength(scene_, result);
    return core_f64::EffortSolver(contacts, hand, core_f64::contacts_center(contacts)).solve(load).effort;
  }
};

TEST_F(MujocoEngine, AWholeHandHoldsABeakerThroughItsTilts) {
  for (const TrialModel model : {TrialModel::hand, TrialModel::contacts}) {
    std::vector<TrialTrack> tracks;
    const auto found = run(0, BEAKER, fill_tilt(0.5, {0, 30, 60}), quick(model), &tracks);
    ASSERT_EQ(found.size(), 3u);
    ASSERT_EQ(tracks.size(), 3u);
    for (const TrialOutcome& outcome : found) {
      EXPECT_TRUE(outcome.held);
      EXPECT_EQ(outcome.reason, TrialReason::none);
      EXPECT_LT(outcome.slip, 2e-3);
      EXPECT_LT(outcome.move, 2e-3);
      EXPECT_LT(outcome.turn, radians(2));
    }
    // settle 0.5 s, then 0.2 s each and 0.3 s for each turn
    EXPECT_NEAR(tracks[0].frames.back().time, 0.7, 0.021);
    EXPECT_NEAR(tracks[2].frames.back().time, 1.7, 0.021);
    EXPECT_NEAR(tracks[2].frames.back().up[1], 0.5, 1e-9);
    const PosedHand posed = evaluator_->posed(0, BEAKER).value();
    for (std::size_t j = 0; j < posed.size(); ++j) EXPECT_LT(distance(tracks[2].frames.back().joints[j], posed[j]), 3e-3) << j;
  }
}

// On a wall of flat sides, with normals that are off by 2.8 degrees, these fingers slid off at once.
TEST_F(MujocoEngine, ARoundWallHoldsWhatItsEffortSays) {
  for (const Grasped& one : {SPHERE, SPHERE_TOO}) {
    const auto found = run(one.vessel, one.grip, fill_tilt(one.fill, {0}), TrialSettings{});
    EXPECT_LT(effort_of(one), 0.6);
    EXPECT_TRUE(found.front().held);
    EXPECT_LT(found.front().slip, 1e-3);
  }
}

// A limit of effort: a thumb on the edge of a rim, and one on the upper half of a sphere. As it goes on the normal turns, and it
// slides off. Where each contact has a flat wall of its own, with the same normal, it stays, as it does in the model `contacts`,
// whose balls stay on their lines.
TEST_F(MujocoEngine, AThumbSlidesOffARimThoughTheEffortIsSmall) {
  EXPECT_NEAR(effort_of(RIM), 0.46, 0.01);
  EXPECT_NEAR(effort_of(SPHERE_TOO), 0.57, 0.01);
  TrialSettings contacts;
  contacts.model = TrialModel::contacts;
  for (const auto& [one, tilts] : {std::pair{RIM, std::vector<double>{0}}, {SPHERE_TOO, {0, 50}}}) {
    EXPECT_FALSE(run(one.vessel, one.grip, fill_tilt(one.fill, tilts), TrialSettings{}).back().held);
    EXPECT_TRUE(run(one.vessel, one.grip, fill_tilt(one.fill, tilts), contacts).back().held);
    EXPECT_TRUE(run_on_walls(one, tilts).held);
  }
}

// Another: a sphere of the hand that touches two walls, here the thumb in the corner under a neck, is one contact of kernel 9. With
// the other wall the effort is finite, and both models hold. On the first wall alone it slides.
TEST_F(MujocoEngine, AThumbInACornerTouchesTwoWalls) {
  EXPECT_EQ(effort_of(CORNER), std::numeric_limits<double>::infinity());
  const Triple thumb = evaluator_->posed(CORNER.vessel, CORNER.grip).value()[THUMB_TIP];
  const double radius = scene_.hand.fingers[0].radii[3], neck = 0.017;
  ASSERT_NEAR(thumb[0] + radius, -neck, scene_.hand.contact_tolerance);  // it is at z = 0, beside the neck
  const core_f64::ContactPoint other{core_f64::Vec3(-neck, thumb[1], 0), core_f64::Vec3(1, 0, 0), 0};
  EXPECT_NEAR(effort_of(CORNER, {other}), 0.23, 0.01);
  EXPECT_GT(run_on_walls(CORNER, {0}).slip, 2e-3);
  for (const TrialModel model : {TrialModel::hand, TrialModel::contacts}) {
    TrialSettings settings;
    settings.model = model;
    const auto found = run(CORNER.vessel, CORNER.grip, fill_tilt(CORNER.fill, {0}), settings);
    EXPECT_TRUE(found.front().held);
    EXPECT_LT(found.front().slip, 0.5e-3);
  }
}

TEST_F(MujocoEngine, ALossIsTold) {
  TrialSettings heavy = quick();
  heavy.mass = 20;
  std::vector<TrialTrack> tracks;
  const auto found = run(0, BEAKER, fill_tilt(0.5, {0, 30}), heavy, &tracks);
  EXPECT_FALSE(found[0].held);
  EXPECT_FALSE(found[0].discarded);
  EXPECT_EQ(found[0].reason, TrialReason::release);
  EXPECT_GT(found[0].when, 0);
  EXPECT_TRUE(found[0].move >= heavy.largest_move || found[0].turn >= heavy.largest_turn);
  EXPECT_EQ(found[1].reason, TrialReason::earlier);
  EXPECT_FALSE(found[1].held);
  EXPECT_GT(tracks[0].frames.size(), 1u);
}

// Whoever else is at work, and whatever was asked before.
TEST_F(MujocoEngine, TheSameQuestionsHaveTheSameBits) {
  const auto engine = make_mujoco_engine(scene_, *evaluator_, quick());
  const auto first = engine->run(0, BEAKER, fill_tilt(0.5, {0, 30}));
  const auto other = engine->run(1, FLASK, fill_tilt(0.25, {0, 30}));
  std::vector<TrialOutcome> a, b;
  std::thread one([&] { a = engine->run(0, BEAKER, fill_tilt(0.5, {0, 30})); });
  std::thread two([&] { b = engine->run(1, FLASK, fill_tilt(0.25, {0, 30})); });
  one.join();
  two.join();
  for (std::size_t k = 0; k < 2; ++k) {
    expect_same(a[k], first[k]);
    expect_same(b[k], other[k]);
  }
}

TEST_F(MujocoEngine, OtherTiltsAndFillsAndTheirOrderChangeNothing) {
  const auto alone = run(0, BEAKER, fill_tilt(0.5, {0, 30}));
  auto cases = fill_tilt(0.5, {60, 30, 0});
  cases.insert(cases.begin(), {TrialProtocol::fill_tilt, 0.25, 0, 0, 0});
  cases.push_back({TrialProtocol::six_forces, 0.5, 0, 2, 1});
  const auto among = run(0, BEAKER, cases);
  expect_same(among[3], alone[0]);
  expect_same(among[2], alone[1]);
}

// A left hand's trial is the right hand's in the mirrored scene.
TEST_F(MujocoEngine, ALeftHandIsTheMirroredRightOne) {
  const auto right = run(0, BEAKER, fill_tilt(0.5, {0, 30}));
  std::vector<TrialTrack> tracks, mirrored_tracks;
  run(0, BEAKER, fill_tilt(0.5, {0}), quick(), &tracks);
  Scene left = scene_;
  left.hand.handedness = Handedness::left;
  const auto evaluator = make_core_evaluator(left);
  GripInput grip = BEAKER;
  grip.azimuth = PI - BEAKER.azimuth;
  const auto engine = make_mujoco_engine(left, *evaluator, quick());
  const auto found = engine->run(0, grip, fill_tilt(0.5, {0, 30}));
  engine->run(0, grip, fill_tilt(0.5, {0}), &mirrored_tracks);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(found[k].held, right[k].held);
    EXPECT_NEAR(found[k].move, right[k].move, 1e-4);
  }
  const TrialFrame &a = tracks[0].frames.back(), &b = mirrored_tracks[0].frames.back();
  EXPECT_NEAR(a.place[0], -b.place[0], 1e-4);
  EXPECT_NEAR(a.place[1], b.place[1], 1e-4);
  for (std::size_t j = 0; j < a.joints.size(); ++j) EXPECT_NEAR(a.joints[j][0], -b.joints[j][0], 1e-3) << j;
}

TEST_F(MujocoEngine, AHandThatBeginsInTheVesselIsDiscarded) {
  // the first one at random that is deeper than the gate allows, but not than the scene does
  const TrialSettings settings = quick();
  for (const GripInput& grip : sample_grips(scene_.vessels[1], 400, 5)) {
    GripResult result;
    evaluator_->grip(1, grip, result);
    if (result.reason != Reason::none || result.phalanx_depth < 2e-3 || !result.plausible) continue;
    const auto found = run(1, grip, fill_tilt(0, {0, 30}), settings);
    for (const TrialOutcome& outcome : found) {
      EXPECT_TRUE(outcome.discarded);
      EXPECT_FALSE(outcome.held);
      EXPECT_EQ(outcome.reason, TrialReason::overlap);
    }
    return;
  }
  FAIL() << "no grip is that deep";
}

// A contact that presses with some newtons is about a tenth of a millimeter deep.
TEST_F(MujocoEngine, AFingerThatIsTooDeepOnceClosedIsDiscarded) {
  TrialSettings settings = quick();
  settings.buried = 0.01e-3;
  const auto found = run(0, BEAKER, fill_tilt(0.5, {0, 30}), settings);
  for (const TrialOutcome& outcome : found) {
    EXPECT_TRUE(outcome.discarded);
    EXPECT_EQ(outcome.reason, TrialReason::buried);
  }
}

TEST_F(MujocoEngine, SixForcesEachFromAFreshStart) {
  std::vector<TrialCase> cases;
  for (int material = 0; material < 2; ++material)
    for (int direction = 0; direction < 6; ++direction) cases.push_back({TrialProtocol::six_forces, 0, 0, direction, material});
  const auto found = run(0, BEAKER, cases);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    EXPECT_TRUE(found[k].held) << k;
    expect_same(run(0, BEAKER, {cases[k]})[0], found[k]);
  }
}

// The engine refuses the vessel before it tries any grip; it accepts another vessel of the same scene.
TEST_F(MujocoEngine, AVesselWithoutAModelIsRefused) {
  Scene shells = scene_;
  shells.vessels[0].surface = Surface::shell;
  const auto evaluator = make_core_evaluator(shells);
  const auto engine = make_mujoco_engine(shells, *evaluator, quick());
  EXPECT_NE(usage_of(*engine, 0).find("its surface is a shell"), std::string::npos) << usage_of(*engine, 0);
  EXPECT_EQ(usage_of(*engine, 1), "none");
  EXPECT_THROW(engine->run(0, BEAKER, fill_tilt(0, {0})), Error);
}

// The bones of `paper` have no joints to turn in; the model `contacts` has no bones, and `rigged` is the hand with its joints at
// rest.
TEST_F(MujocoEngine, AHandWithoutJointsIsRefused) {
  Scene scene = scene_;
  const auto answer = [&](Pose pose, TrialModel model) {
    scene.pose = pose;
    return usage_of(*make_mujoco_engine(scene, *evaluator_, quick(model)), 0);
  };
  EXPECT_NE(answer(Pose::paper, TrialModel::hand).find("pose = \"paper\""), std::string::npos);
  EXPECT_EQ(answer(Pose::paper, TrialModel::contacts), "none");
  EXPECT_EQ(answer(Pose::rigged, TrialModel::hand), "none");
  EXPECT_EQ(answer(Pose::articulated, TrialModel::hand), "none");
}

bool is_diverged(const TrialOutcome& outcome) {
  EXPECT_FALSE(outcome.held && outcome.discarded);
  EXPECT_EQ(outcome.detail.empty(), outcome.reason != TrialReason::diverged);
  return outcome.discarded && outcome.reason == TrialReason::diverged;
}

// A body that weighs nothing is a model that the engine does not take. Only what is asked of it is lost.
TEST_F(MujocoEngine, AModelThatItDoesNotTakeIsDiverged) {
  auto cases = fill_tilt(0.5, {0, 30});
  cases.push_back({TrialProtocol::six_forces, 0.5, 0, 2, 0});
  TrialSettings settings = quick();
  settings.mass = 0;
  std::vector<TrialTrack> tracks;
  for (const TrialOutcome& outcome : run(0, BEAKER, cases, settings, &tracks)) EXPECT_TRUE(is_diverged(outcome));
  EXPECT_EQ(tracks.size(), cases.size());
}

// A trial goes on with a new start after it.
TEST_F(MujocoEngine, WhatComesAfterTroubleIsAsWithoutIt) {
  TrialSettings settings = quick();
  settings.materials = {{"scene"}, {"nothing", 0}};
  const auto engine = make_mujoco_engine(scene_, *evaluator_, settings);
  const std::vector<TrialCase> pushes{{TrialProtocol::six_forces, 0.5, 0, 2, 0}, {TrialProtocol::six_forces, 0.5, 0, 2, 1}};
  const auto found = engine->run(0, BEAKER, {pushes[1], pushes[0]});
  EXPECT_TRUE(is_diverged(found[0]));
  EXPECT_FALSE(is_diverged(found[1]));
  expect_same(found[1], engine->run(0, BEAKER, {pushes[0]})[0]);
}

// With room for more and more contacts. What is found before there is no room left stays; whatever comes after it is lost with it,
// and the next fill is not.
TEST_F(MujocoEngine, WithoutRoomForContactsATrialIsDivergedFromThereOn) {
  const TrialSettings settings = quick();
  const std::vector<double> tilts{0, radians(30), radians(60)};
  const BodyForm form = trial_form(scene_, 0);
  int full = 0, enough = 0;
  for (int most = 1; most <= 33; most += 4) {
    const auto trial = [&] { return GripTrial(load_mujoco(), scene_, *evaluator_, settings, 0, form, BEAKER, most); };
    GripTrial both = trial(), other = trial();
    TrialTrack track;
    std::vector<std::size_t> ends;
    const auto first = both.tilt(1, tilts, &track, &ends), then = both.tilt(0, tilts, nullptr, nullptr),
               alone = other.tilt(0, tilts, nullptr, nullptr);
    ASSERT_EQ(first.size(), tilts.size());
    ASSERT_EQ(ends.size(), tilts.size());
    bool is_lost = false;
    for (std::size_t k = 0; k < tilts.size(); ++k) {
      if (is_lost) {
        EXPECT_TRUE(is_diverged(first[k])) << most;
      }
      is_lost = is_diverged(first[k]);
      if (is_lost) {
        EXPECT_NE(first[k].detail.find("contact"), std::string::npos) << first[k].detail;
      }
      expect_same(then[k], alone[k]);
    }
    ++(is_lost ? full : enough);
  }
  EXPECT_GT(full, 0);
  EXPECT_GT(enough, 0);
}

// The beaker's form from a file: one convex piece, of the same mass.
TEST_F(MujocoEngine, AConvexMeshIsHeldAsItsOutline) {
  VesselData outline = scene_.vessels[0];
  const VesselConstants constants = evaluator_->constants(0);
  VesselData full = outline;
  full.wall = 0;
  outline.wall = 0;
  outline.inner.clear();
  VesselData mesh = vessel_of_mesh("mesh", turned_mesh(full, 128, 1e-4), 1e-3);
  Scene scene = scene_;
  scene.liquid.reset();
  for (VesselData* vessel : {&outline, &mesh}) {
    vessel->mass = constants.mass;
    vessel->center_of_mass = constants.center_of_mass;
  }
  scene.vessels = {outline, mesh};
  const auto evaluator = make_core_evaluator(scene);
  const auto engine = make_mujoco_engine(scene, *evaluator, quick());
  engine->check(1);
  const auto a = engine->run(0, BEAKER, fill_tilt(0, {0, 30})), b = engine->run(1, BEAKER, fill_tilt(0, {0, 30}));
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_TRUE(a[k].held);
    EXPECT_TRUE(b[k].held);
    EXPECT_NEAR(a[k].move, b[k].move, 0.5e-3);
  }
}

// The model `contacts` has nothing that could hold but the contacts of kernel 9. What the effort calls infinite slides: out of the
// hand, or some millimeters until the same contacts meet other walls that hold it, as where a neck meets a cone.
TEST_F(MujocoEngine, WhatEffortCallsInfiniteIsNotHeldWhereItIs) {
  int infinite = 0;
  for (const GripInput& grip : sample_grips(scene_.vessels[2], 200, 3)) {
    GripResult result;
    evaluator_->grip(2, grip, result);
    if (result.reason != Reason::none || !result.plausible) continue;
    const sweeps::Holding holding(scene_, *evaluator_, 2, result, sweeps::pour_direction(scene_, grip));
    sweeps::GripState state;
    state.fill = 0.5;
    state.liquid = evaluator_->liquid(2, state.fill, 0);
    state.state = evaluator_->state(2, grip, result, state.liquid, 0);
    if (std::isfinite(holding.state(state).effort)) continue;
    TrialSettings settings = quick(TrialModel::contacts);
    settings.hold_time = 1.5;
    const auto found = run(2, grip, fill_tilt(0.5, {0}), settings);
    if (found[0].discarded) continue;
    ++infinite;
    EXPECT_FALSE(found[0].held && found[0].slip < settings.slip) << grip.height << ' ' << grip.azimuth;
    if (infinite == 20) break;
  }
  EXPECT_GT(infinite, 10);
}

}  // namespace
}  // namespace wholehand

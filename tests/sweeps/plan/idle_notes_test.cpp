// SPDX-License-Identifier: MIT
// Notes on what a scene asks for and what changes nothing: printed for each such scene, and for no other.
// sanitizers: address
#include "sweeps/plan/idle_notes.h"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "tests/support/scenes.h"
#include "tests/support/sweep_trial.h"

namespace wholehand::sweeps {
namespace {

std::string notes_of(const Scene& scene, std::size_t best = 5) {
  std::string all;
  for (const std::string& line : idle_notes(scene, Plan(scene, false), best)) all += line + "\n";
  return all;
}

// Nothing is missing in it.
Scene tilted_scene() {
  Scene scene = scene_of({beaker1()});
  scene.tilts = {0, 1};
  scene.table.emplace();
  scene.strength.emplace();
  scene.grips.height.values = {0.4, 0.6};
  return scene;
}

TEST(IdleNotes, WhatIsNotJudgedIsNamed) {
  const Scene whole = tilted_scene();
  EXPECT_EQ(notes_of(whole), "");
  const std::vector<std::pair<std::string, std::function<void(Scene&)>>> lacks{
      {"[table]", [](Scene& scene) { scene.table.reset(); }},
      {"[strength]", [](Scene& scene) { scene.strength.reset(); }},
      {"[tilts]", [](Scene& scene) { scene.tilts.clear(); }},
      {"one grip", [](Scene& scene) { scene.grips.height.values = {0.5}; }}};
  for (std::size_t k = 0; k < lacks.size(); ++k) {
    Scene scene = whole;
    lacks[k].second(scene);
    const std::string note = unjudged_note(scene, Plan(scene, false));
    for (std::size_t other = 0; other < lacks.size(); ++other)
      EXPECT_EQ(note.find(lacks[other].first) != std::string::npos, other == k) << note;
  }
}

TEST(IdleNotes, StrengthNeedsTilts) {
  Scene scene = tilted_scene();
  EXPECT_EQ(notes_of(scene), "");
  scene.tilts.clear();
  EXPECT_EQ(notes_of(scene), "") << "nobody asked for it";
  scene.strength->place = "scene.toml:1:1";
  EXPECT_EQ(notes_of(scene).find("note: [strength] changes nothing here"), 0u);
  scene.strength.reset();
  EXPECT_EQ(notes_of(scene).find("[strength] changes nothing here"), std::string::npos);
}

TEST(IdleNotes, FrictionNeedsTheTermOfHolding) {
  Scene scene = tilted_scene();
  scene.robust = RobustData{};
  scene.robust->friction = 0.1;
  EXPECT_EQ(notes_of(scene), "");
  scene.score.force = 0;
  EXPECT_EQ(notes_of(scene), "") << "the hold term depends on it";
  scene.score.force = 1;
  scene.score.hold = 0;
  EXPECT_NE(notes_of(scene).find("[robust] friction changes no score here, since the weight of hold is 0"), std::string::npos);
  scene.tilts.clear();
  EXPECT_NE(notes_of(scene).find("[robust] friction changes no score here, since the scene has no [tilts]"), std::string::npos);
  scene.robust->friction = 0;
  scene.robust->roll = 0.1;
  EXPECT_EQ(notes_of(scene).find("[robust]"), std::string::npos);
}

TEST(IdleNotes, AzimuthNeedsAVesselThatIsNotRound) {
  Scene scene = tilted_scene();
  scene.robust = RobustData{};
  scene.robust->azimuth = 0.1;
  EXPECT_NE(notes_of(scene).find("[robust] azimuth_deg changes no score here"), std::string::npos);
  scene.vessels[0].mass = 0.2;
  scene.vessels[0].center_of_mass = Triple{0.01, 0.05, 0};
  EXPECT_EQ(notes_of(scene), "") << "its weight is off the axis";
}

TEST(IdleNotes, RobustScoresNeedAList) {
  Scene scene = tilted_scene();
  scene.robust = RobustData{};
  scene.robust->roll = 0.1;
  EXPECT_EQ(notes_of(scene), "");
  EXPECT_NE(notes_of(scene, 0).find("[robust] changes nothing here"), std::string::npos);
}

using IdleNotesRun = RunTest;

TEST_F(IdleNotesRun, ASweepSaysThem) {
  SweepTrial trial(folder / "a.nc");
  trial.scene.robust = RobustData{};
  trial.scene.robust->roll = 0.1;
  trial.scene.output.best = 0;
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::done);
  EXPECT_NE(outcome.notes.find("wholehand: note: [robust] changes nothing here"), std::string::npos) << outcome.notes;
  EXPECT_NE(outcome.out.find("\nnot judged: without [table]"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace wholehand::sweeps

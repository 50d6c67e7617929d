// SPDX-License-Identifier: MIT
// The engine is loaded at run time, and every problem that it finds is reported.
// sanitizers: none
#include "evidence/trials/mujoco.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/text/error.h"
#include "tests/support/contact_rig.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

std::string refusal_of(const std::string& path) {
  try {
    load_mujoco(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    return error.what();
  }
  return "none";
}

TEST(Mujoco, IsLoaded) { EXPECT_EQ(load_mujoco().name, "MuJoCo 2.2.2"); }

TEST(Mujoco, AMissingLibraryIsOneLineThatNamesThePackage) {
  const std::string line = refusal_of("libmujoco.so.0.0.0");
  EXPECT_NE(line.find("cannot load MuJoCo: libmujoco.so.0.0.0"), std::string::npos) << line;
  EXPECT_NE(line.find("libmujoco2.2.2"), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

TEST(Mujoco, AnotherLibraryIsRefused) {
  EXPECT_NE(refusal_of("libm.so.6").find("lacks the function mj_version"), std::string::npos) << refusal_of("libm.so.6");
}

TEST(Mujoco, AModelThatItDoesNotTakeIsTroubleInItsWords) {
  try {
    Simulation(load_mujoco(), "<mujoco><worldbody><geom type=\"sphere\" size=\"-1\"/></worldbody></mujoco>");
    FAIL() << "it took the model";
  } catch (const EngineError& error) {
    EXPECT_NE(std::string(error.what()).find("size"), std::string::npos) << error.what();
  }
}

TEST(Mujoco, AModelThatItWarnsOfIsTroubleInItsWords) {
  const std::string ball = "<body pos=\"0 0 0.005\"><freejoint/><geom size=\"0.01\"/></body>";
  const auto load = [&](int most) {
    Simulation(load_mujoco(), fmt::format("<mujoco><size nconmax=\"{}\"/><worldbody><geom type=\"plane\" size=\"1 1 1\"/>{}{}"
                                          "</worldbody></mujoco>",
                                          most, ball, ball));
  };
  EXPECT_NO_THROW(load(10));
  try {
    load(1);
    FAIL() << "it warned of the model and nobody said so";
  } catch (const EngineError& error) {
    EXPECT_NE(std::string(error.what()).find("contact buffer is full"), std::string::npos) << error.what();
  }
}

// Until it is made as new.
TEST(Mujoco, MassesThatItWarnsOfAreTrouble) {
  Simulation simulation(load_mujoco(), "<mujoco><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>");
  mjModel& m = simulation.model();
  const double mass = m.body_mass[1];
  m.body_mass[1] = 0;
  EXPECT_THROW(simulation.set_constants(), EngineError);
  m.body_mass[1] = mass;
  EXPECT_THROW(simulation.set_constants(), EngineError);
  simulation.reset();
  EXPECT_NO_THROW(simulation.set_constants());
}

// By default an error ends the process.
TEST(Mujoco, AnErrorOfTheEngineIsTrouble) {
  Simulation simulation(load_mujoco(), "<mujoco><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>");
  simulation.data().nstack = simulation.data().pstack;  // no room for anything
  EXPECT_THROW(simulation.step(), EngineError);
}

TEST(Mujoco, ANumberThatIsNoneIsTrouble) {
  Simulation simulation(load_mujoco(), "<mujoco><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>");
  simulation.step();
  simulation.data().qvel[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(simulation.step(), EngineError);
}

std::vector<core_f64::ContactPoint> four_contacts() {
  return {{Vec3(-0.04, 0, 0), Vec3(1, 0, 0), 0},
          {Vec3(0.04, 0, 0), Vec3(-1, 0, 0), 1},
          {Vec3(0, 0, -0.04), Vec3(0, 0, 1), 2},
          {Vec3(0, 0, 0.04), Vec3(0, 0, -1), 3}};
}

HeldBody held_by_four(const RigOptions& options) {
  core_f64::HandStrength hand{0.6, 5e-3, {}};
  hand.digits.fill(50);
  return HeldBody(load_mujoco(), rig_setup(four_contacts(), hand, options));
}

TEST(Mujoco, NoContactIsDropped) {
  RigOptions options;
  HeldBody body = held_by_four(options);
  press_and_release(body, {5, 5, 5, 5}, Vec3(0));
  EXPECT_EQ(body.contacts().size(), 4u);
  body.simulation().model().nconmax = 3;
  try {
    body.step();
    FAIL() << "a contact was dropped and nobody said so";
  } catch (const EngineError& error) {
    EXPECT_NE(std::string(error.what()).find("contact"), std::string::npos) << error.what();
  }
  options.most_contacts = 3;  // it has none left when it compiles the model
  EXPECT_THROW(held_by_four(options), EngineError);
}

// Leaving out distant pairs changes nothing, however fast they approach: the contacts are those of a check of all pairs.
// The body flies at a ball which it is 40 mm away from; at 5 m/s it passes NEAR in half a step.
TEST(Mujoco, WhatComesFastIsSeenInTime) {
  core_f64::HandStrength hand{0.6, 5e-3, {}};
  hand.digits.fill(50);
  HeldSetup all = rig_setup({{Vec3(0.04, 0, 0), Vec3(-1, 0, 0), 0}}, hand, {});
  HeldSetup near = all;
  // the wall is a plate behind x = 40 mm, 10 mm thick
  const Triple low{0.03, -0.06, -0.06}, high{0.04, 0.06, 0.06};
  near.form.boxes = {{low, high}};
  near.distance = [](const Vec3& p) { return std::max(p.x - 0.04, 0.03 - p.x); };
  for (const double speed : {0.3, 1.0, 2.0, 5.0, 20.0}) {
    std::vector<double> ways;
    std::vector<int> touched;
    for (const HeldSetup* setup : {&all, &near}) {
      HeldBody body(load_mujoco(), *setup);
      body.release();
      body.simulation().data().qpos[0] = -0.04;
      body.simulation().data().qvel[0] = speed;
      body.simulation().data().qvel[4] = speed;  // and it spins
      int count = 0;
      for (int k = 0; k < 200; ++k) {
        body.step();
        if (!body.contacts().empty()) ++count;
      }
      touched.push_back(count);
      ways.push_back(body.place().x);
    }
    EXPECT_EQ(touched[0], touched[1]) << speed;
    EXPECT_EQ(ways[0], ways[1]) << speed;
    if (speed < 3) {
      EXPECT_GT(touched[0], 0) << speed;
    }
  }
}

// What is loaded is what is weighed: a body of 0.3 kg under its weight hangs on forces that add up to it.
TEST(Mujoco, ContactsCarryTheLoad) {
  RigOptions options;
  HeldBody body = held_by_four(options);
  const Vec3 weight(0, -0.3 * 9.80665, 0);
  press_and_release(body, {5, 5, 5, 5}, weight);
  for (int k = 0; k < 500; ++k) body.step();
  Vec3 sum(0);
  for (const TouchedPlace& touched : body.contacts()) sum += touched.force;
  EXPECT_NEAR(sum.y, -weight.y, 1e-3);
  EXPECT_NEAR(sum.x, 0, 1e-3);
  EXPECT_NEAR(sum.z, 0, 1e-3);
}

}  // namespace
}  // namespace wholehand

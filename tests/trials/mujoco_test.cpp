// SPDX-License-Identifier: MIT
// The engine is loaded at run time, and nothing that it finds wrong goes unnoticed.
// sanitizers: none
#include "trials/mujoco.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
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
  } catch (const EngineTrouble& trouble) {
    EXPECT_NE(std::string(trouble.what()).find("size"), std::string::npos) << trouble.what();
  }
}

// By default an error ends the process.
TEST(Mujoco, AnErrorOfTheEngineIsTrouble) {
  Simulation simulation(load_mujoco(), "<mujoco><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>");
  simulation.data().nstack = simulation.data().pstack;  // no room for anything
  EXPECT_THROW(simulation.step(), EngineTrouble);
}

TEST(Mujoco, ANumberThatIsNoneIsTrouble) {
  Simulation simulation(load_mujoco(), "<mujoco><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>");
  simulation.step();
  simulation.data().qvel[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(simulation.step(), EngineTrouble);
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
  options.most_contacts = 3;
  HeldBody narrow = held_by_four(options);
  try {
    press_and_release(narrow, {5, 5, 5, 5}, Vec3(0));
    FAIL() << "a contact was dropped and nobody said so";
  } catch (const EngineTrouble& trouble) {
    EXPECT_NE(std::string(trouble.what()).find("contact"), std::string::npos) << trouble.what();
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

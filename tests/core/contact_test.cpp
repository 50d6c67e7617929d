// SPDX-License-Identifier: MIT
// Kernel 4: separations, touching points, proxies, depths and bone stretch.
#include "core/contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/contacts.h"
#include "core/evaluator.h"
#include "core/joints.h"
#include "core/vectors.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Contact;
using core_f64::Vec3;
using core_f64::Vessel;

constexpr double ON_SURFACE = 1e-9;  // m: the specification's |sdf - r|

double joint_radius(const HandData& hand, std::size_t joint) {
  const int finger = finger_of(static_cast<int>(joint));
  return hand.fingers[finger].radii[joint - finger_start(finger)];
}

bool is_base(int joint) { return joint == finger_start(finger_of(joint)); }

Vec3 point_near(const VesselData& vessel, Random& random) {
  const double r = random.uniform(0, 1.3) * largest_radius(vessel), azimuth = random.uniform(-PI, PI);
  return {r * std::cos(azimuth), random.uniform(-0.1, 1.1) * vessel.height, r * std::sin(azimuth)};
}

TEST(Contact, SeparationIsTheDistanceLessTheRadius) {
  const Vessel vessel = ready_vessel(beaker1());  // R = 40 mm, height 110 mm
  // 1e-16 m: rounding
  EXPECT_NEAR(core_f64::separation_at(vessel, {50e-3, 55e-3, 0}, 8e-3), 2e-3, 1e-16);
  EXPECT_NEAR(core_f64::separation_at(vessel, {50e-3, 55e-3, 0}, 0), 10e-3, 1e-16);
  EXPECT_NEAR(core_f64::separation_at(vessel, {0, 55e-3, -44e-3}, 8e-3), -4e-3, 1e-16);
  EXPECT_NEAR(core_f64::separation_at(vessel, {0, 55e-3, 38e-3}, 7e-3), -9e-3, 1e-16);
  EXPECT_NEAR(core_f64::contact_at(vessel, {0, 55e-3, 38e-3}, 7e-3).separation, -9e-3, 1e-16);
}

TEST(Contact, PointThatDoesNotPenetrateIsItsOwnProxy) {
  for (const VesselData& data : {beaker1(), vase(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(31);
    int clear = 0;
    for (int n = 0; n < 500; ++n) {
      const Vec3 p = point_near(data, random);
      const double sdf = core_f64::signed_distance(vessel, p);
      // well away, and with the radius that makes the separation exactly 0
      for (const double radius : {0.0, 1e-3, sdf}) {
        if (radius < 0 || sdf - radius < 0) continue;
        ++clear;
        const Contact contact = core_f64::contact_at(vessel, p, radius);
        EXPECT_EQ(contact.proxy, p);
        EXPECT_TRUE(contact.settled);
        EXPECT_EQ(contact.separation, sdf - radius);
      }
    }
    EXPECT_GT(clear, 200);
  }
}

TEST(Contact, ProxyInClosedForm) {
  const Vessel vessel = ready_vessel(beaker1());
  bool settled = false;
  // 1e-15 m: a normalisation and a product
  const auto expect = [&](Vec3 p, double radius, Vec3 proxy) {
    EXPECT_LT(glm::distance(core_f64::proxy_of(vessel, p, radius, settled), proxy), 1e-15) << p.x << ", " << p.y << ", " << p.z;
    EXPECT_TRUE(settled);
  };
  expect({38e-3, 55e-3, 0}, 8e-3, {48e-3, 55e-3, 0});            // out of the wall
  expect({0, 55e-3, -41e-3}, 8e-3, {0, 55e-3, -48e-3});          // outside it, but its skin is inside
  expect({24e-3, 55e-3, 18e-3}, 0, {32e-3, 55e-3, 24e-3});       // a bare point, aslant: 3, 4, 5
  expect({10e-3, 3e-3, 0}, 7e-3, {10e-3, -7e-3, 0});             // out of the base
  expect({-10e-3, 108e-3, 5e-3}, 7e-3, {-10e-3, 117e-3, 5e-3});  // out of the lid
  expect({43e-3, 114e-3, 0}, 10e-3, {46e-3, 118e-3, 0});         // off the rim, along 3, 4, 5
  expect({0, 55e-3, 0}, 8e-3, {48e-3, 55e-3, 0});                // on the axis outwards is +x
}

TEST(Contact, ProxyLiesOnTheSurface) {
  // one step is enough where the distance is exact and the normal unique
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(beaker1()), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(32);
    int penetrating = 0, unsettled = 0;
    for (int n = 0; n < 2000; ++n) {
      const Vec3 p = point_near(data, random);
      const double radius = n % 5 == 0 ? 0 : random.uniform(0, 9e-3);
      const Contact contact = core_f64::contact_at(vessel, p, radius);
      if (!(contact.separation < 0)) continue;
      ++penetrating;
      const double off = std::abs(core_f64::signed_distance(vessel, contact.proxy) - radius);
      if (!contact.settled) {
        ++unsettled;
        EXPECT_GE(off, ON_SURFACE) << data.name;  // flagged only where it is not there
      } else {
        ASSERT_LT(off, ON_SURFACE) << data.name << " at " << p.x << ", " << p.y << ", " << p.z << " radius " << radius;
      }
    }
    EXPECT_GT(penetrating, 300) << data.name;
    // tips wider than a hollow (the ledges' trough and notch, the bore of a shell) go to and fro between its sides
    const bool has_hollows = data.name == "ledges" || data.surface == Surface::shell || data.name == "vase";
    EXPECT_LE(unsettled, has_hollows ? penetrating / 10 : 0) << data.name;
  }
}

TEST(Contact, ProxyOfABarePointIsTheNearestSurfacePoint) {
  for (const VesselData& data : {beaker2(), vase(), ledges()}) {
    const Vessel vessel = ready_vessel(data);
    Random random(33);
    for (int n = 0; n < 500; ++n) {
      const Vec3 p = point_near(data, random);
      const Contact contact = core_f64::contact_at(vessel, p, 0);
      if (contact.separation < 0) {
        EXPECT_NEAR(glm::distance(contact.proxy, p), -contact.separation, 1e-15);
        EXPECT_TRUE(contact.settled);
      }
    }
  }
}

TEST(Contact, ProxyNearAMedialAxisTakesEitherSide) {
  const Vessel vessel = ready_vessel(beaker1());
  const double radius = 7e-3;
  for (const double off : {-1e-12, -1e-16, 0.0, 1e-16, 1e-12}) {  // of the diagonal between wall and base, wall and lid
    for (const double depth : {2e-3, 15e-3, 33e-3}) {
      bool settled = false;
      const Vec3 low{40e-3 - depth + off, depth, 0}, high{40e-3 - depth + off, 110e-3 - depth, 0};
      const Vec3 low_proxy = core_f64::proxy_of(vessel, low, radius, settled);
      EXPECT_TRUE(settled);
      EXPECT_LT(std::min(glm::distance(low_proxy, {47e-3, low.y, 0}), glm::distance(low_proxy, {low.x, -7e-3, 0})),
                1e-11);  // off + rounding
      const Vec3 high_proxy = core_f64::proxy_of(vessel, high, radius, settled);
      EXPECT_TRUE(settled);
      EXPECT_LT(std::min(glm::distance(high_proxy, {47e-3, high.y, 0}), glm::distance(high_proxy, {high.x, 117e-3, 0})), 1e-11);
    }
  }
}

TEST(Contact, ProxyAtACornerOfTheSurfaceIsOffTheSurface) {
  const Vessel vessel = ready_vessel(beaker1());
  for (const Vec3 corner : {Vec3{40e-3, 0, 0}, Vec3{0, 110e-3, 40e-3}}) {
    bool settled = false;
    const Vec3 proxy = core_f64::proxy_of(vessel, corner, 8e-3, settled);
    EXPECT_TRUE(settled);
    EXPECT_NEAR(core_f64::signed_distance(vessel, proxy), 8e-3, ON_SURFACE);
    EXPECT_NEAR(glm::distance(proxy, corner), 8e-3, ON_SURFACE);
  }
}

TEST(Contact, ProxyInAShellsWallLeavesItOnTheNearerSide) {
  const Vessel vessel = ready_vessel(shell_of(beaker1()));  // from 38.5 to 40 mm
  bool settled = false;
  const Vec3 out = core_f64::proxy_of(vessel, {39.5e-3, 55e-3, 0}, 7e-3, settled);
  EXPECT_LT(glm::distance(out, {47e-3, 55e-3, 0}), 1e-15);
  const Vec3 in = core_f64::proxy_of(vessel, {39e-3, 55e-3, 0}, 7e-3, settled);
  EXPECT_LT(glm::distance(in, {31.5e-3, 55e-3, 0}), 1e-15);
}

TEST(Contact, ProxyOnALatticeSettlesOrSaysSo) {
  const Vessel vessel = lattice_vessel(vase(), 60);
  Random random(34);
  int penetrating = 0, unsettled = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = point_near(vase(), random);
    const Contact contact = core_f64::contact_at(vessel, p, 5e-3);
    if (!(contact.separation < 0)) continue;
    ++penetrating;
    unsettled += !contact.settled;
    if (contact.settled) {
      ASSERT_LT(std::abs(core_f64::signed_distance(vessel, contact.proxy) - 5e-3), ON_SURFACE);
    }
  }
  EXPECT_GT(penetrating, 300);
  EXPECT_LT(unsettled, penetrating / 3);  // gradients jump from cell to cell, so not every one contracts in 16 steps
}

// ---- whole grips ----

struct Whole {
  std::string name;
  Scene scene;
};

std::vector<Whole> wholes() {
  return {{"articulated", scene_of({vase()})},
          {"odd", scene_of({beaker3()}, Pose::articulated, odd_hand())},
          {"paper", scene_of({beaker2()}, Pose::paper)},
          {"rigged", scene_of({ledges()}, Pose::rigged)},
          {"left", scene_of({vase()}, Pose::articulated, left_hand())},
          {"shell", scene_of({shell_of(beaker1())})},
          {"large", scene_of({scaled(vase(), 3)}, Pose::articulated, large_hand())}};
}

// Calls `check` for each feasible grip of a sample.
template <class Check>
void for_each_whole_grip(const Whole& whole, Check check) {
  const auto evaluator = make_core_evaluator(whole.scene);
  int feasible = 0;
  for (GripInput grip : sample_grips(whole.scene.vessels[0], 80, 35)) {
    grip.hand_scale = 0.95 + 0.05 * std::sin(100 * grip.azimuth);
    GripResult result;
    evaluator->grip(0, grip, result);
    if (result.reason != Reason::none) continue;
    ++feasible;
    check(*evaluator, grip.hand_scale * whole.scene.hand.scale, result);
  }
  EXPECT_GT(feasible, 30) << whole.name;
}

TEST(Contact, SeparationsAreThoseOfThePosedHand) {
  for (const Whole& whole : wholes()) {
    for_each_whole_grip(whole, [&](const Evaluator& evaluator, double scale, const GripResult& result) {
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        // 1e-15 m: the tips of the index finger and the thumb are evaluated where they were traced
        EXPECT_NEAR(result.separation[j], evaluator.distance(0, result.posed[j]) - scale * joint_radius(whole.scene.hand, j), 1e-15)
            << whole.name << ", joint " << j;
      }
    });
  }
}

TEST(Contact, TouchesWithinTheContactTolerance) {
  for (const Whole& whole : wholes()) {
    int touching = 0, apart = 0, penetrating = 0;
    for_each_whole_grip(whole, [&](const Evaluator&, double, const GripResult& result) {
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        const bool touches = result.touch_mask >> j & 1;
        if (j == THUMB_TIP || j == INDEX_TIP) {
          EXPECT_TRUE(touches);  // by construction
        } else {
          EXPECT_EQ(touches, result.separation[j] <= whole.scene.hand.contact_tolerance)
              << whole.name << ", joint " << j;  // not scaled
          ++(touches ? touching : apart);
          penetrating += result.separation[j] < 0;
        }
      }
      EXPECT_EQ(result.touch_mask >> JOINT_COUNT, 0u);
    });
    EXPECT_GT(touching, 20) << whole.name;
    EXPECT_GT(apart, 20) << whole.name;
    EXPECT_GT(penetrating, 5) << whole.name;
  }
}

// A resting point is within one stop tolerance of the surface on either side, which no scene can distinguish from touching.
TEST(Contact, WhatRestsTouchesWhateverTheTolerance) {
  Scene scene = scene_of({beaker1(), beaker3()});
  scene.hand.contact_tolerance = 0;
  scene.hand.depth_limit = 0;
  const auto core = make_core_evaluator(scene), single = make_core_float_evaluator(scene);
  int resting = 0, plausible = 0, apart = 0, grips = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    for (const GripInput& grip : sample_grips(scene.vessels[v], 300, 17)) {
      GripResult full, rounded;
      core->grip(v, grip, full);
      single->grip(v, grip, rounded);
      if (full.reason != Reason::none || full.grazing || rounded.grazing) continue;
      ++grips;
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        const bool rests = std::abs(full.separation[j]) < STOP_TOLERANCE_F64;
        resting += rests;
        if (rests) {
          EXPECT_TRUE(full.touch_mask >> j & 1) << "joint " << j << ": " << full.separation[j];
        }
      }
      plausible += full.plausible;
      apart += full.touch_mask != rounded.touch_mask || full.plausible != rounded.plausible;
    }
  }
  EXPECT_GT(resting, 2 * grips) << "the tracked tips and more";
  EXPECT_GT(5 * plausible, grips);
  EXPECT_LE(apart, 3) << "of " << grips << " grips in float";
}

TEST(Contact, FingerIsUsedWhenAPointOfItTouches) {
  for (const Whole& whole : wholes()) {
    for_each_whole_grip(whole, [&](const Evaluator&, double, const GripResult& result) {
      std::uint32_t used = 0;
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        if (result.touch_mask >> j & 1) used |= 1u << finger_of(static_cast<int>(j));
      }
      EXPECT_EQ(result.used_mask, used) << whole.name;
      EXPECT_EQ(used & 3u, 3u);  // thumb and index finger always
    });
  }
}

TEST(Contact, DepthsArePhalangesAndPalm) {
  for (const Whole& whole : wholes()) {
    double deepest_phalanx = 0, deepest_palm = 0;
    for_each_whole_grip(whole, [&](const Evaluator&, double, const GripResult& result) {
      double phalanx = 0, palm = 0;
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        double& depth = is_base(j) ? palm : phalanx;  // MCPs are phalanges here
        depth = std::max(depth, -result.separation[j]);
      }
      EXPECT_EQ(result.phalanx_depth, phalanx) << whole.name;
      EXPECT_EQ(result.palm_depth, palm) << whole.name;
      deepest_phalanx = std::max(deepest_phalanx, phalanx);
      deepest_palm = std::max(deepest_palm, palm);
    });
    EXPECT_GT(deepest_phalanx, 1e-3) << whole.name;
    EXPECT_GE(deepest_palm, 0);
  }
}

TEST(Contact, PalmDepthIsFoundWhereThePalmIsInside) {
  // a large vessel between a wrist and fingers that only just reach round it: the hand pushed down over its neck
  VesselData bottle = vessel_of("bottle", {line_to(90, 0), line_to(90, 60), line_to(15, 64), line_to(15, 140), line_to(0, 140)}, 1);
  const auto evaluator = make_core_evaluator(scene_of({bottle}, Pose::rigged));
  GripInput grip;
  double palm = 0;
  for (const double height : {70e-3, 90e-3, 110e-3}) {
    for (int roll = -180; roll < 180; roll += 15) {
      grip.height = height;
      grip.roll = radians(roll);
      GripResult result;
      evaluator->grip(0, grip, result);
      if (result.reason != Reason::none) continue;
      double expected = 0;
      for (const std::size_t base : {0, 4, 9, 14, 19}) {
        expected = std::max(expected, 8e-3 - evaluator->distance(0, result.posed[base]));  // every base has 8 mm
      }
      EXPECT_NEAR(result.palm_depth, expected, 1e-15);
      palm = std::max(palm, result.palm_depth);
    }
  }
  EXPECT_GT(palm, 5e-3);
}

TEST(Contact, ProxiesAreNeverInsideTheGlass) {
  for (const Whole& whole : wholes()) {
    int moved = 0, unsettled_grips = 0, grips = 0;
    for_each_whole_grip(whole, [&](const Evaluator& evaluator, double scale, const GripResult& result) {
      const bool unsettled = result.status & STATUS_PROXY_UNSETTLED;
      ++grips;
      unsettled_grips += unsettled;
      bool all_out = true;
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        const double off = evaluator.distance(0, result.proxies[j]) - scale * joint_radius(whole.scene.hand, j);
        all_out = all_out && off > -ON_SURFACE;
        if (result.separation[j] < 0) {
          ++moved;
          if (!unsettled) {
            EXPECT_LT(std::abs(off), ON_SURFACE) << whole.name << ", joint " << j;
          }
        } else {
          EXPECT_EQ(result.proxies[j], result.posed[j]);
        }
      }
      EXPECT_TRUE(all_out || unsettled) << whole.name;
    });
    EXPECT_GT(moved, 5) << whole.name;
    EXPECT_LE(unsettled_grips, whole.name == "rigged" || whole.name == "shell" || whole.name == "left" ||
                                       whole.name == "articulated" || whole.name == "large"
                                   ? grips / 4  // hollows narrower than a tip
                                   : 0)
        << whole.name;
  }
}

TEST(Contact, BoneStretchIsTheLargestOverTheBones) {
  for (const Whole& whole : wholes()) {
    double largest = 0;
    for_each_whole_grip(whole, [&](const Evaluator&, double, const GripResult& result) {
      double stretch = 0;
      int bones = 0;
      for (std::size_t j = 0; j + 1 < JOINT_COUNT; ++j) {
        if (is_base(j + 1)) continue;  // the next finger
        ++bones;
        stretch = std::max(stretch, std::abs(distance(result.proxies[j], result.proxies[j + 1]) -
                                             distance(result.joints[j], result.joints[j + 1])));
      }
      EXPECT_EQ(bones, 19);
      EXPECT_NEAR(result.bone_stretch, stretch, 1e-14 * std::max(1.0, whole.scene.hand.scale))
          << whole.name;  // rounding of joints under 1 m
      largest = std::max(largest, stretch);
    });
    EXPECT_GT(largest, 1e-4) << whole.name;
  }
}

// beaker1 is 110 mm high, with a radius of 40 mm.
TEST(Contact, IsUndecidedWhereRoundingMayDecide) {
  const core_f64::Vessel solid = ready_vessel(beaker1()), shell = ready_vessel(shell_of(beaker1()));
  const core_f64::Vec3 beside{0.05, 0.06, 0};
  for (const double off : {0.0, 2.4e-6, -2.4e-6}) {
    EXPECT_TRUE(is_undecided(solid, beside, 0.2e-3 + off, 0.2e-3));
    EXPECT_TRUE(is_undecided(solid, {0, 0.118, 0.04 + off}, 0, 0.2e-3)) << "above the edge of the lid";
    EXPECT_FALSE(is_undecided(shell, {0, 0.118, 0.04 + off}, 0, 0.2e-3)) << "the rim of a shell is glass on both sides";
    EXPECT_FALSE(is_undecided(solid, {0, 0.118, 0.04 + off}, 0.3e-3, 0.2e-3)) << "no contact, whichever is nearer";
    EXPECT_FALSE(is_undecided(solid, {0, 0.109, 0.04 + off}, 0, 0.2e-3)) << "below the mouth";
  }
  for (const double off : {2.6e-6, -2.6e-6}) {
    EXPECT_FALSE(is_undecided(solid, beside, 0.2e-3 + off, 0.2e-3));
    EXPECT_FALSE(is_undecided(solid, {0, 0.118, 0.04 + off}, 0, 0.2e-3));
  }
}

}  // namespace
}  // namespace wholehand

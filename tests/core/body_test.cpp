// SPDX-License-Identifier: MIT
// The hand between its joints: spheres and overlaps of bones in closed form and by brute force, and what a hand with them does: where
// its fingers rest, how deep it is, where it presses.
#include "core/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/effort.h"
#include "core/gather.h"
#include "core/joints.h"
#include "core/vectors.h"
#include "tests/support/capsule_check.h"
#include "tests/support/hard_scene.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Ball;
using core_f64::Vec2;
using core_f64::Vec3;

double bones_overlap(Vec3 a, Vec3 a_end, Vec2 a_radii, Vec3 b, Vec3 b_end, Vec2 b_radii) {
  return core_f64::bones_overlap(a, a_end, a_radii, b, b_end, b_radii, -core_f64::NO_DISTANCE);
}

TEST(Body, ABallLiesEvenlyBetweenItsJoints) {
  const Ball third = core_f64::ball_between({0, 3, -6}, {3, 0, 6}, 8, 5, 1.0 / 3);
  EXPECT_NEAR(third.place.x, 1, 1e-15);
  EXPECT_NEAR(third.place.y, 2, 1e-15);
  EXPECT_NEAR(third.place.z, -2, 1e-15);
  EXPECT_NEAR(third.radius, 7, 1e-15);
  EXPECT_EQ(core_f64::ball_between({1, 2, 3}, {4, 5, 6}, 7, 8, 0).place, Vec3(1, 2, 3));
  EXPECT_EQ(core_f64::ball_between({1, 2, 3}, {4, 5, 6}, 7, 8, 1).radius, 8);
}

TEST(Body, OverlapsOfBonesInClosedForm) {
  const Vec2 thin(1, 1);
  // crossing at right angles, 3 apart; the radii where the axes are nearest: 1/4 and 1/2 of the way
  EXPECT_NEAR(bones_overlap({-1, 0, 0}, {3, 0, 0}, {2, 2.4}, {0, 3, -1}, {0, 3, 1}, {1, 1.2}), 2.1 + 1.1 - 3, 1e-15);
  // end to end in a line, 2 apart
  EXPECT_EQ(bones_overlap({0, 0, 0}, {1, 0, 0}, thin, {3, 0, 0}, {4, 0, 0}, thin), 0);
  EXPECT_EQ(bones_overlap({0, 0, 0}, {1, 0, 0}, thin, {4, 0, 0}, {3, 0, 0}, thin), 0);
  // side by side, the one further along than the other: the nearest places are an end of each
  EXPECT_NEAR(bones_overlap({0, 0, 0}, {1, 0, 0}, thin, {4, 4, 0}, {9, 4, 0}, thin), 2 - 5, 1e-15);
  // side by side as far as both reach
  EXPECT_EQ(bones_overlap({0, 0, 0}, {8, 0, 0}, thin, {2, 0.5, 0}, {20, 0.5, 0}, thin), 1.5);
  // an end over a side, each way round
  EXPECT_NEAR(bones_overlap({0, 0, 0}, {8, 0, 0}, thin, {4, 3, 0}, {4, 9, 0}, thin), -1, 1e-15);
  EXPECT_NEAR(bones_overlap({4, 9, 0}, {4, 3, 0}, thin, {0, 0, 0}, {8, 0, 0}, thin), -1, 1e-15);
  // bones of no length are spheres
  EXPECT_EQ(bones_overlap({0, 0, 0}, {0, 0, 0}, thin, {0, 0, 5}, {0, 0, 5}, {2, 2}), -2);
  EXPECT_EQ(bones_overlap({0, 0, 0}, {0, 0, 0}, thin, {-1, 4, 0}, {1, 4, 0}, {2, 2}), -1);
  EXPECT_EQ(bones_overlap({-1, 4, 0}, {1, 4, 0}, {2, 2}, {0, 0, 0}, {0, 0, 0}, thin), -1);
  // in one place
  EXPECT_EQ(bones_overlap({0, 0, 0}, {1, 1, 1}, thin, {0, 0, 0}, {1, 1, 1}, thin), 2);
}

// Bones of even radius, so that the overlap is the largest of all pairs of spheres: the axes' distance is convex, and a search that
// halves its cells about the best of 9 x 9 places finds it.
TEST(Body, OverlapsAreThoseOfASearch) {
  Random random(20);
  const auto point = [&] { return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 a = point(), b = point(), a_end = point();
    Vec3 b_end = point();
    if (trial % 5 == 0) b_end = b + random.uniform(-2, 2) * (a_end - a);  // parallel
    if (trial % 5 == 1) b_end = b + 1.3 * (a_end - a) + 1e-6 * point();   // nearly
    const double radius = random.uniform(0, 1), other = random.uniform(0, 1);
    double s = 0.5, t = 0.5, step = 0.125, least = 1e9;
    for (int round = 0; round < 60; ++round, step *= 0.6) {
      const double middle_s = s, middle_t = t;
      for (int i = -4; i <= 4; ++i)
        for (int k = -4; k <= 4; ++k) {
          const double at = std::clamp(middle_s + i * step, 0.0, 1.0), to = std::clamp(middle_t + k * step, 0.0, 1.0);
          const double apart = glm::length(a + at * (a_end - a) - b - to * (b_end - b));
          if (apart >= least) continue;
          least = apart;
          s = at;
          t = to;
        }
    }
    const double overlap = bones_overlap(a, a_end, {radius, radius}, b, b_end, {other, other});
    // every pair of places gives a bound from below; along bones that are nearly parallel the search advances slowly
    EXPECT_GT(overlap, radius + other - least - 1e-9) << trial;
    EXPECT_LT(overlap, radius + other - least + (trial % 5 == 1 ? 1e-5 : 1e-9)) << trial;
    EXPECT_NEAR(bones_overlap(b, b_end, {other, other}, a, a_end, {radius, radius}), overlap, 1e-9) << trial;
  }
}

// Rounded cones as slim as fingers: at most the largest overlap of all pairs of spheres and at least that less a millimeter, and no other
// where bones that are parallel turn by a rounding.
TEST(Body, OverlapsOfTaperedBonesAreNearTheLargest) {
  Random random(21);
  const auto point = [&](double size) { return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 a = point(30), b = point(30), along = point(30), a_end = a + along;
    const bool is_parallel = trial % 2 == 0;
    const Vec3 b_end = b + (is_parallel ? random.uniform(-1.5, 1.5) * along : point(30));
    const auto radii = [&] { return Vec2(random.uniform(3, 8), random.uniform(3, 8)); };
    const Vec2 of_a = radii(), of_b = radii();
    double largest = -1e9;
    constexpr int CELLS = 100;
    for (int i = 0; i <= CELLS; ++i)
      for (int k = 0; k <= CELLS; ++k) {
        const double s = double(i) / CELLS, t = double(k) / CELLS;
        const double apart = glm::length(a + s * along - b - t * (b_end - b));
        largest = std::max(largest, of_a.x + s * (of_a.y - of_a.x) + of_b.x + t * (of_b.y - of_b.x) - apart);
      }
    const double overlap = bones_overlap(a, a_end, of_a, b, b_end, of_b);
    EXPECT_GT(overlap, largest - 1) << trial;
    EXPECT_LT(overlap, largest + 0.5) << trial;  // between two cells, of up to 0.5 mm
    if (!is_parallel) continue;
    for (int turn = 0; turn < 4; ++turn)
      EXPECT_NEAR(bones_overlap(a, a_end + point(1e-7), of_a, b, b_end + point(1e-7), of_b), overlap, 1e-4) << trial;
  }
}

// A sphere around a bone holds every sphere of it, and touches the larger one at an end.
TEST(Body, TheSphereAroundABoneHoldsAllOfIt) {
  const Ball by_hand = core_f64::around_bone({{1, 2, 3}, 4}, {{1, 2, 13}, 6});
  EXPECT_EQ(by_hand.place, Vec3(1, 2, 8));
  EXPECT_EQ(by_hand.radius, 5 + 6);
  Random random(23);
  const auto ball = [&] {
    return Ball{30.0 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)), random.uniform(1, 9)};
  };
  for (int trial = 0; trial < 200; ++trial) {
    const Ball start = ball(), end = ball(), around = core_f64::around_bone(start, end);
    double reach = 0;
    for (int k = 0; k <= 64; ++k) {
      const Ball between = core_f64::ball_between(start.place, end.place, start.radius, end.radius, k / 64.0);
      reach = std::max(reach, glm::length(between.place - around.place) + between.radius);
    }
    EXPECT_NEAR(reach, around.radius, 1e-12 * around.radius) << trial;
  }
}

// The limit belongs to those that do not overlap more. Two spheres cannot lie deeper in each other than their radii.
TEST(Body, SpheresOverlapMoreThanADepth) {
  const Ball a{{0, 0, 0}, 3}, b{{3, 4, 0}, 4};  // 2 deep
  EXPECT_TRUE(core_f64::overlap_more(a, b, 1.999));
  EXPECT_FALSE(core_f64::overlap_more(a, b, 2));
  EXPECT_TRUE(core_f64::overlap_more(a, b, -10));
  EXPECT_FALSE(core_f64::overlap_more(a, a, 7));
  EXPECT_FALSE(core_f64::overlap_more(a, b, 20)) << "a reach below 0 is not squared";
}

// A search skips only bones that cannot be the deepest: from any depth so far it gives the larger of that depth and the overlap. The bounds round, by
// some units of 100 mm.
TEST(Body, BonesThatCannotBeTheDeepestArePassedBy) {
  Random random(22);
  const auto point = [&](double size) { return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  const auto radii = [&] { return Vec2(random.uniform(3, 8), random.uniform(3, 8)); };
  int passed = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 a = point(60), b = point(60), a_end = a + point(30), b_end = b + (trial % 3 == 0 ? a_end - a : point(30));
    const Vec2 of_a = radii(), of_b = radii();
    const double overlap = bones_overlap(a, a_end, of_a, b, b_end, of_b);
    const Ball around_a = core_f64::around_bone({a, of_a.x}, {a_end, of_a.y}),
               around_b = core_f64::around_bone({b, of_b.x}, {b_end, of_b.y});
    for (const double deepest : {-200.0, overlap - 1e-6, overlap, overlap + 1e-6, overlap + random.uniform(-30, 30), 50.0}) {
      const double looked = core_f64::bones_overlap(a, a_end, of_a, b, b_end, of_b, deepest);
      EXPECT_NEAR(looked, std::max(deepest, overlap), 1e-12) << trial;
      if (core_f64::overlap_more(around_a, around_b, deepest)) continue;
      EXPECT_LE(overlap, deepest + 1e-12) << trial;
      ++passed;
    }
  }
  EXPECT_GT(passed, 1000);
}

// ---- of whole grips ----

struct BodyScene {
  Scene scene;
  std::unique_ptr<Evaluator> core;
  BodyScene(Scene of, int between) : scene(std::move(of)) {
    scene.hand.between = between;
    core = make_core_evaluator(scene);
  }
};

struct FoundBall {
  int digit = 0, joint = 0, between = 0;  // the joint at which the bone ends
  bool is_metacarpal = false;
  Triple place{};
  double radius = 0, separation = 0;
};

std::vector<FoundBall> balls_of(const BodyScene& on, const GripInput& grip, const GripResult& result) {
  const double scale = on.scene.hand.scale * grip.hand_scale;
  std::vector<FoundBall> balls;
  for (int f = 0; f < FINGER_COUNT; ++f)
    for (int bone = 0; bone + 1 < finger_joints(f); ++bone) {
      const auto& radii = on.scene.hand.fingers[f].radii;
      const int n = on.scene.hand.between, joint = finger_start(f) + bone;
      for (int k = 1; k <= n; ++k) {
        FoundBall ball{f, joint + 1, k, bone == 0, {}, scale * (radii[bone] * (n + 1 - k) + radii[bone + 1] * k) / (n + 1)};
        for (int c = 0; c < 3; ++c)
          ball.place[c] = (result.posed[joint][c] * (n + 1 - k) + result.posed[joint + 1][c] * k) / (n + 1);
        ball.separation = on.core->distance(0, ball.place) - ball.radius;
        balls.push_back(ball);
      }
    }
  return balls;
}

// Calls `look` with every feasible grip of hands of several kinds and poses, with so many spheres on a bone.
template <class Look>
int each_grip(std::vector<Pose> poses, const Look& look, int count = 60) {
  int feasible = 0, between = 0;
  for (const HandData& hand : {paper_hand(), odd_hand(), large_hand()})
    for (const Pose pose : poses)
      for (const VesselData& shape : {beaker1(), beaker3()}) {
        const VesselData vessel = scaled(shape, hand.scale);
        between = between % 8 + 1;
        const BodyScene on(scene_of({vessel}, pose, hand), between);
        for (GripInput grip : sample_grips(vessel, count, 77)) {
          grip.hand_scale = 0.9 + 0.005 * (feasible % 40);
          GripResult result;
          on.core->grip(0, grip, result);
          if (result.reason != Reason::none) {
            EXPECT_TRUE(std::isnan(result.self_depth));
            continue;
          }
          ++feasible;
          look(on, grip, result);
        }
      }
  return feasible;
}

const std::vector<Pose> POSES{Pose::articulated, Pose::paper, Pose::rigged};

TEST(Body, DepthsCountTheSpheresOfTheBones) {
  int deeper = 0, implausible = 0, judged_out = 0;
  const int feasible = each_grip(POSES, [&](const BodyScene& on, const GripInput& grip, const GripResult& result) {
    double palm = 0, phalanx = 0, judged = 0, of_joints = 0;
    const auto add = [&](int digit, bool is_palm, double separation) {
      (is_palm ? palm : phalanx) = std::max(is_palm ? palm : phalanx, -separation);
      if (digit < 2 || on.scene.pose != Pose::paper) judged = std::max(judged, -separation);
    };
    for (int j = 0; j < JOINT_COUNT; ++j) {
      add(finger_of(j), j == finger_start(finger_of(j)), result.separation[j]);
      of_joints = std::max(of_joints, -result.separation[j]);
    }
    for (const FoundBall& ball : balls_of(on, grip, result)) add(ball.digit, ball.is_metacarpal, ball.separation);
    // m: roundings of places of the size of the hand
    EXPECT_NEAR(result.palm_depth, palm, 1e-13);
    EXPECT_NEAR(result.phalanx_depth, phalanx, 1e-13);
    const double limit = on.scene.hand.depth_limit;
    EXPECT_EQ(result.self_overlap, result.self_depth > limit);
    EXPECT_EQ(result.plausible, judged <= limit && result.self_depth <= limit) << judged << " " << result.self_depth;
    deeper += std::max(palm, phalanx) > of_joints + 1e-6;
    implausible += !result.plausible;
    judged_out += judged > limit && of_joints <= limit;
  });
  EXPECT_GT(feasible, 500);
  EXPECT_GT(deeper, 20);
  EXPECT_GT(implausible, 20);
  EXPECT_GT(judged_out, 2) << "in none is it a sphere alone that makes the grip implausible";
}

// Other code finds the largest overlap of all pairs of spheres on two bones, which lie about 1.1 mm apart in a hand of scale 1. It may be smaller by
// the distance from the nearest places to the nearest samples, or larger by the bones' tapers: see docs/method.md.
TEST(Body, SelfDepthIsTheLargestOverlapOfTwoDigits) {
  int overlapping = 0, near = 0;
  double widest = 0;
  each_grip(
      POSES,
      [&](const BodyScene& on, const GripInput& grip, const GripResult& result) {
        const CapsuleCheck check = check_capsules(on.scene, *on.core, 0, grip, result);
        double taper = 0, step = 0;
        for (const CheckedBone& bone : check.bones) {
          taper = std::max(taper, std::abs(bone.start_radius - bone.end_radius));
          step = std::max(step, bone.length() / 64);
        }
        EXPECT_GT(result.self_depth, check.overlap - 2 * taper);
        EXPECT_LT(result.self_depth, check.overlap + step);
        // the two other hands have radii of 7 to 8 mm, times their scale
        if (taper <= 0.5e-3 * on.scene.hand.scale * grip.hand_scale)
          widest = std::max(widest, (check.overlap - result.self_depth) / on.scene.hand.scale);
        overlapping += result.self_depth > 0;
        near += result.self_depth > -3e-3;
      },
      20);
  EXPECT_GT(overlapping, 2);
  EXPECT_GT(near, 5);
  EXPECT_GT(widest, 0) << "the sample has no hand of nearly even radii";
  EXPECT_LT(widest, 0.05e-3);
}

// Skipped pairs change nothing: the depth is the largest overlap of all pairs, or of two spheres at the same joint of neighboring fingers.
TEST(Body, SelfDepthLeavesOutNoPairOfBones) {
  int from_joints = 0, grips = 0;
  each_grip(
      POSES,
      [&](const BodyScene& on, const GripInput& grip, const GripResult& result) {
        const double scale = on.scene.hand.scale * grip.hand_scale;
        const auto place = [&](int joint) { return Vec3(result.posed[joint][0], result.posed[joint][1], result.posed[joint][2]); };
        const auto radius = [&](int f, int k) { return scale * on.scene.hand.fingers[f].radii[k]; };
        double of_bones = -1e9, of_joints = -1e9;
        for (int f = 0; f < FINGER_COUNT; ++f)
          for (int g = f + 1; g < FINGER_COUNT; ++g) {
            for (int bone = 1; bone + 1 < finger_joints(f); ++bone)
              for (int other = 1; other + 1 < finger_joints(g); ++other) {
                const int j = finger_start(f) + bone, i = finger_start(g) + other;
                of_bones = std::max(of_bones, bones_overlap(place(j), place(j + 1), {radius(f, bone), radius(f, bone + 1)},
                                                            place(i), place(i + 1), {radius(g, other), radius(g, other + 1)}));
              }
            if (f == 0 || g != f + 1) continue;
            for (int k = 2; k < 5; ++k) {
              const double apart = glm::length(place(finger_start(f) + k) - place(finger_start(g) + k));
              of_joints = std::max(of_joints, radius(f, k) + radius(g, k) - apart);
            }
          }
        EXPECT_NEAR(result.self_depth, std::max(of_bones, of_joints), 1e-12);
        from_joints += of_joints > of_bones + 1e-9;
        ++grips;
      },
      20);
  EXPECT_GT(grips, 100);
  EXPECT_LT(from_joints, grips / 2);
}

// A finger comes to rest before any of its moving spheres is inside. Some spheres touch where no joint does.
TEST(Body, FingersRestBeforeTheirSpheresAreInside) {
  int touching = 0, rests = 0;
  each_grip({Pose::articulated}, [&](const BodyScene& on, const GripInput& grip, const GripResult& result) {
    for (int f = 2; f < FINGER_COUNT; ++f) {
      if ((result.status >> (STATUS_BLOCKED_SHIFT + f) & 1) != 0) continue;
      EXPECT_EQ(result.status >> (STATUS_UNSETTLED_SHIFT + f) & 1, 0u);
      ++rests;
      for (int k = 2; k < 5; ++k) EXPECT_GT(result.separation[finger_start(f) + k], -2e-9);
      for (const FoundBall& ball : balls_of(on, grip, result)) {
        if (ball.digit != f || ball.is_metacarpal) continue;
        // m: a step ends within the stop tolerance of 1e-9 of the surface
        EXPECT_GT(ball.separation, -2e-9) << "finger " << f << ", sphere " << ball.between << " before joint " << ball.joint;
        touching += ball.separation < 1e-8 && result.separation[ball.joint] > 1e-3 && result.separation[ball.joint - 1] > 1e-3;
      }
    }
  });
  EXPECT_GT(rests, 200);
  EXPECT_GT(touching, 50);
}

// With spheres between the joints, the side of a bone rests on the glass; without them, only its joints do.
TEST(Body, MoreSpheresKeepTheBonesFurtherOut) {
  std::array<double, 3> deepest{};
  for (const int between : {0, 2, 8}) {
    const BodyScene on(scene_of({beaker1()}), between);
    double& worst = deepest[between == 0 ? 0 : between == 2 ? 1 : 2];
    for (const GripInput& grip : sample_grips(beaker1(), 60, 5)) {
      GripResult result;
      on.core->grip(0, grip, result);
      if (result.reason != Reason::none) continue;
      const CapsuleCheck check = check_capsules(on.scene, *on.core, 0, grip, result);
      for (const CheckedBone& bone : check.bones) {
        const bool moved = bone.finger >= 2 && !bone.is_metacarpal;
        if (moved && (result.status >> (STATUS_BLOCKED_SHIFT + bone.finger) & 1) == 0) worst = std::max(worst, bone.depth);
      }
    }
  }
  EXPECT_GT(deepest[0], 1e-3);
  EXPECT_LT(deepest[1], 0.5 * deepest[0]);
  EXPECT_LT(deepest[2], 0.2 * deepest[1]);
}

TEST(Body, SpheresPressWhereTheirDigitHasRoom) {
  int pressing = 0, left_out = 0;
  each_grip(POSES, [&](const BodyScene& on, const GripInput& grip, const GripResult& result) {
    const std::vector<GripContact> contacts = on.core->contacts(0, result);
    EXPECT_LE(contacts.size(), std::size_t{JOINT_COUNT});
    const double tolerance = on.scene.hand.contact_tolerance;
    std::array<int, FINGER_COUNT + 1> count{};
    std::vector<FoundBall> touching;
    for (const FoundBall& ball : balls_of(on, grip, result))
      if (ball.separation <= tolerance) touching.push_back(ball);
    for (const GripContact& contact : contacts) {
      ++count[contact.digit];
      EXPECT_NEAR(on.core->distance(0, contact.point), 0, 1e-12);
      if (contact.between == 0) {
        EXPECT_NE(result.touch_mask >> contact.joint & 1, 0u);
        continue;
      }
      ++pressing;
      const auto found = std::find_if(touching.begin(), touching.end(), [&](const FoundBall& ball) {
        return ball.joint == contact.joint && ball.between == contact.between;
      });
      ASSERT_NE(found, touching.end());
      EXPECT_EQ(contact.digit, found->is_metacarpal ? FINGER_COUNT : found->digit);
      const double apart =
          std::hypot(contact.point[0] - found->place[0], contact.point[1] - found->place[1], contact.point[2] - found->place[2]);
      EXPECT_NEAR(apart, std::abs(found->separation + found->radius), 1e-12);
    }
    for (int f = 0; f < FINGER_COUNT; ++f) EXPECT_LE(count[f], finger_joints(f) - 1);
    EXPECT_LE(count[FINGER_COUNT], FINGER_COUNT);
    // the lid takes no contact, so a sphere may touch it, have room, and still be no contact
    const auto of_digit = [&](int digit, bool is_palm) {
      return std::count_if(touching.begin(), touching.end(),
                           [&](const FoundBall& ball) { return ball.digit == digit && ball.is_metacarpal == is_palm; });
    };
    for (int f = 0; f < FINGER_COUNT; ++f) {
      const int joints = std::popcount(result.touch_mask >> (finger_start(f) + 1) & ((1u << (finger_joints(f) - 1)) - 1));
      left_out += joints + of_digit(f, false) > finger_joints(f) - 1;
    }
  });
  EXPECT_GT(pressing, 300);
  EXPECT_GT(left_out, 0) << "in none is a digit's room too small";
}

// The cost of a digit's limited room: the effort with the contacts that fit, against the effort with every touching sphere.
TEST(Body, SpheresThatHaveNoRoomHardlyMatter) {
  int grips = 0, with_spheres = 0, fewer = 0, much = 0;
  double most = 0;
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3()}) {
    const BodyScene on(scene_of({vessel}), 2);
    const core_f64::HandStrength hand{0.6, 5e-3, StrengthData{}.digits};
    for (const GripInput& grip : sample_grips(vessel, 150, 31)) {
      GripResult result;
      on.core->grip(0, grip, result);
      if (!result.plausible) continue;
      std::vector<core_f64::ContactPoint> some, all;
      for (const GripContact& contact : on.core->contacts(0, result)) {
        some.push_back({to_vec3<double>(contact.point), to_vec3<double>(contact.normal), contact.digit});
        if (contact.between == 0) all.push_back(some.back());
      }
      with_spheres += all.size() < some.size();
      for (const FoundBall& ball : balls_of(on, grip, result)) {
        if (ball.separation > on.scene.hand.contact_tolerance) continue;
        const Vec3 outward = to_vec3<double>(on.core->gradient(0, ball.place));
        all.push_back({to_vec3<double>(ball.place) - (ball.separation + ball.radius) * outward, -outward,
                       ball.is_metacarpal ? FINGER_COUNT : ball.digit});
      }
      ++grips;
      const Vec3 center(0, 50e-3, 0), up(std::sin(1.0), std::cos(1.0), 0);
      const auto effort = [&](const std::vector<core_f64::ContactPoint>& contacts) {
        core_f64::EffortSolver solver(contacts, hand, center);
        return solver.solve(core_f64::wrench_at(center, -2.0 * up)).effort;
      };
      const double of_some = effort(some), of_all = effort(all);
      if (std::isinf(of_some) && std::isinf(of_all)) continue;
      EXPECT_GE(of_some, of_all * (1 - 1e-3)) << "contacts more never raise an effort";
      fewer += all.size() > some.size();
      much += of_some > 1.01 * of_all;
      most = std::max(most, of_some / of_all - 1);
    }
  }
  RecordProperty("grips", grips);
  RecordProperty("with_spheres", with_spheres);
  RecordProperty("fewer", fewer);
  RecordProperty("much", much);
  RecordProperty("most", std::to_string(most));
  EXPECT_GT(with_spheres, 50);
  EXPECT_GT(fewer, 20);
  EXPECT_LE(100 * much, grips);
}

TEST(Body, WithoutSpheresThereIsNothingOfThem) {
  const Scene scene = hard_scene();
  EXPECT_FALSE(all_fields(scene).has(FIELD_SELF_DEPTH));
  GripResult result;
  make_core_evaluator(scene)->grip(0, {0.055, 0, 0, 0, 0, 1}, result);
  EXPECT_TRUE(std::isnan(result.self_depth));
  EXPECT_FALSE(result.self_overlap);
}

TEST(Body, ALeftHandIsAsDeepAsTheRight) {
  BodyScene right(scene_of({beaker3()}), 3);
  Scene mirrored_scene = right.scene;
  mirrored_scene.hand.handedness = Handedness::left;
  const BodyScene left(mirrored_scene, 3);
  int feasible = 0;
  for (const GripInput& grip : sample_grips(beaker3(), 40, 3)) {
    const GripInput mirrored = mirrored_grip(grip);
    GripResult of_right, of_left;
    right.core->grip(0, grip, of_right);
    left.core->grip(0, mirrored, of_left);
    ASSERT_EQ(of_left.reason, of_right.reason);
    if (of_right.reason != Reason::none) continue;
    ++feasible;
    // m: pi - (pi - a) is a to rounding, and fingers stop within the stop tolerance
    EXPECT_NEAR(of_left.self_depth, of_right.self_depth, 1e-8);
    EXPECT_NEAR(of_left.phalanx_depth, of_right.phalanx_depth, 1e-8);
    EXPECT_EQ(left.core->contacts(0, of_left).size(), right.core->contacts(0, of_right).size());
  }
  EXPECT_GT(feasible, 15);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
// Kernel 5: middle, ring and little finger come to rest on the vessel. The poses are compared with a simulation of the
// specification by dense sampling and bisection: nothing in it advances conservatively.
#include "core/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "core/evaluator.h"
#include "tests/support/scenes.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::FingerFrame;
using core_f64::FingerMotion;
using core_f64::FingerPoints;
using core_f64::Vec3;

constexpr double TOUCHING = 1e-9;  // m: the specification's, in double
constexpr double SAMPLE = 0.2e-3;  // m: no watched point moves further between two samples
constexpr double DOUBT = 1e-7;     // m: separations that are nearer to a decision than this are left out, and counted
constexpr double GRAZING = 0.05;   // approach speed over the largest speed under which a touch is left out, and counted

std::size_t first_joint(int finger) { return static_cast<std::size_t>(finger == 0 ? 0 : 4 + 5 * (finger - 1)); }

// One finger in the vessel frame, read off the rigged hand.
struct Placed {
  Vec3 base, mcp, forward, palmward;
  std::array<double, 4> length;
  std::array<double, 5> radius;
};

Placed placed_finger(const HandData& hand, const GripResult& result, int finger, double hand_scale) {
  Placed placed;
  const std::size_t j = first_joint(finger);
  const FingerData& data = hand.fingers[static_cast<std::size_t>(finger)];
  for (std::size_t k = 0; k < 4; ++k) placed.length[k] = hand.scale * hand_scale * data.segments[k];
  for (std::size_t k = 0; k < 5; ++k) placed.radius[k] = hand.scale * hand_scale * data.radii[k];
  placed.base = vec(result.joints[j]);
  placed.mcp = vec(result.joints[j + 1]);
  placed.forward = (placed.mcp - placed.base) / placed.length[0];
  // the whole finger lies in one plane; its tip is far from the metacarpal's line
  const Vec3 tip = vec(result.joints[j + 4]) - placed.base;
  placed.palmward = glm::normalize(tip - glm::dot(tip, placed.forward) * placed.forward);
  return placed;
}

// PIP, DIP, tip for joint angles, in the finger's plane.
std::array<Vec3, 3> watched_points(const Placed& finger, const Vec3& angles) {
  std::array<Vec3, 3> points;
  Vec3 at = finger.mcp;
  double angle = 0;
  for (int k = 0; k < 3; ++k) {
    angle += angles[k];
    at += finger.length[static_cast<std::size_t>(k) + 1] * (std::cos(angle) * finger.forward + std::sin(angle) * finger.palmward);
    points[static_cast<std::size_t>(k)] = at;
  }
  return points;
}

// The same by the specification's rotation matrices, R = Rx(-MCP) Rx(-PIP) Rx(-DIP) after the metacarpal's frame.
std::array<Vec3, 3> watched_points_by_matrices(const Placed& finger, const Vec3& angles) {
  const Vec3 y = -finger.palmward, z = -finger.forward, x = glm::cross(y, z);
  LongRotation R = rotation_x(0);
  Long3 at{0, 0, -static_cast<long double>(finger.length[0])};
  std::array<Vec3, 3> points;
  for (int k = 0; k < 3; ++k) {
    R = R * rotation_x(-static_cast<long double>(angles[k]));
    at = at + R * Long3{0, 0, -static_cast<long double>(finger.length[static_cast<std::size_t>(k) + 1])};
    points[static_cast<std::size_t>(k)] =
        finger.base + static_cast<double>(at[0]) * x + static_cast<double>(at[1]) * y + static_cast<double>(at[2]) * z;
  }
  return points;
}

// Joint angles MCP, PIP, DIP of a finger as posed, and how far it leaves its plane (m).
Vec3 angles_of(const Placed& finger, const GripResult& result, int index, double& out_of_plane) {
  const std::size_t j = first_joint(index);
  const Vec3 normal = glm::cross(finger.forward, finger.palmward);
  Vec3 angles{};
  double before = 0;
  out_of_plane = 0;
  for (int k = 0; k < 3; ++k) {
    const auto i = j + 1 + static_cast<std::size_t>(k);
    const Vec3 bone = vec(result.posed[i + 1]) - vec(result.posed[i]);
    const double angle = std::atan2(glm::dot(bone, finger.palmward), glm::dot(bone, finger.forward));
    angles[k] = std::remainder(angle - before, 2 * PI);
    before = angle;
    out_of_plane = std::max(out_of_plane, std::abs(glm::dot(bone, normal)));
  }
  return angles;
}

// ---- the first zero of a separation, by samples and bisection ----

struct Crossing {
  bool found = false;
  bool doubtful = false;  // within DOUBT of another outcome, or met at a grazing angle
  double at = 0;
};

// f over [0, end], in m; `speed` bounds its slope.
Crossing first_zero(const std::function<double(double)>& f, double end, double speed) {
  Crossing crossing;
  const double first = f(0);
  if (first < TOUCHING) {
    crossing.found = true;
    return crossing;
  }
  crossing.doubtful = first < DOUBT;
  if (end <= 0) return crossing;
  const auto bisect = [&](double outside, double inside) {
    for (int i = 0; i < 80; ++i) {
      const double middle = (outside + inside) / 2;
      (f(middle) > 0 ? outside : inside) = middle;
    }
    crossing.found = true;
    crossing.at = outside;
    const double back = std::min(outside, 1e-6 / speed);
    crossing.doubtful = crossing.doubtful || !(f(outside - back) - f(outside) > GRAZING * back * speed);
  };
  const int n = std::max(3, static_cast<int>(std::ceil(end * speed / SAMPLE)));
  double before_last = first, last = first;
  for (int i = 1; i <= n; ++i) {
    const double u = end * i / n, value = f(u);
    if (value <= 0) {
      bisect(end * (i - 1) / n, u);
      return crossing;
    }
    // a dip that two samples enclose
    if (last <= before_last && last <= value && last < SAMPLE) {
      double low = end * std::max(0, i - 2) / n, high = u;
      const double start = low, ratio = (std::sqrt(5.0) - 1) / 2;
      for (int k = 0; k < 70; ++k) {
        const double left = high - ratio * (high - low), right = low + ratio * (high - low);
        (f(left) < f(right) ? high : low) = f(left) < f(right) ? right : left;
      }
      const double least = f((low + high) / 2);
      if (std::abs(least) < DOUBT) crossing.doubtful = true;
      if (least < 0) {
        bisect(start, (low + high) / 2);
        return crossing;
      }
    }
    before_last = last;
    last = value;
  }
  if (last < DOUBT) crossing.doubtful = true;
  return crossing;
}

// ---- `articulated`, simulated ----

struct Rest {
  Vec3 angles{};
  Vec3 before{};  // separations when it left the trajectory
  bool blocked = false, doubtful = false, touched = false;
  double left_at = 0;  // closure at which it left the trajectory
};

Rest simulate(const Evaluator& evaluator, const HandData& hand, const Placed& finger, double closure) {
  Rest rest;
  const auto separations = [&](const Vec3& angles) {
    const auto points = watched_points(finger, angles);
    Vec3 result{};
    for (std::size_t k = 0; k < 3; ++k)
      result[static_cast<int>(k)] = evaluator.distance(0, triple(points[k])) - finger.radius[k + 2];
    return result;
  };
  const auto least = [&](const Vec3& s, int from) {
    double result = s[2];
    for (int k = from; k < 3; ++k) result = std::min(result, s[k]);
    return result;
  };
  // the smallest separation's point, of equal ones the innermost
  const auto nearest = [&](const Vec3& s, int from) {
    int at = from;
    for (int k = from + 1; k < 3; ++k) at = s[k] < s[at] ? k : at;
    for (int k = from; k < 3; ++k) rest.doubtful = rest.doubtful || (k != at && s[k] - s[at] < DOUBT);
    return at;
  };
  const auto trajectory = [&](double c) {
    const Long3 angles = reference_finger_angles(hand, c);
    return Vec3{static_cast<double>(angles[0]), static_cast<double>(angles[1]), static_cast<double>(angles[2])};
  };
  const double reach[3] = {finger.length[1] + finger.length[2] + finger.length[3], finger.length[2] + finger.length[3],
                           finger.length[3]};

  rest.angles = trajectory(0);
  rest.before = separations(rest.angles);
  const double open = least(rest.before, 0);
  rest.doubtful = std::abs(open) < DOUBT;
  if (open < 0) {
    rest.blocked = true;
    return rest;
  }
  const Vec3 swing = trajectory(1) - trajectory(0);
  const double speed = std::abs(swing.x) * reach[0] + std::abs(swing.y) * reach[1] + std::abs(swing.z) * reach[2];
  const Crossing closing = first_zero([&](double c) { return least(separations(trajectory(c)), 0); }, closure, speed);
  rest.doubtful = rest.doubtful || closing.doubtful;
  rest.left_at = closing.found ? closing.at : closure;
  rest.angles = trajectory(rest.left_at);
  rest.before = separations(rest.angles);
  int joint = closing.found ? nearest(rest.before, 0) + 1 : 0;
  rest.touched = closing.found;
  while (joint < 3) {
    const double start = rest.angles[joint];
    const double room = std::max(0.0, std::min(hand.max_angle, hand.joint_limit[static_cast<std::size_t>(joint)] - start));
    const auto turned = [&](double angle) {
      Vec3 angles = rest.angles;
      angles[joint] = start + angle;
      return angles;
    };
    const Crossing touch = first_zero([&](double angle) { return least(separations(turned(angle)), joint); }, room, reach[joint]);
    rest.doubtful = rest.doubtful || touch.doubtful;
    rest.angles = turned(touch.found ? touch.at : room);
    rest.touched = rest.touched || touch.found;
    joint = touch.found ? nearest(separations(rest.angles), joint) + 1 : joint + 1;
  }
  return rest;
}

// ---- scenes ----

struct Case {
  std::string name;
  Scene scene;
};

HandData with_limits(double mcp_deg, double pip_deg, double dip_deg, double max_angle_deg) {
  HandData hand;
  hand.joint_limit = {radians(mcp_deg), radians(pip_deg), radians(dip_deg)};
  hand.max_angle = radians(max_angle_deg);
  return hand;
}

std::vector<Case> cases(Pose pose) {
  return {{"beaker1", scene_of({beaker1()}, pose)},
          {"beaker2", scene_of({beaker2()}, pose)},
          {"beaker3", scene_of({beaker3()}, pose)},
          {"vase", scene_of({vase()}, pose)},
          {"ledges", scene_of({ledges()}, pose)},
          {"coin", scene_of({cylinder("coin", 60, 14, 1)}, pose)},
          {"shell", scene_of({shell_of(vase())}, pose)},
          {"odd", scene_of({vase()}, pose, odd_hand())},
          {"tight", scene_of({beaker2()}, pose, with_limits(40, 30, 20, 12))},  // limits that the trajectory itself passes
          {"tiny", scene_of({scaled(beaker3(), 0.1)}, pose, tiny_hand())},
          {"large", scene_of({scaled(ledges(), 3)}, pose, large_hand())}};
}

// Calls `check` for each feasible grip of a sample of `count`; returns how many there were.
template <class Check>
int for_each_grip(const Case& one, int count, Check check) {
  const auto evaluator = make_core_evaluator(one.scene);
  int feasible = 0;
  for (GripInput grip : sample_grips(one.scene.vessels[0], count, 41)) {
    grip.hand_scale = 0.95 + 0.05 * std::sin(100 * grip.azimuth);
    GripResult result;
    evaluator->grip(0, grip, result);
    if (result.reason != Reason::none) continue;
    ++feasible;
    check(*evaluator, grip, result);
  }
  return feasible;
}

// ---- articulated ----

TEST(Articulated, BonesKeepTheirLengths) {
  for (const Case& one : cases(Pose::articulated)) {
    const int feasible = for_each_grip(one, 100, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
      for (int finger = 0; finger < FINGER_COUNT; ++finger) {
        const FingerData& data = one.scene.hand.fingers[static_cast<std::size_t>(finger)];
        for (std::size_t k = 0; k < (finger == 0 ? 3u : 4u); ++k) {
          const std::size_t j = first_joint(finger) + k;
          const double bone = glm::distance(vec(result.posed[j + 1]), vec(result.posed[j]));
          ASSERT_NEAR(bone, one.scene.hand.scale * grip.hand_scale * data.segments[k], 1e-12) << one.name << ", joint " << j;
        }
      }
    });
    EXPECT_GT(feasible, 40) << one.name;
  }
}

TEST(Articulated, FingersStayInTheirPlanesAndLimits) {
  for (const Case& one : cases(Pose::articulated)) {
    const HandData& hand = one.scene.hand;
    for_each_grip(one, 100, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        double out_of_plane = 0;
        const Vec3 angles = angles_of(placed_finger(hand, result, finger, grip.hand_scale), result, finger, out_of_plane);
        EXPECT_LT(out_of_plane, 1e-12) << one.name;  // m: rounding, the plane being known from the rigged hand to 1e-15 / sin
        const Long3 open = reference_finger_angles(hand, 0), reached = reference_finger_angles(hand, result.closure);
        for (int k = 0; k < 3; ++k) {
          const auto i = static_cast<std::size_t>(k);
          // 1e-9 rad: angles are read off bones of 2 mm and more, known to 1e-15 m
          EXPECT_GT(angles[k], static_cast<double>(open[i]) - 1e-9) << one.name;
          EXPECT_LT(angles[k], static_cast<double>(reached[i]) + hand.max_angle + 1e-9) << one.name << ", joint " << k;
          // the limit holds for what a joint turns by itself, not for the trajectory
          EXPECT_LT(angles[k], std::max(hand.joint_limit[i], static_cast<double>(reached[i])) + 1e-9)
              << one.name << ", joint " << k;
        }
      }
    });
  }
}

TEST(Articulated, ThumbAndIndexStayAsRigged) {
  for (const Pose pose : {Pose::articulated, Pose::paper, Pose::rigged}) {
    for (const Case& one : cases(pose)) {
      for_each_grip(one, 40, [&](const Evaluator&, const GripInput&, const GripResult& result) {
        for (std::size_t j = 0; j <= INDEX_TIP; ++j) EXPECT_EQ(result.posed[j], result.joints[j]) << one.name;
        for (int finger = 2; finger < FINGER_COUNT; ++finger) {  // nor do bases and MCPs move
          EXPECT_EQ(result.posed[first_joint(finger)], result.joints[first_joint(finger)]);
          EXPECT_EQ(result.posed[first_joint(finger) + 1], result.joints[first_joint(finger) + 1]);
        }
      });
    }
  }
}

TEST(Articulated, FreeFingerEndsNoDeeperThanTheStopTolerance) {
  int free = 0;
  for (const Case& one : cases(Pose::articulated)) {
    for_each_grip(one, 200, [&](const Evaluator& evaluator, const GripInput& grip, const GripResult& result) {
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        if (result.status >> (STATUS_BLOCKED_SHIFT + finger) & 1) continue;
        ++free;
        const Placed placed = placed_finger(one.scene.hand, result, finger, grip.hand_scale);
        for (std::size_t k = 2; k < 5; ++k) {
          const std::size_t j = first_joint(finger) + k;
          ASSERT_GE(result.separation[j], -TOUCHING) << one.name << ", joint " << j;
          ASSERT_GE(evaluator.distance(0, result.posed[j]) - placed.radius[k], -TOUCHING - 1e-15) << one.name << ", joint " << j;
        }
      }
    });
  }
  EXPECT_GT(free, 1000);
}

TEST(Articulated, AgreesWithDenseSampling) {
  int compared = 0, left_out = 0;
  double worst = 0;
  for (const Case& one : cases(Pose::articulated)) {
    const HandData& hand = one.scene.hand;
    int here = 0;
    for_each_grip(one, 60, [&](const Evaluator& evaluator, const GripInput& grip, const GripResult& result) {
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        EXPECT_FALSE(result.status >> (STATUS_UNSETTLED_SHIFT + finger) & 1) << one.name;
        const Placed placed = placed_finger(hand, result, finger, grip.hand_scale);
        const Rest rest = simulate(evaluator, hand, placed, result.closure);
        if (rest.doubtful) {
          ++left_out;
          continue;
        }
        ++here;
        ASSERT_EQ((result.status >> (STATUS_BLOCKED_SHIFT + finger) & 1) != 0, rest.blocked) << one.name;
        const auto expected = watched_points_by_matrices(placed, rest.angles), planar = watched_points(placed, rest.angles);
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_LT(glm::distance(expected[k], planar[k]), 1e-12 * std::max(1.0, hand.scale));  // the simulation's own shortcut
          const double off = glm::distance(vec(result.posed[first_joint(finger) + 2 + k]), expected[k]);
          worst = std::max(worst, off / std::max(1.0, hand.scale));
          // 1e-7 m: a touch is 1e-9 m early, at most 1e-9 / 0.05 along the way, and a finger touches three times at most
          ASSERT_LT(off, 1e-7 * std::max(1.0, hand.scale)) << one.name << ", finger " << finger << ", point " << k;
        }
      }
    });
    EXPECT_GT(here, 80) << one.name;
    compared += here;
  }
  RecordProperty("compared", compared);
  RecordProperty("left_out", left_out);
  RecordProperty("worst_nm", static_cast<int>(worst * 1e9));
  EXPECT_LT(left_out, compared / 100);
}

TEST(Articulated, BlockedFingersAreReportedAndStayOpen) {
  int blocked = 0, free = 0;
  for (const Case& one : cases(Pose::articulated)) {
    const HandData& hand = one.scene.hand;
    const Long3 open = reference_finger_angles(hand, 0);
    for_each_grip(one, 200, [&](const Evaluator& evaluator, const GripInput& grip, const GripResult& result) {
      EXPECT_EQ(result.status >> STATUS_BLOCKED_SHIFT & 3u, 0u);  // thumb and index finger never
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        const Placed placed = placed_finger(hand, result, finger, grip.hand_scale);
        const auto points =
            watched_points(placed, {static_cast<double>(open[0]), static_cast<double>(open[1]), static_cast<double>(open[2])});
        double least = 1;
        for (std::size_t k = 0; k < 3; ++k)
          least = std::min(least, evaluator.distance(0, triple(points[k])) - placed.radius[k + 2]);
        if (std::abs(least) < 1e-12) continue;  // rounding of the open posture
        const bool is_blocked = result.status >> (STATUS_BLOCKED_SHIFT + finger) & 1;
        EXPECT_EQ(is_blocked, least < 0) << one.name << ", finger " << finger << ", separation " << least;
        ++(is_blocked ? blocked : free);
        if (!is_blocked) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_LT(glm::distance(points[k], vec(result.posed[first_joint(finger) + 2 + k])), 1e-12 * std::max(1.0, hand.scale));
          EXPECT_EQ((result.tip_mask | result.finger_mask | result.inner_mask) >> (first_joint(finger) + 2 + k) & 1u, 0u);
        }
      }
    });
  }
  EXPECT_GT(blocked, 100);
  EXPECT_GT(free, 1000);
}

TEST(Articulated, ResultDoesNotDependOnTheOrderOfFingers) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    for (const Case& one : cases(pose)) {
      Scene swapped = one.scene;
      std::swap(swapped.hand.fingers[2], swapped.hand.fingers[3]);  // middle and ring
      const auto other = make_core_evaluator(swapped);
      for_each_grip(one, 60, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
        GripResult exchanged;
        other->grip(0, grip, exchanged);
        ASSERT_EQ(exchanged.reason, Reason::none);
        for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
          const std::size_t twin = j >= 9 && j < 14 ? j + 5 : j >= 14 && j < 19 ? j - 5 : j;
          EXPECT_EQ(result.posed[j], exchanged.posed[twin]) << one.name << ", joint " << j;  // bit for bit
          EXPECT_EQ(result.proxies[j], exchanged.proxies[twin]);
          EXPECT_EQ(result.separation[j], exchanged.separation[twin]);
          for (const auto mask :
               {&GripResult::touch_mask, &GripResult::tip_mask, &GripResult::finger_mask, &GripResult::inner_mask}) {
            EXPECT_EQ(result.*mask >> j & 1, exchanged.*mask >> twin & 1) << one.name << ", joint " << j;
          }
        }
        EXPECT_EQ(result.phalanx_depth, exchanged.phalanx_depth);
        EXPECT_EQ(result.palm_depth, exchanged.palm_depth);
        EXPECT_EQ(result.plausible, exchanged.plausible);
      });
    }
  }
}

TEST(Articulated, FingerInTheAirTurnsEveryJointAsFarAsItMay) {
  // a point that touches stays where it touches, so a finger none of whose watched points touches never did: it followed the
  // trajectory to c and then turned MCP, PIP and DIP by max_angle or to their limits
  int in_air = 0;
  for (const Case& one : cases(Pose::articulated)) {
    const HandData& hand = one.scene.hand;
    for_each_grip(one, 200, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
      const Long3 reached = reference_finger_angles(hand, result.closure);
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        const std::size_t j = first_joint(finger);
        if (std::min({result.separation[j + 2], result.separation[j + 3], result.separation[j + 4]}) < 1e-6) continue;
        ++in_air;
        double out_of_plane = 0;
        const Vec3 angles = angles_of(placed_finger(hand, result, finger, grip.hand_scale), result, finger, out_of_plane);
        for (int k = 0; k < 3; ++k) {
          const double from = static_cast<double>(reached[static_cast<std::size_t>(k)]);
          const double to = std::max(from, std::min(from + hand.max_angle, hand.joint_limit[static_cast<std::size_t>(k)]));
          EXPECT_NEAR(angles[k], to, 1e-9) << one.name << ", finger " << finger << ", joint " << k;  // rad: as above
        }
      }
    });
  }
  EXPECT_GT(in_air, 200);
}

TEST(Articulated, FingerInTheAirWorkedByHand) {
  // a coin held level, the hand beside it: the little finger is far below
  Scene scene = scene_of({cylinder("coin", 60, 14, 1)});
  GripInput grip;
  grip.height = 7e-3;
  GripResult result;
  make_core_evaluator(scene)->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  ASSERT_GT(std::min({result.separation[21], result.separation[22], result.separation[23]}), 1e-3);
  double out_of_plane = 0;
  const Vec3 angles = angles_of(placed_finger(scene.hand, result, 4, 1), result, 4, out_of_plane);
  const double c = result.closure;
  ASSERT_GT(4 + 62 * c + 45, 60);
  EXPECT_NEAR(angles.x, radians(std::min(4 + 62 * c + 45, 90.0)), 1e-9);
  EXPECT_NEAR(angles.y, radians(12 + 28 * c + 45), 1e-9);          // under its limit of 100
  EXPECT_NEAR(angles.z, radians(0.6 * (12 + 28 * c) + 45), 1e-9);  // no longer tied to the PIP
}

TEST(Articulated, LargestTurnIsTheScenes) {
  // the same finger turns less where the scene allows less, and not at all at 0
  GripInput grip;
  grip.height = 7e-3;
  for (const double max_deg : {0.0, 5.0, 20.0}) {
    Scene scene = scene_of({cylinder("coin", 60, 14, 1)});
    scene.hand.max_angle = radians(max_deg);
    GripResult result;
    make_core_evaluator(scene)->grip(0, grip, result);
    double out_of_plane = 0;
    const Vec3 angles = angles_of(placed_finger(scene.hand, result, 4, 1), result, 4, out_of_plane);
    const Long3 reached = reference_finger_angles(scene.hand, result.closure);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(angles[k], static_cast<double>(reached[static_cast<std::size_t>(k)]) + radians(max_deg), 1e-9);
  }
}

// ---- roles ----

TEST(Projection, RolesInOrder) {
  const int base = 1, mcp = 2, pip = 4, dip = 8, tip = 16;
  enum { TIP, FINGER, INNER };
  // a tip whose finger touched further in, MCP and base included
  for (const int before : {base, mcp, pip, dip, mcp | pip, base | dip})
    EXPECT_EQ(core_f64::projection_role(4, before), TIP) << before;
  // no point of the finger touched
  for (const int point : {2, 3, 4}) EXPECT_EQ(core_f64::projection_role(point, 0), FINGER) << point;
  // anything else
  for (const int before : {base, mcp, dip, tip, mcp | tip}) EXPECT_EQ(core_f64::projection_role(2, before), INNER) << before;
  for (const int before : {base, mcp, pip, tip, pip | tip}) EXPECT_EQ(core_f64::projection_role(3, before), INNER) << before;
}

TEST(Projection, RolesOfWholeGripsAreThoseOfTheStateBefore) {
  // the simulation knows the separations when a finger left its trajectory
  std::array<int, 3> seen{};
  int left_out = 0, compared = 0;
  for (const Case& one : cases(Pose::articulated)) {
    const HandData& hand = one.scene.hand;
    const double tolerance = hand.contact_tolerance;
    for_each_grip(one, 50, [&](const Evaluator& evaluator, const GripInput& grip, const GripResult& result) {
      EXPECT_EQ((result.tip_mask | result.finger_mask | result.inner_mask) & 0x1FFu, 0u);  // thumb and index finger
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        const std::size_t j = first_joint(finger);
        const Rest rest = simulate(evaluator, hand, placed_finger(hand, result, finger, grip.hand_scale), result.closure);
        bool near = rest.doubtful;
        int before = (result.separation[j] <= tolerance ? 1 : 0) | (result.separation[j + 1] <= tolerance ? 2 : 0);
        for (int k = 0; k < 3; ++k) {
          if (rest.before[k] <= tolerance) before |= 4 << k;
          near = near || std::abs(rest.before[k] - tolerance) < 1e-6 ||
                 std::abs(result.separation[j + 2 + static_cast<std::size_t>(k)] - tolerance) < 1e-6;
        }
        if (near) {
          ++left_out;
          continue;
        }
        ++compared;
        for (std::size_t k = 0; k < 5; ++k) {
          const bool touches = result.touch_mask >> (j + k) & 1, projected = touches && !(before >> k & 1);
          const bool is_tip = k == 4 && (before & 15) != 0, is_finger = !is_tip && before == 0;
          EXPECT_EQ(result.tip_mask >> (j + k) & 1, unsigned(projected && is_tip)) << one.name;
          EXPECT_EQ(result.finger_mask >> (j + k) & 1, unsigned(projected && is_finger)) << one.name;
          EXPECT_EQ(result.inner_mask >> (j + k) & 1, unsigned(projected && !is_tip && !is_finger)) << one.name;
          if (projected) ++seen[is_tip ? 0u : is_finger ? 1u : 2u];
        }
      }
    });
  }
  for (const int count : seen) EXPECT_GT(count, 5);
  EXPECT_LT(left_out, compared / 50);
}

TEST(Projection, ProjectedPointsTouchAndHaveOneRole) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    for (const Case& one : cases(pose)) {
      for_each_grip(one, 100, [&](const Evaluator&, const GripInput&, const GripResult& result) {
        EXPECT_EQ(result.tip_mask & result.finger_mask, 0u);
        EXPECT_EQ(result.tip_mask & result.inner_mask, 0u);
        EXPECT_EQ(result.finger_mask & result.inner_mask, 0u);
        EXPECT_EQ((result.tip_mask | result.finger_mask | result.inner_mask) & ~result.touch_mask, 0u);
        EXPECT_EQ(result.tip_mask & ~(1u << 13 | 1u << 18 | 1u << 23), 0u);  // tips only
      });
    }
  }
}

// ---- plausible ----

TEST(Projection, PlausibleIsNoDeeperThanTheLimit) {
  int plausible = 0, implausible = 0, exempt = 0;
  for (const Pose pose : {Pose::articulated, Pose::paper, Pose::rigged}) {
    for (const Case& one : cases(pose)) {
      for_each_grip(one, 100, [&](const Evaluator&, const GripInput&, const GripResult& result) {
        double judged = 0, all = 0;
        for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
          if (pose != Pose::paper || j <= INDEX_TIP)
            judged = std::max(judged, -result.separation[j]);  // in `paper` the others are exempt
          all = std::max(all, -result.separation[j]);
        }
        EXPECT_EQ(result.plausible, judged <= one.scene.hand.depth_limit) << one.name;
        EXPECT_EQ((result.status & STATUS_PLAUSIBLE) != 0, result.plausible);
        ++(result.plausible ? plausible : implausible);
        exempt += result.plausible && all > one.scene.hand.depth_limit;
      });
    }
  }
  EXPECT_GT(plausible, 200);
  EXPECT_GT(implausible, 200);
  EXPECT_GT(exempt, 20);
}

TEST(Projection, PlausibleUpToTheLimitItself) {
  const Case one{"vase", scene_of({vase()})};
  int checked = 0;
  for_each_grip(one, 60, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
    const double depth = std::max(result.phalanx_depth, result.palm_depth);
    if (depth < 1e-3) return;
    Scene scene = one.scene;
    for (const double factor : {1.0, 1 - 1e-12}) {
      scene.hand.depth_limit = depth * factor;
      GripResult again;
      make_core_evaluator(scene)->grip(0, grip, again);
      EXPECT_EQ(again.plausible, factor == 1.0);
    }
    ++checked;
  });
  EXPECT_GT(checked, 3);
}

// ---- rigged ----

TEST(Rigged, LeavesEveryJointAsRigged) {
  for (const Case& one : cases(Pose::rigged)) {
    for_each_grip(one, 60, [&](const Evaluator&, const GripInput&, const GripResult& result) {
      EXPECT_EQ(result.posed, result.joints);
      EXPECT_EQ(result.tip_mask | result.finger_mask | result.inner_mask, 0u);
      EXPECT_EQ(result.status >> STATUS_BLOCKED_SHIFT, 0u);
    });
  }
}

TEST(Rigged, HandIsTheSameInEveryPose) {
  const auto rigged = make_core_evaluator(scene_of({vase()}, Pose::rigged));
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    for_each_grip({"vase", scene_of({vase()}, pose)}, 60, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
      GripResult other;
      rigged->grip(0, grip, other);
      EXPECT_EQ(result.joints, other.joints);
      EXPECT_EQ(result.closure, other.closure);
      EXPECT_EQ(result.palm_depth, other.palm_depth);  // bases do not move
    });
  }
}

// ---- paper ----

// Rodrigues' rotation of p about the axis through `pivot`.
Vec3 turned_about(const Vec3& p, const Vec3& pivot, const Vec3& axis, double angle) {
  const Vec3 arm = p - pivot;
  return pivot + std::cos(angle) * arm + std::sin(angle) * glm::cross(axis, arm) +
         (1 - std::cos(angle)) * glm::dot(axis, arm) * axis;
}

std::vector<Case> paper_cases() {
  std::vector<Case> all = cases(Pose::paper);
  for (Case& one : all) {
    if (one.name != "odd") one.scene.hand.paper_max_angle = radians(one.name.size() % 2 ? 5 : 25);  // rare at 5 degrees
  }
  return all;
}

TEST(Paper, AngleIsTheFirstRootOfDenseSampling) {
  int found = 0, none = 0, left_out = 0;
  for (const Case& one : paper_cases()) {
    const HandData& hand = one.scene.hand;
    for_each_grip(one, 120, [&](const Evaluator& evaluator, const GripInput& grip, const GripResult& result) {
      const Vec3 index_mcp = vec(result.joints[5]), little_mcp = vec(result.joints[20]);
      const Vec3 index_tip = vec(result.joints[INDEX_TIP]), thumb_tip = vec(result.joints[THUMB_TIP]);
      Vec3 u = glm::normalize(little_mcp - index_mcp);
      if (glm::dot(glm::cross(u, index_tip - index_mcp), thumb_tip - index_tip) < 0) u = -u;
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        const Placed placed = placed_finger(hand, result, finger, grip.hand_scale);
        for (std::size_t k = 2; k < 5; ++k) {
          const std::size_t j = first_joint(finger) + k;
          const Vec3 p = vec(result.joints[j]);
          const auto separation = [&](double angle) {
            return evaluator.distance(0, triple(turned_about(p, placed.mcp, u, angle))) - placed.radius[k];
          };
          if (separation(0) <= hand.contact_tolerance) {  // it touches: it stays, however deep
            EXPECT_EQ(result.posed[j], result.joints[j]) << one.name;
            continue;
          }
          const Vec3 arm = p - placed.mcp;
          const Crossing crossing = first_zero(separation, hand.paper_max_angle, glm::length(arm - glm::dot(arm, u) * u));
          if (crossing.doubtful) {
            ++left_out;
          } else if (crossing.found) {
            ++found;
            // 1e-7 m: the stop tolerance over the least approach, 1e-9 / 0.05
            ASSERT_LT(glm::distance(vec(result.posed[j]), turned_about(p, placed.mcp, u, crossing.at)),
                      1e-7 * std::max(1.0, hand.scale))
                << one.name << ", joint " << j;
            EXPECT_NEAR(result.separation[j], 0, TOUCHING + 1e-15);
          } else {
            ++none;
            EXPECT_EQ(result.posed[j], result.joints[j]) << one.name << ", joint " << j;  // it stays
          }
        }
      }
    });
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(none, 500);
  EXPECT_LT(left_out, (found + none) / 100);
}

TEST(Paper, LargestTurnIsItsOwn) {
  // `max_angle` is the articulated pose's
  Scene one = scene_of({vase()}, Pose::paper), other = one;
  other.hand.max_angle = radians(1);
  const auto evaluator = make_core_evaluator(other);
  int moved = 0;
  for_each_grip({"vase", one}, 60, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
    GripResult again;
    evaluator->grip(0, grip, again);
    EXPECT_EQ(result.posed, again.posed);
    for (std::size_t j = 9; j < JOINT_COUNT; ++j) {
      const double moves = glm::distance(vec(result.posed[j]), vec(result.joints[j]));
      const std::size_t mcp = first_joint(static_cast<int>(1 + (j - 4) / 5)) + 1;
      const double arm = glm::distance(vec(result.joints[j]), vec(result.joints[mcp]));
      EXPECT_LE(moves, 2 * arm * std::sin(radians(2.5)) + 1e-15) << j;  // a chord of 5 degrees
      moved += moves > 0;
    }
  });
  EXPECT_GT(moved, 10);
}

TEST(Paper, RolesAreJudgedInTheRiggedHand) {
  std::array<int, 3> seen{};
  for (const Case& one : paper_cases()) {
    Scene scene = one.scene;
    scene.pose = Pose::rigged;
    const auto rigged = make_core_evaluator(scene);
    for_each_grip(one, 100, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
      GripResult state;
      rigged->grip(0, grip, state);
      for (std::size_t j = 9; j < JOINT_COUNT; ++j) {
        const std::size_t k = (j - 4) % 5, first = j - k;
        const unsigned before = state.touch_mask >> first & 31u;
        const bool projected = (result.touch_mask >> j & 1) && !(before >> k & 1);
        const bool is_tip = k == 4 && (before & 15u) != 0, is_finger = !is_tip && before == 0;
        EXPECT_EQ(result.tip_mask >> j & 1, unsigned(projected && is_tip)) << one.name;
        EXPECT_EQ(result.finger_mask >> j & 1, unsigned(projected && is_finger)) << one.name;
        EXPECT_EQ(result.inner_mask >> j & 1, unsigned(projected && !is_tip && !is_finger)) << one.name;
        if (projected) ++seen[is_tip ? 0u : is_finger ? 1u : 2u];
      }
    });
  }
  for (const int count : seen) EXPECT_GT(count, 5);
}

TEST(Paper, AxisCarriesTheIndexTipTowardsTheThumbTip) {
  Random random(43);
  const auto point = [&random] { return Vec3{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)}; };
  for (int n = 0; n < 200; ++n) {
    const Vec3 index_mcp = point(), little_mcp = point(), index_tip = point(), thumb_tip = point();
    const auto axis = core_f64::paper_axis(index_mcp, little_mcp, index_tip, thumb_tip);
    ASSERT_TRUE(axis.exists);
    const Vec3 u = glm::normalize(little_mcp - index_mcp);
    EXPECT_NEAR(std::abs(glm::dot(axis.direction, u)), 1, 1e-15);  // rounding
    EXPECT_NEAR(glm::length(axis.direction), 1, 1e-15);
    const double angle = 1e-6;  // so small that only the sense decides
    EXPECT_LT(glm::distance(turned_about(index_tip, index_mcp, axis.direction, angle), thumb_tip),
              glm::distance(index_tip, thumb_tip));
  }
}

TEST(Paper, AxisOfOneKnuckleDoesNotExist) {
  const auto axis = core_f64::paper_axis({1, 2, 3}, {1, 2, 3}, {0, 0, 0}, {1, 1, 1});
  EXPECT_FALSE(axis.exists);
}

TEST(Paper, TurnedPointIsARotation) {
  Random random(44);
  for (int n = 0; n < 200; ++n) {
    const double angle = random.uniform(0, 1);
    const Vec3 p{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)}, pivot{0.03, -0.02, 0.05};
    const Vec3 arm = p - pivot;
    const std::array<LongRotation, 3> by_axis{rotation_x(angle), rotation_y(angle), rotation_z(angle)};
    for (int k = 0; k < 3; ++k) {
      Vec3 axis{};
      axis[k] = 1;
      const Long3 expected = by_axis[static_cast<std::size_t>(k)] * Long3{arm.x, arm.y, arm.z};
      const Vec3 placed =
          pivot + Vec3{static_cast<double>(expected[0]), static_cast<double>(expected[1]), static_cast<double>(expected[2])};
      EXPECT_LT(glm::distance(core_f64::turned_point(p, pivot, axis, angle), placed), 1e-15);  // rounding
    }
  }
}

TEST(Paper, PointOnItsAxisStays) {
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  const Vec3 pivot{60e-3, 20e-3, 0};
  bool unsettled = false;
  // beside a vertical axis 60 mm from the beaker's, its skin half a micrometre from the wall: a quarter turn would touch
  for (const double off : {0.0, 0.9e-6, 1.1e-6}) {
    const Vec3 p{60e-3, 55e-3, off};
    const Vec3 placed = core_f64::project_point(vessel, p, 20e-3 - 0.5e-6, pivot, {{0, -1, 0}, true}, radians(90), unsettled);
    EXPECT_FALSE(unsettled);
    EXPECT_EQ(placed == p, off < 1e-6) << off;
  }
  // where there is no axis
  const Vec3 p{60e-3, 55e-3, 30e-3};
  EXPECT_EQ(core_f64::project_point(vessel, p, 5e-3, pivot, {{0, -1, 0}, false}, radians(90), unsettled), p);
}

TEST(Paper, PointTurnsToTheWallInClosedForm) {
  // about a vertical axis 60 mm from the beaker's, on a circle of 30 mm: its skin of 5 mm meets the wall 45 mm from the axis at
  // cos(angle from the axis' direction) = (60^2 + 30^2 - 45^2) / (2 60 30)
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  const double meets = std::acos((3600.0 + 900 - 2025) / 3600);
  for (const double sense : {1.0, -1.0}) {
    const Vec3 pivot{60e-3, 50e-3, 0}, p{60e-3, 55e-3, sense * 30e-3};
    // a turn about +y carries +z to +x, so towards the beaker it is about -y
    const core_f64::PaperAxis axis{{0, -sense, 0}, true};
    bool unsettled = false;
    const Vec3 placed = core_f64::project_point(vessel, p, 5e-3, pivot, axis, radians(89), unsettled);
    EXPECT_FALSE(unsettled);
    const Vec3 expected = pivot + 30e-3 * Vec3{-std::cos(meets), 0, sense * std::sin(meets)} + Vec3{0, 5e-3, 0};
    EXPECT_LT(glm::distance(placed, expected), 1e-8);  // the stop tolerance over the approach, about a half
    // not allowed so far, it stays
    EXPECT_EQ(core_f64::project_point(vessel, p, 5e-3, pivot, axis, PI / 2 - meets - 1e-6, unsettled), p);
    EXPECT_NE(core_f64::project_point(vessel, p, 5e-3, pivot, axis, PI / 2 - meets + 1e-6, unsettled), p);
  }
}

// ---- the steps ----

TEST(Advance, NearestPointIsTheInnermostOfEqualOnes) {
  EXPECT_EQ(core_f64::nearest_point({3, 2, 1}, 0), 2);
  EXPECT_EQ(core_f64::nearest_point({1, 2, 3}, 0), 0);
  EXPECT_EQ(core_f64::nearest_point({1, 2, 3}, 1), 1);
  EXPECT_EQ(core_f64::nearest_point({1, 2, 2}, 1), 1);
  EXPECT_EQ(core_f64::nearest_point({2, 2, 2}, 0), 0);
  EXPECT_EQ(core_f64::nearest_point({2, 1, 1}, 0), 1);
  EXPECT_EQ(core_f64::nearest_point({-1, -2, 5}, 2), 2);
}

TEST(Advance, MotionStartsOpen) {
  const core_f64::Hand hand = ready_hand(odd_hand());
  const FingerMotion motion = core_f64::start_motion(hand, 0.4);
  EXPECT_EQ(motion.joint, -1);
  EXPECT_EQ(motion.closure, 0);
  EXPECT_EQ(motion.limit, 0.4);
  EXPECT_EQ(motion.angles, core_f64::finger_angles(hand, 0));
  EXPECT_FALSE(motion.blocked);
  EXPECT_FALSE(motion.unsettled);
}

TEST(Advance, JointHasRoomUpToItsLimitOrItsLargestTurn) {
  const core_f64::Hand hand = ready_hand({});
  FingerMotion motion = core_f64::start_motion(hand, 1);
  motion.angles = {radians(60), radians(30), radians(18)};
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 0).room, radians(30), 1e-15);  // to 90
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 1).room, radians(45), 1e-15);  // max_angle
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 2).room, radians(45), 1e-15);
  motion.angles = {radians(95), radians(99), radians(80)};
  EXPECT_LE(core_f64::turn_joint(hand, motion, 0).room, 0);
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 1).room, radians(1), 1e-15);
  EXPECT_LE(core_f64::turn_joint(hand, motion, 2).room, 1e-15);
  EXPECT_EQ(core_f64::turn_joint(hand, motion, 1).start, motion.angles.y);
  EXPECT_EQ(core_f64::turn_joint(hand, motion, 3).joint, 3);
}

TEST(Advance, StepsAreCountedByTheStage) {
  const core_f64::Hand hand = ready_hand({});
  FingerMotion motion = core_f64::start_motion(hand, 1);
  motion.steps = ADVANCE_STEPS;
  for (int joint = 0; joint < 3; ++joint) {
    motion = core_f64::turn_joint(hand, motion, joint);
    EXPECT_EQ(motion.steps, 0);
    EXPECT_EQ(motion.turned, 0);
    motion.steps = ADVANCE_STEPS;
    motion.turned = 0.1;
  }
}

TEST(Advance, QuarterTurnIsTheDerivativeOfASegment) {
  const FingerFrame frame{{0, 0, 0}, glm::normalize(Vec3{1, 2, -2}), glm::normalize(Vec3{2, 1, 2})};
  const double h = 1e-6;
  for (const double angle : {0.0, 0.4, 1.9, 3.0}) {
    const auto segment = [&](double at) { return core_f64::segment_end(frame, {}, 0.05, at); };
    const Vec3 difference = (segment(angle + h) - segment(angle - h)) / (2 * h);
    EXPECT_LT(glm::distance(core_f64::quarter_turn(frame, segment(angle)), difference), 1e-10);  // h^2 / 6 and rounding 1e-17 / h
  }
}

TEST(Advance, StepPassesNoWatchedPointThroughTheWall) {
  const core_f64::Hand hand = ready_hand(odd_hand());
  for (const VesselData& data : {beaker1(), vase(), ledges(), shell_of(beaker1())}) {
    const core_f64::Vessel vessel = ready_vessel(data);
    Random random(45);
    int steps = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 forward = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      const FingerFrame frame{{0, 0, 0}, forward, glm::normalize(glm::cross(forward, Vec3{0.2, 0.5, -0.7}))};
      const Vec3 mcp{random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.2), random.uniform(-0.1, 0.1)},
          lengths{43e-3, 27e-3, 22e-3}, radii{7e-3, 0, 5e-3};
      Vec3 angles{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
      const int joint = n % 4 - 1;
      const auto at = [&](double step) {
        Vec3 moved = angles;
        if (joint < 0) {
          moved += step * hand.finger_swing;
        } else {
          moved[joint] += step;
        }
        return core_f64::finger_points(frame, mcp, lengths, moved);
      };
      const auto separations = [&](const FingerPoints& points) {
        Vec3 s{};
        s.x = core_f64::signed_distance(vessel, points.pip) - radii.x;
        s.y = core_f64::signed_distance(vessel, points.dip) - radii.y;
        s.z = core_f64::signed_distance(vessel, points.tip) - radii.z;
        return s;
      };
      const FingerPoints points = at(0);
      const core_f64::Watch watch = core_f64::watch_points(vessel, points, radii);
      EXPECT_EQ(watch.separations, separations(points));
      if (std::min({watch.separations.x, watch.separations.y, watch.separations.z}) < 1e-9) continue;
      ++steps;
      const double step =
          core_f64::finger_step(frame, mcp, points, watch, lengths, core_f64::segment_rates(hand.finger_swing, joint));
      ASSERT_GT(step, 0);
      for (int i = 1; i <= 20; ++i) {
        const Vec3 s = separations(at(std::min(step, 3.0) * i / 20));
        ASSERT_GE(std::min({s.x, s.y, s.z}), -1e-12) << data.name << ", joint " << joint << ", step " << step;  // m: rounding
      }
    }
    EXPECT_GT(steps, 500) << data.name;
  }
}

TEST(Advance, PastItsStepsAFingerStaysAndIsFlagged) {
  const core_f64::Hand hand = ready_hand({});
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  const FingerFrame frame{{0.2, 0.05, 0}, {0, 0, -1}, {-1, 0, 0}};
  const Vec3 mcp{0.2, 0.05, -0.06}, lengths{44e-3, 26e-3, 21e-3}, radii{7e-3, 7e-3, 7e-3};
  for (const int joint : {-1, 0, 1, 2}) {
    for (const int steps : {ADVANCE_STEPS - 1, ADVANCE_STEPS}) {
      FingerMotion motion = core_f64::start_motion(hand, 1);
      if (joint >= 0) motion = core_f64::turn_joint(hand, motion, joint);
      motion.steps = steps;
      const FingerPoints points = core_f64::finger_points(frame, mcp, lengths, motion.angles);
      const FingerMotion next =
          core_f64::advance_finger(hand, motion, frame, mcp, points, core_f64::watch_points(vessel, points, radii), lengths);
      EXPECT_EQ(next.unsettled, steps == ADVANCE_STEPS) << joint;
      if (steps == ADVANCE_STEPS) {
        EXPECT_EQ(next.joint, 3);
        EXPECT_EQ(next.angles, motion.angles);
      }
    }
  }
}

// ---- single precision ----

TEST(Projection, FloatAgreesWithDouble) {
  // A float distance is good to 1e-8 m and tips stop within 1e-6 m, so an answer may differ by what an input moved by as much does
  // to it. That is measured in double: how far the pose moves for 1e-6 m in height and offset and 1e-5 rad in the angles, the order
  // of the placement's own error (1e-6 m over a hand's half gap of 50 mm).
  int left_out = 0, feasible = 0, other_reasons = 0;
  double worst = 0;
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3(), vase()}) {
    const Scene scene = scene_of({vessel});
    const auto full = make_core_evaluator(scene), single = make_core_float_evaluator(scene);
    for (const GripInput& grip : sample_grips(vessel, 250, 46)) {
      GripResult exact, rough;
      full->grip(0, grip, exact);
      single->grip(0, grip, rough);
      const double open = full->gap_at(0), closed = std::max(full->gap_at(1), 15e-3);
      if (exact.reason != rough.reason) {
        // only where the gap is within a float's error of its limits
        EXPECT_LT(std::min(std::abs(exact.gap - open), std::abs(exact.gap - closed)), 1e-5) << vessel.name;
        ++other_reasons;
        continue;
      }
      if (exact.reason != Reason::none) continue;
      ++feasible;
      const auto apart = [](const GripResult& a, const GripResult& b) {
        double largest = 0;
        for (std::size_t j = 0; j < JOINT_COUNT; ++j) largest = std::max(largest, glm::distance(vec(a.posed[j]), vec(b.posed[j])));
        return largest;
      };
      double moves = 0;
      for (const double sign : {-1.0, 1.0}) {
        for (int axis = 0; axis < 4; ++axis) {
          GripInput beside = grip;
          (axis == 0   ? beside.height
           : axis == 1 ? beside.offset
           : axis == 2 ? beside.obliquity
                       : beside.roll) += sign * (axis < 2 ? 1e-6 : 1e-5);
          GripResult moved;
          full->grip(0, beside, moved);
          moves = std::max(moves, moved.reason == Reason::none ? apart(exact, moved) : 1.0);
        }
      }
      if (moves > 1e-4 || exact.grazing) {  // ill-conditioned: a touch at a grazing angle, or two that are nearly one
        ++left_out;
        continue;
      }
      const double off = apart(exact, rough);
      worst = std::max(worst, off);
      // 1e-5 m: ten stop tolerances for the chain of touches; ten times what the inputs' own error does
      EXPECT_LT(off, 1e-5 + 10 * moves) << vessel.name << ", moves " << moves;
      EXPECT_NEAR(rough.gap, exact.gap, 1e-5);
      EXPECT_NEAR(rough.closure, exact.closure, 1e-3);  // 1e-5 m over the gap's slope, 0.05 m at least
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        EXPECT_NEAR(rough.separation[j], exact.separation[j], off + 1e-7);  // a distance changes no faster than its point
        const bool near = std::abs(exact.separation[j] - scene.hand.contact_tolerance) < off + 1e-7;
        if (!near) {
          EXPECT_EQ(rough.touch_mask >> j & 1, exact.touch_mask >> j & 1) << vessel.name << ", joint " << j;
        }
      }
    }
  }
  RecordProperty("worst_um", static_cast<int>(worst * 1e6));
  RecordProperty("left_out", left_out);
  EXPECT_GT(feasible, 500);
  EXPECT_LE(other_reasons, 5);  // of 1,000: as rare as a gap within 10 um of its limits
  EXPECT_LE(left_out, feasible / 100);
}

}  // namespace
}  // namespace wholehand

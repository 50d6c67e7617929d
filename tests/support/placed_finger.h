// SPDX-License-Identifier: MIT
// A finger in the vessel frame, read off the rigged hand, and `articulated` simulated on it by dense sampling and bisection:
// nothing in it advances conservatively. With the scenes and hands that kernel 5 is tested on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "core/evaluator.h"
#include "core/joints.h"
#include "core/real.h"
#include "core/vectors.h"
#include "tests/support/scenes.h"

namespace wholehand {

constexpr double FINGER_TOUCHING = 1e-9;  // m: the specification's, in double
constexpr double FINGER_SAMPLE = 0.2e-3;  // m: no watched point moves further between two samples
constexpr double FINGER_DOUBT = 1e-7;     // m: separations that are nearer to a decision than this are left out, and counted
constexpr double FINGER_GRAZING = 0.05;   // approach speed over the largest speed under which a touch is left out, and counted

// One finger in the vessel frame, read off the rigged hand.
struct Placed {
  core_f64::Vec3 base, mcp, forward, palmward;
  std::array<double, 4> length;
  std::array<double, 5> radius;
};

inline Placed placed_finger(const HandData& hand, const GripResult& result, int finger, double hand_scale) {
  Placed placed;
  const std::size_t j = finger_start(finger);
  const FingerData& data = hand.fingers[static_cast<std::size_t>(finger)];
  for (std::size_t k = 0; k < 4; ++k) placed.length[k] = hand.scale * hand_scale * data.segments[k];
  for (std::size_t k = 0; k < 5; ++k) placed.radius[k] = hand.scale * hand_scale * data.radii[k];
  placed.base = to_vec3(result.joints[j]);
  placed.mcp = to_vec3(result.joints[j + 1]);
  placed.forward = (placed.mcp - placed.base) / placed.length[0];
  // the whole finger lies in one plane; its tip is far from the metacarpal's line
  const core_f64::Vec3 tip = to_vec3(result.joints[j + 4]) - placed.base;
  placed.palmward = glm::normalize(tip - glm::dot(tip, placed.forward) * placed.forward);
  return placed;
}

// PIP, DIP, tip for joint angles, in the finger's plane.
inline std::array<core_f64::Vec3, 3> watched_points(const Placed& finger, const core_f64::Vec3& angles) {
  std::array<core_f64::Vec3, 3> points;
  core_f64::Vec3 at = finger.mcp;
  double angle = 0;
  for (int k = 0; k < 3; ++k) {
    angle += angles[k];
    at += finger.length[static_cast<std::size_t>(k) + 1] * (std::cos(angle) * finger.forward + std::sin(angle) * finger.palmward);
    points[static_cast<std::size_t>(k)] = at;
  }
  return points;
}

struct Crossing {
  bool found = false;
  bool doubtful = false;  // within FINGER_DOUBT of another outcome, or met at a grazing angle
  double at = 0;
};

// f over [0, end], in m; `speed` bounds its slope.
inline Crossing first_zero(const std::function<double(double)>& f, double end, double speed) {
  Crossing crossing;
  const double first = f(0);
  if (first < FINGER_TOUCHING) {
    crossing.found = true;
    return crossing;
  }
  crossing.doubtful = first < FINGER_DOUBT;
  if (end <= 0) return crossing;
  const auto bisect = [&](double outside, double inside) {
    for (int i = 0; i < 80; ++i) {
      const double middle = (outside + inside) / 2;
      (f(middle) > 0 ? outside : inside) = middle;
    }
    crossing.found = true;
    crossing.at = outside;
    const double back = std::min(outside, 1e-6 / speed);
    crossing.doubtful = crossing.doubtful || !(f(outside - back) - f(outside) > FINGER_GRAZING * back * speed);
  };
  const int n = std::max(3, static_cast<int>(std::ceil(end * speed / FINGER_SAMPLE)));
  double before_last = first, last = first;
  for (int i = 1; i <= n; ++i) {
    const double u = end * i / n, value = f(u);
    if (value <= 0) {
      bisect(end * (i - 1) / n, u);
      return crossing;
    }
    // a dip that two samples enclose
    if (last <= before_last && last <= value && last < FINGER_SAMPLE) {
      double low = end * std::max(0, i - 2) / n, high = u;
      const double start = low, ratio = (std::sqrt(5.0) - 1) / 2;
      for (int k = 0; k < 70; ++k) {
        const double left = high - ratio * (high - low), right = low + ratio * (high - low);
        (f(left) < f(right) ? high : low) = f(left) < f(right) ? right : left;
      }
      const double least = f((low + high) / 2);
      if (std::abs(least) < FINGER_DOUBT) crossing.doubtful = true;
      if (least < 0) {
        bisect(start, (low + high) / 2);
        return crossing;
      }
    }
    before_last = last;
    last = value;
  }
  if (last < FINGER_DOUBT) crossing.doubtful = true;
  return crossing;
}

struct FingerRest {
  core_f64::Vec3 angles{};
  core_f64::Vec3 before{};  // separations when it left the trajectory
  bool blocked = false, doubtful = false, touched = false;
  double left_at = 0;  // closure at which it left the trajectory
};

// The separations of PIP, DIP and tip.
inline core_f64::Vec3 watched_separations(const Evaluator& evaluator, const Placed& finger, const core_f64::Vec3& angles) {
  const auto points = watched_points(finger, angles);
  core_f64::Vec3 result{};
  for (std::size_t k = 0; k < 3; ++k)
    result[static_cast<int>(k)] = evaluator.distance(0, to_triple(points[k])) - finger.radius[k + 2];
  return result;
}

inline FingerRest simulate(const Evaluator& evaluator, const HandData& hand, const Placed& finger, double closure) {
  FingerRest rest;
  const auto separations = [&](const core_f64::Vec3& angles) { return watched_separations(evaluator, finger, angles); };
  const auto least = [&](const core_f64::Vec3& s, int from) {
    double result = s[2];
    for (int k = from; k < 3; ++k) result = std::min(result, s[k]);
    return result;
  };
  // the smallest separation's point, of equal ones the innermost
  const auto nearest = [&](const core_f64::Vec3& s, int from) {
    int at = from;
    for (int k = from + 1; k < 3; ++k) at = s[k] < s[at] ? k : at;
    for (int k = from; k < 3; ++k) rest.doubtful = rest.doubtful || (k != at && s[k] - s[at] < FINGER_DOUBT);
    return at;
  };
  const auto trajectory = [&](double c) {
    const Long3 angles = reference_finger_angles(hand, c);
    return core_f64::Vec3{static_cast<double>(angles[0]), static_cast<double>(angles[1]), static_cast<double>(angles[2])};
  };
  const double reach[3] = {finger.length[1] + finger.length[2] + finger.length[3], finger.length[2] + finger.length[3],
                           finger.length[3]};

  rest.angles = trajectory(0);
  rest.before = separations(rest.angles);
  const double open = least(rest.before, 0);
  rest.doubtful = std::abs(open) < FINGER_DOUBT;
  if (open < 0) {
    rest.blocked = true;
    return rest;
  }
  const core_f64::Vec3 swing = trajectory(1) - trajectory(0);
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
      core_f64::Vec3 angles = rest.angles;
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

struct ProjectionCase {
  std::string name;
  Scene scene;
};

inline HandData with_limits(double mcp_deg, double pip_deg, double dip_deg, double max_angle_deg) {
  HandData hand = paper_hand();
  hand.joint_limit = {radians(mcp_deg), radians(pip_deg), radians(dip_deg)};
  hand.max_angle = radians(max_angle_deg);
  return hand;
}

inline std::vector<ProjectionCase> projection_cases(Pose pose) {
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
int for_each_grip(const ProjectionCase& one, int count, Check check) {
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

}  // namespace wholehand

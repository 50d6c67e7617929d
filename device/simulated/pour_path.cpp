// SPDX-License-Identifier: MIT
#include "device/simulated/pour_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "core/joints.h"
#include "core/mesh_body.h"
#include "core/mirror.h"
#include "core/outline_points.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "device/session/hand_view.h"
#include "device/session/session.h"

namespace wholehand::device {

using core_f64::Vec3;

namespace {

// Lengths in m.
constexpr double ABOVE_TARGET = 0.03;  // of the lip over the target's mouth
constexpr double APART_FROM = 0.012;   // of the target: an arm that lags and trembles needs some of it
constexpr double ABOVE_TABLE = 0.02;   // of the lowest part while it pours
constexpr double NEAR_SIDE = 0.4;      // of the mouth's radius, from its middle to where it is poured
constexpr double SAMPLES = 2e-3;       // between points of the outline
constexpr int AROUND = 64;
constexpr double STEEP = radians(5);  // tilted by less, all of it counts as over the target: so it is carried there
constexpr int SMOOTHED = 4;           // degrees to either side

double joint_radius(const HandData& hand, int joint) {
  const int finger = finger_of(joint);
  return hand.fingers[finger].radii[joint - finger_start(finger)];
}

// Tilted: the top goes to -z.
Vec3 tilted(Vec3 p, double tilt) {
  const double c = std::cos(tilt), s = std::sin(tilt);
  return {p.x, p.y * c + p.z * s, p.z * c - p.y * s};
}

// Points of a mesh's surface: of samples that are no further apart than SAMPLES, one a cell of that size.
std::vector<Triple> surface_points(const MeshBody& body) {
  std::vector<Triple> points;
  std::unordered_set<std::uint64_t> cells;
  const auto add = [&](const Vec3& p) {
    std::uint64_t cell = 0;
    for (const double x : {p.x, p.y, p.z}) cell = cell << 21 | (static_cast<std::uint64_t>(std::llround(x / SAMPLES)) & 0x1fffff);
    if (cells.insert(cell).second) points.push_back(to_triple(p));
  };
  for (const Triple& vertex : body.vertices) add(to_vec3(vertex));
  for (const auto& corners : body.triangles) {
    std::array<Vec3, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = to_vec3(body.vertices[corners[k]]);
    // rows along the shortest edge, so that a sliver has few
    const auto edge = [&p](int k) { return glm::length(p[(k + 2) % 3] - p[(k + 1) % 3]); };
    int top = 0;
    double longest = edge(0);
    for (int k = 1; k < 3; ++k) {
      if (edge(k) < edge(top)) top = k;
      longest = std::max(longest, edge(k));
    }
    if (longest <= SAMPLES) continue;
    const Vec3 &a = p[top], &b = p[(top + 1) % 3], &c = p[(top + 2) % 3];
    const int rows = 1 + static_cast<int>(longest / SAMPLES);
    for (int i = 1; i <= rows; ++i) {
      const Vec3 from = a + (b - a) * (1.0 * i / rows), to = a + (c - a) * (1.0 * i / rows);
      const int pieces = 1 + static_cast<int>(glm::length(to - from) / SAMPLES);
      for (int n = 0; n <= pieces; ++n) add(from + (to - from) * (1.0 * n / pieces));
    }
  }
  return points;
}

// The mean over a window of the largest in a window: nowhere below what it smooths.
std::vector<double> smoothed_above(const std::vector<double>& heights) {
  const int count = static_cast<int>(heights.size());
  const auto over = [count](const std::vector<double>& from, int k, auto&& take) {
    for (int i = -SMOOTHED; i <= SMOOTHED; ++i) take(from[std::clamp(k + i, 0, count - 1)]);
  };
  std::vector<double> most = heights, mean(heights.size(), 0.0);
  for (int k = 0; k < count; ++k) over(heights, k, [&](double height) { most[k] = std::max(most[k], height); });
  for (int k = 0; k < count; ++k) over(most, k, [&](double height) { mean[k] += height / (2 * SMOOTHED + 1); });
  return mean;
}

}  // namespace

std::vector<HeldBall> held_hand(const HandData& hand, const GripInput& grip, const GripResult& result) {
  std::vector<HeldBall> balls;
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const Vec3 place = Mirror(hand.handedness).in(result.proxies[j]);
    balls.push_back({place - Vec3(0, grip.height, 0), hand.scale * joint_radius(hand, j)});
  }
  return balls;
}

std::vector<HeldBall> held_vessel(const VesselData& vessel, const GripInput& grip, Handedness handedness) {
  const Vec3 middle(0, grip.height, 0);
  std::vector<HeldBall> balls;
  if (vessel.mesh) {
    const Mirror mirror(handedness);
    for (const Triple& point : surface_points(*vessel.mesh->body)) {
      const Vec3 place = mirror.in(point);
      balls.push_back({place - middle, 0});
    }
    return balls;
  }
  const PreparedVessel prepared = prepare_vessel(vessel, false);
  const auto points = outline_points(prepared.hull, prepared.hull.size(), ARC_STEP);
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto &a = points[k - 1], &b = points[k];
    const int pieces = 1 + static_cast<int>(std::hypot(b[0] - a[0], b[1] - a[1]) / SAMPLES);
    for (int i = 0; i <= pieces; ++i) {
      const double r = a[0] + (b[0] - a[0]) * i / pieces, y = a[1] + (b[1] - a[1]) * i / pieces;
      for (int n = 0; n < AROUND; ++n) {
        const double angle = 2 * PI * n / AROUND;
        balls.push_back({Vec3(r * std::cos(angle), y, r * std::sin(angle)) - middle, 0});
      }
    }
  }
  return balls;
}

PourPath::PourPath(const TaskData& task, const VesselData& vessel, const HandData& hand, const GripInput& grip,
                   const GripResult& result) {
  const PreparedVessel prepared = prepare_vessel(vessel, true);
  const Vec3 target = Mirror(hand.handedness).in(task.target_place);
  lip_ = {0, prepared.mouth_height - grip.height, -prepared.mouth_radius};
  aim_ = target + Vec3(0, 0, NEAR_SIDE * 0.5 * task.target_diameter);
  std::vector<HeldBall> balls = held_vessel(vessel, grip, hand.handedness);
  for (const HeldBall& ball : held_hand(hand, grip, result)) balls.push_back(ball);
  const double table = vessel.place[1] + vessel.base + ABOVE_TABLE, mouth = target.y + APART_FROM;
  const double reach = 0.5 * task.target_diameter + TARGET_WALL + APART_FROM;
  std::vector<double> up;
  for (std::size_t k = 0; k < DEGREES; ++k) {
    const double tilt = radians(static_cast<double>(k));
    const Vec3 lip = tilted(lip_, tilt);
    double height = target.y + ABOVE_TARGET - lip.y;
    for (const HeldBall& ball : balls) {
      const Vec3 from = tilted(ball.place, tilt);
      const double away = std::hypot(from.x + aim_.x - target.x, from.z - lip.z + aim_.z - target.z) - ball.radius;
      height = std::max(height, (tilt < STEEP || away < reach ? std::max(mouth, table) : table) + ball.radius - from.y);
    }
    up.push_back(height);
  }
  up = smoothed_above(up);
  std::copy(up.begin(), up.end(), up_.begin());
  is_empty_ = false;
}

Vec3 PourPath::middle(double tilt) const noexcept {
  if (is_empty_) return aim_;
  const double at = std::clamp(degrees(tilt), 0.0, static_cast<double>(up_.size() - 1));
  const std::size_t k = std::min(static_cast<std::size_t>(at), up_.size() - 2);
  const double part = at - static_cast<double>(k);
  Vec3 middle = aim_ - tilted(lip_, tilt);
  middle.y = (1 - part) * up_[k] + part * up_[k + 1];
  return middle;
}

}  // namespace wholehand::device

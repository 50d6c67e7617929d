// SPDX-License-Identifier: MIT
#include "device/session/slide.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec2;
using core_f64::Vec3;

namespace {

constexpr int LEVERS = 3;             // of the middle of a step; each gains a factor of about spin x seconds
constexpr int MOST_STEPS = 64;        // of a call
constexpr int MOST_ITERATIONS = 30;   // of the multiplier; it needs about six
constexpr double MULTIPLIER = 1e-12;  // relative, of the impulse's size

Vec2 turned_left(Vec2 r) { return {-r.y, r.x}; }

Vec2 rotated(Vec2 r, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * r.x - s * r.y, s * r.x + c * r.y};
}

// Solves (A + shift) y = b for a symmetric positive definite A by Cholesky's decomposition, and w = L^-1 y.
struct Shifted {
  Vec3 y{}, w{};
  Shifted(const Mat3& a, double shift, Vec3 b) noexcept {
    const double l00 = std::sqrt(a[0][0] + shift);
    const double l10 = a[0][1] / l00, l20 = a[0][2] / l00;
    const double l11 = std::sqrt(a[1][1] + shift - l10 * l10);
    const double l21 = (a[1][2] - l20 * l10) / l11;
    const double l22 = std::sqrt(a[2][2] + shift - l20 * l20 - l21 * l21);
    const auto forward = [&](Vec3 f) {
      const double x = f.x / l00, z = (f.y - l10 * x) / l11;
      return Vec3(x, z, (f.z - l20 * x - l21 * z) / l22);
    };
    const Vec3 f = forward(b);
    y.z = f.z / l22;
    y.y = (f.y - l21 * y.z) / l11;
    y.x = (f.x - l10 * y.y - l20 * y.z) / l00;
    w = forward(y);
  }
};

// The y in the unit ball that minimizes y.A y / 2 + b.y: -A^-1 b if that is inside, else on the sphere with a multiplier >= 0, where Newton's
// iteration on 1 / |y| rises to the root (More and Sorensen 1983). True: inside.
bool least_energy(const Mat3& a, Vec3 b, Vec3& y) noexcept {
  Shifted found(a, 0, -b);
  y = found.y;
  if (glm::dot(y, y) <= 1) return true;
  double shift = 0;
  for (int k = 0; k < MOST_ITERATIONS; ++k) {
    const double size = glm::length(found.y);
    if (size - 1 <= MULTIPLIER) break;
    shift += size * size / glm::dot(found.w, found.w) * (size - 1);
    found = Shifted(a, shift, -b);
  }
  y = found.y / glm::length(found.y);
  return false;
}

// One step's velocities. The slip of the contacts is v = c - w (e x lever), and what the friction's impulse p changes is M^-1 p with M^-1 = J diag(1/m,
// 1/m, 1/I) J^T of that linear map J.
struct Impulse {
  Vec2 velocity{};
  double spin = 0;
  Vec2 slip{};
  bool sticks = false;
};

Impulse after_friction(const SlidingBody& body, Vec2 lever, const SlideFriction& most, Vec2 velocity, double spin) noexcept {
  const double m = 1 / body.mass, i = 1 / body.inertia;
  const Vec2 r = lever;
  const Vec3 scale(most.force, most.force, most.moment);
  // columns of a symmetric matrix
  Mat3 a(m + i * r.y * r.y, -i * r.x * r.y, i * r.y, -i * r.x * r.y, m + i * r.x * r.x, -i * r.x, i * r.y, -i * r.x, i);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) a[column][row] *= scale[row] * scale[column];
  const Vec2 slip = velocity - spin * turned_left(r);
  const Vec3 b = scale * Vec3(slip.x, slip.y, spin);
  Vec3 y;
  if (least_energy(a, b, y)) return {{}, 0, {}, true};
  const Vec3 p = scale * y;
  Impulse after;
  after.velocity = velocity + m * Vec2(p.x, p.y);
  after.spin = spin + i * (p.z + r.y * p.x - r.x * p.y);
  after.slip = after.velocity - after.spin * turned_left(r);
  return after;
}

// The lever is that of the chord of a step: with it, v = 0 says that the contacts are the same before and after, however far the vessel turns.
Vec2 chord_lever(Vec2 lever, double angle) {
  const double half = 0.5 * angle;
  return (std::abs(half) > 1e-8 ? std::sin(half) / half : 1) * rotated(lever, half);
}

}  // namespace

SlideFriction slide_friction(double grip, double along, double friction, double torsion) noexcept {
  const double force = 2 * friction * std::max(0.0, grip - 0.5 * std::abs(along));
  return {force, force * std::max(torsion, LEAST_TORSION)};
}

double friction_share(const SlidingBody& body, Vec2 load, const SlideFriction& friction) noexcept {
  if (!(friction.force > 0)) return load == Vec2(0) ? 0 : std::numeric_limits<double>::infinity();
  const double moment = body.lever.x * load.y - body.lever.y * load.x;
  return std::hypot(load.x / friction.force, load.y / friction.force, moment / friction.moment);
}

SlideStep slide_step(const SlidingBody& given, Vec2 load, const SlideFriction& friction, double seconds,
                     SlideMotion& motion) noexcept {
  SlideStep sum;
  SlidingBody body = given;
  const int steps = static_cast<int>(std::clamp(std::ceil(seconds / LONGEST_SLIDE), 1.0, double{MOST_STEPS}));
  const double h = seconds / steps, radius = friction.force > 0 ? friction.moment / friction.force : 0;
  for (int step = 0; step < steps; ++step) {
    if (motion.is_rest() && friction_share(body, load, friction) <= 1) break;
    const Vec2 pushed = motion.velocity + h / body.mass * load;
    const SlideFriction most{h * friction.force, h * friction.moment};
    Impulse after{pushed, motion.spin, pushed - motion.spin * turned_left(body.lever), false};
    for (int k = 0; k < LEVERS && friction.force > 0 && !after.sticks; ++k)
      after = after_friction(body, chord_lever(body.lever, h * after.spin), most, pushed, motion.spin);
    motion = {after.velocity, after.spin};
    sum.moved += h * after.velocity;
    sum.turned += h * after.spin;
    sum.slipped += h * std::hypot(after.slip.x, after.slip.y, radius * after.spin);
    body.lever += h * after.velocity;
  }
  return sum;
}

}  // namespace wholehand::device

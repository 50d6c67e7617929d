// SPDX-License-Identifier: MIT
// A vessel that slides between two tips, against closed forms, energy, and the inequality that the largest dissipation obeys.
// sanitizers: address
#include "device/session/slide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/held.h"
#include "core/scene.h"

namespace wholehand::device {
namespace {

using core_f64::Vec2;
using core_f64::Vec3;

constexpr double G = 9.80665, MU = 0.6, GAMMA = 5e-3;

// Any of a family of bodies and frictions; loads of up to twice what friction holds.
struct DrawnSlide {
  std::mt19937 random;
  explicit DrawnSlide(unsigned seed) : random(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec2 within(double size) { return {between(-size, size), between(-size, size)}; }
  SlidingBody body() { return {between(0.02, 1), between(1e-6, 5e-3), within(0.1)}; }
  SlideMotion motion() { return {within(0.5), between(-20, 20)}; }
};

bool sticks(const SlidingBody& body, Vec2 load, const SlideFriction& friction) { return friction_share(body, load, friction) <= 1; }

double kinetic(const SlidingBody& body, const SlideMotion& motion) {
  return 0.5 * body.mass * glm::dot(motion.velocity, motion.velocity) + 0.5 * body.inertia * motion.spin * motion.spin;
}

// A plate between two tips starts to slide at F = m g / (2 mu).
TEST(Slide, APlateStartsToSlideAtHalfItsWeightOverFriction) {
  const SlidingBody plate{0.3, 1e-4, {}};
  const Vec2 weight(0, -0.3 * G);
  const double limit = 0.3 * G / (2 * MU);
  EXPECT_TRUE(sticks(plate, weight, slide_friction(limit * (1 + 1e-12), 0, MU, GAMMA)));
  EXPECT_FALSE(sticks(plate, weight, slide_friction(limit * (1 - 1e-12), 0, MU, GAMMA)));
}

// With a force that is all moment, turning starts at the soft fingers' 2 mu gamma F.
TEST(Slide, APlateStartsToTurnAtTheSoftFingersMoment) {
  // far from the line, so that the force itself is nothing beside its moment: 1e-6 of the limit, and its square counts
  const double lever = 5e3, mass = 1e-3;
  const SlidingBody plate{mass, 1, {lever, 0}};
  const Vec2 weight(0, -mass * G);
  const double limit = mass * G * lever / (2 * MU * GAMMA);
  EXPECT_TRUE(sticks(plate, weight, slide_friction(limit * (1 + 1e-9), 0, MU, GAMMA)));
  EXPECT_FALSE(sticks(plate, weight, slide_friction(limit * (1 - 1e-9), 0, MU, GAMMA)));
}

// The limit is the hold force of kernel 7, in any direction of weight, line and lever.
TEST(Slide, StartsWhereTheGripFallsBelowTheHoldForce) {
  DrawnSlide draw(1);
  for (int n = 0; n < 2000; ++n) {
    const auto unit = [&] {
      return glm::normalize(Vec3(draw.between(-1, 1), draw.between(-1, 1), draw.between(-1, 1)) + Vec3(0, 0, 1e-3));
    };
    const Vec3 e = unit(), up = unit();
    const Vec3 u = glm::normalize(glm::cross(e, std::abs(e.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0))), v = glm::cross(e, u);
    const Vec3 arm(draw.between(-0.1, 0.1), draw.between(-0.1, 0.1), draw.between(-0.1, 0.1));
    const double mass = draw.between(0.02, 1), mu = draw.between(0.1, 1.5), gamma = draw.between(1e-3, 2e-2);
    const double hold = core_f64::hold_force(mass, G, arm, e, up, mu, gamma);
    const SlidingBody body{mass, 1e-4, {glm::dot(arm, u), glm::dot(arm, v)}};
    const Vec3 weight = -mass * G * up;
    const Vec2 load(glm::dot(weight, u), glm::dot(weight, v));
    const double along = glm::dot(weight, e);
    EXPECT_TRUE(sticks(body, load, slide_friction(hold * (1 + 1e-9), along, mu, gamma))) << n;
    EXPECT_FALSE(sticks(body, load, slide_friction(hold * (1 - 1e-9), along, mu, gamma))) << n;
  }
}

TEST(Slide, AHeldBodyRestsExactly) {
  DrawnSlide draw(2);
  for (int n = 0; n < 500; ++n) {
    const SlidingBody body = draw.body();
    const Vec2 load = draw.within(body.mass * G);
    const double moment = body.lever.x * load.y - body.lever.y * load.x;
    const double needed = std::hypot(glm::length(load), moment / GAMMA);
    SlideMotion motion;
    const SlideStep step = slide_step(body, load, {needed * (1 + 1e-9), needed * GAMMA * (1 + 1e-9)}, 1e-3, motion);
    EXPECT_TRUE(motion.is_rest());
    EXPECT_EQ(step.moved, Vec2(0));
    EXPECT_EQ(step.turned, 0);
    EXPECT_EQ(step.slipped, 0);
  }
}

// m a = m g - 2 mu F beyond the limit; without lever and moment every step is exact.
TEST(Slide, FallsWithWhatFrictionLeavesOfGravity) {
  const double grip = 1, mass = 0.3, acceleration = G - 2 * MU * grip / mass, h = LONGEST_SLIDE;
  ASSERT_GT(acceleration, 1);
  SlideMotion motion;
  double way = 0, slipped = 0;
  for (int n = 0; n < 200; ++n) {
    const SlideStep step = slide_step({mass, 1e-4, {}}, Vec2(0, -mass * G), slide_friction(grip, 0, MU, GAMMA), 1e-3, motion);
    way -= step.moved.y;
    slipped += step.slipped;
    EXPECT_EQ(motion.spin, 0);
  }
  // 1e-9 of the sums: rounding, and where the multiplier's iteration ends
  EXPECT_NEAR(-motion.velocity.y, acceleration * 0.2, 1e-9);
  EXPECT_NEAR(way, 0.5 * acceleration * 0.2 * (0.2 + h), 1e-9);
  EXPECT_NEAR(slipped, way, 1e-12);
}

// Squeezed again, it stops within m v / (2 mu F - m g), and stays.
TEST(Slide, ACaughtBodyStops) {
  const double mass = 0.3, grip = 4, speed = 0.2, deceleration = 2 * MU * grip / mass - G;
  ASSERT_GT(deceleration, 1);
  SlideMotion motion{{0, -speed}, 0};
  double way = 0;
  int ticks = 0;
  for (; !motion.is_rest() && ticks < 1000; ++ticks)
    way -= slide_step({mass, 1e-4, {}}, Vec2(0, -mass * G), slide_friction(grip, 0, MU, GAMMA), 1e-3, motion).moved.y;
  EXPECT_NEAR(ticks, speed / deceleration / 1e-3, 1);
  // the steps lag behind by at most one
  EXPECT_NEAR(way, speed * speed / (2 * deceleration), speed * LONGEST_SLIDE);
}

// Spinning about the line through its center, it is slowed by the moment alone.
TEST(Slide, ASpinIsSlowedByTheSoftFingersMoment) {
  const SlidingBody body{0.3, 4e-4, {}};
  const SlideFriction friction = slide_friction(2, 0, MU, GAMMA);
  SlideMotion motion{{}, 8};
  const double deceleration = friction.moment / body.inertia, seconds = 8 / deceleration;
  int ticks = 0;
  double turned = 0;
  for (; !motion.is_rest() && ticks < 10000; ++ticks) turned += slide_step(body, {}, friction, 1e-3, motion).turned;
  EXPECT_NEAR(ticks, seconds / 1e-3, 1);
  EXPECT_NEAR(turned, 0.5 * 8 * seconds, 8 * LONGEST_SLIDE);
}

// Held fast without torsion it is a pendulum about the line: T = 2 pi sqrt((I + m l^2) / (m g l)) (1 + a^2 / 16).
TEST(Slide, SwingsAsAPendulumWithoutTorsion) {
  const double mass = 0.3, length = 0.05, inertia = 3e-4, amplitude = 0.1;
  SlidingBody body{mass, inertia, length * Vec2(std::sin(amplitude), -std::cos(amplitude))};
  SlideMotion motion;
  double slipped = 0, first = 0, last = 0;
  int crossings = 0;
  for (int n = 0; crossings < 3 && n < 10000; ++n) {
    const double before = body.lever.x;
    const SlideStep step = slide_step(body, Vec2(0, -mass * G), slide_friction(50, 0, MU, 0), 1e-3, motion);
    body.lever += step.moved;
    slipped += step.slipped;
    if ((before > 0) != (body.lever.x > 0)) {
      const double at = 1e-3 * (n + before / (before - body.lever.x));
      if (crossings++ == 0) first = at;
      last = at;
    }
  }
  const double period =
      2 * PI * std::sqrt((inertia + mass * length * length) / (mass * G * length)) * (1 + amplitude * amplitude / 16);
  // an implicit step of h changes a period by about (w h)^2 and damps by w^2 h / 2: beneath 1e-3 at 12 rad/s
  EXPECT_NEAR((last - first) / period, 1, 1e-3);
  // the contacts stay: the lever keeps its length to the steps' third order
  EXPECT_NEAR(glm::length(body.lever) / length, 1, 1e-5);
  EXPECT_LT(slipped, 1e-5);
}

// For any step: kinetic energy less the work of the load never grows.
TEST(Slide, EnergyNeverGrows) {
  for (const double seconds : {1e-5, 1e-3, 4e-3, 0.05}) {
    DrawnSlide draw(3);
    for (int n = 0; n < 300; ++n) {
      SlidingBody body = draw.body();
      const Vec2 load = draw.within(body.mass * G);
      const SlideFriction friction = slide_friction(draw.between(0, 8), 0, draw.between(0, 1), n % 3 == 0 ? 0 : GAMMA);
      SlideMotion motion = draw.motion();
      double energy = kinetic(body, motion);
      for (int k = 0; k < 40; ++k) {
        const SlideStep step = slide_step(body, load, friction, seconds, motion);
        const double now = kinetic(body, motion) - glm::dot(load, step.moved), before = energy;
        body.lever += step.moved;
        energy = kinetic(body, motion);
        ASSERT_LE(now, before + 1e-12 * (1 + before)) << seconds << " " << n << " " << k;
        if (seconds > 0.01) break;  // few long steps go further than any vessel is long
      }
    }
  }
}

// Friction does the work force x slipped, however the slip is divided between sliding and turning.
TEST(Slide, FrictionDoesTheWorkOfItsForceAlongTheSlip) {
  DrawnSlide draw(6);
  constexpr double H = 1e-6, SECONDS = 0.01;  // s
  int turned = 0;
  for (int n = 0; n < 20; ++n) {
    SlidingBody body = draw.body();
    body.inertia = std::max(body.inertia, 1e-4);
    const Vec2 load = draw.within(body.mass * G);
    const SlideFriction friction = slide_friction(draw.between(0.5, 4), 0, MU, draw.between(5e-3, 2e-2));
    SlideMotion motion = draw.motion();
    const double before = kinetic(body, motion);
    double worked = 0, slipped = 0, angle = 0;
    for (double t = 0; t < SECONDS; t += H) {
      const SlideStep step = slide_step(body, load, friction, H, motion);
      body.lever += step.moved;
      worked += glm::dot(load, step.moved);
      slipped += step.slipped;
      angle += step.turned;
    }
    turned += std::abs(angle) > 0.05;
    // an implicit step loses m a^2 h^2 / 2 beyond that: 1e-3 of the work for accelerations of up to 1,000 m/s2 at 0.5 m/s
    EXPECT_NEAR(before + worked - kinetic(body, motion), friction.force * slipped, 1e-3 * (before + friction.force * slipped)) << n;
  }
  EXPECT_GT(turned, 10);
}

// Maximal dissipation: no impulse within the limit does more against the slip that is left, so that v . (q - p) >= 0 for all of them.
TEST(Slide, NoOtherFrictionTakesMoreEnergy) {
  DrawnSlide draw(4);
  constexpr double H = 1e-7;  // s: so short that the vessel does not turn
  int sliding = 0;
  for (int n = 0; n < 300; ++n) {
    const SlidingBody body = draw.body();
    // slow enough that friction matters in so short a step
    SlideMotion motion = {1e-6 * draw.within(1), 1e-5 * draw.between(-1, 1)};
    const SlideMotion before = motion;
    const SlideFriction friction = slide_friction(draw.between(0.1, 8), 0, MU, draw.between(1e-3, 1e-2));
    slide_step(body, {}, friction, H, motion);
    if (motion.is_rest()) continue;
    ++sliding;
    const Vec2 p = body.mass * (motion.velocity - before.velocity);
    const Vec2 r = body.lever;
    const double moment = body.inertia * (motion.spin - before.spin) - r.y * p.x + r.x * p.y;
    const Vec2 slip = motion.velocity - motion.spin * Vec2(-r.y, r.x);
    const double done = glm::dot(slip, p) + motion.spin * moment;
    const double across = glm::length(p) / (H * friction.force), about = moment / (H * friction.moment);
    EXPECT_NEAR(across * across + about * about, 1, 1e-6) << n;
    for (int k = 0; k < 200; ++k) {
      Vec3 q(draw.between(-1, 1), draw.between(-1, 1), draw.between(-1, 1));
      q /= std::max(1.0, glm::length(q));
      const double other = H * friction.force * (slip.x * q.x + slip.y * q.y) + H * friction.moment * motion.spin * q.z;
      // 1e-6: the lever that the step itself takes, and the end of its iteration
      EXPECT_GE(other, done - 1e-6 * std::abs(done)) << n;
    }
  }
  EXPECT_GT(sliding, 100);
}

// Steps of a twentieth lead to the same place, to the first order.
TEST(Slide, ShorterStepsLeadToTheSamePlace) {
  const SlidingBody body{0.2, 2e-4, {0.02, -0.03}};
  const Vec2 load(0, -0.2 * G);
  const SlideFriction friction = slide_friction(1.2, 0, MU, GAMMA);
  const auto end = [&](double seconds) {
    SlidingBody moving = body;
    SlideMotion motion;
    double turned = 0;
    for (double t = 0; t < 0.1 - 1e-9; t += seconds) {
      const SlideStep step = slide_step(moving, load, friction, seconds, motion);
      moving.lever += step.moved;
      turned += step.turned;
    }
    return Vec3(moving.lever.x, moving.lever.y, turned);
  };
  const Vec3 coarse = end(1e-3), fine = end(5e-5 * 0.25);
  ASSERT_GT(glm::length(coarse - Vec3(body.lever.x, body.lever.y, 0)), 1e-3);
  // a g h / 2 of path over the time, twice: the order of the step
  EXPECT_NEAR(coarse.x, fine.x, G * 0.1 * LONGEST_SLIDE);
  EXPECT_NEAR(coarse.y, fine.y, G * 0.1 * LONGEST_SLIDE);
  EXPECT_NEAR(coarse.z, fine.z, G * 0.1 * LONGEST_SLIDE / 0.03);
}

TEST(Slide, WithoutFrictionItFliesFree) {
  SlidingBody body{0.2, 2e-4, {0.02, -0.03}};
  SlideMotion motion{{0.1, 0}, 3};
  const Vec2 from = body.lever;
  double turned = 0;
  for (int n = 0; n < 100; ++n) {
    const SlideStep step = slide_step(body, Vec2(0, -0.2 * G), slide_friction(0, 0, MU, GAMMA), 1e-3, motion);
    body.lever += step.moved;
    turned += step.turned;
  }
  EXPECT_NEAR(motion.velocity.x, 0.1, 1e-15);
  EXPECT_NEAR(motion.velocity.y, -G * 0.1, 1e-12);
  EXPECT_NEAR(body.lever.x - from.x, 0.01, 1e-12);
  EXPECT_NEAR(turned, 0.3, 1e-12);
}

}  // namespace
}  // namespace wholehand::device

// SPDX-License-Identifier: MIT
// Sine, cosine, arc cosine and the angle between unit vectors, against the standard library in long double.
#include "core/trig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/scene.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

// 1e-15: a few roundings of numbers up to 4.
constexpr double SINE_ROUNDING = 1e-15;

long double reference_angle(Vec3 a, Vec3 b) {
  const Long3 wide_a{a.x, a.y, a.z}, wide_b{b.x, b.y, b.z};
  return std::atan2(length(cross(wide_a, wide_b)), dot(wide_a, wide_b));
}

Vec3 turned_in_plane(Vec3 a, Vec3 side, long double angle) {
  const long double c = std::cos(angle), s = std::sin(angle);
  return {double(c * a.x + s * side.x), double(c * a.y + s * side.y), double(c * a.z + s * side.z)};
}

TEST(Trig, SineAndCosineOnTheirWholeRange) {
  for (int i = -1600; i <= 1600; ++i) {
    const double angle = i * 0.01;
    double s = 0, c = 0;
    core_f64::sine_cosine(angle, s, c);
    EXPECT_NEAR(s, double(std::sin(static_cast<long double>(angle))), SINE_ROUNDING) << angle;
    EXPECT_NEAR(c, double(std::cos(static_cast<long double>(angle))), SINE_ROUNDING) << angle;
    EXPECT_EQ(core_f64::sine(angle), s);
    EXPECT_EQ(core_f64::cosine(angle), c);
  }
}

TEST(Trig, ArcCosineOnItsWholeRange) {
  for (int i = -1000; i <= 1000; ++i) {
    const double x = i / 1000.0;
    EXPECT_NEAR(core_f64::arc_cosine(x), double(std::acos(static_cast<long double>(x))), SINE_ROUNDING) << x;
  }
  EXPECT_EQ(core_f64::arc_cosine(1), 0);
  EXPECT_EQ(core_f64::arc_cosine(-1), PI);
  EXPECT_EQ(core_f64::arc_cosine(0), PI / 2);
}

TEST(Trig, ArcCosineClampsWhatIsBeyondOne) {
  EXPECT_EQ(core_f64::arc_cosine(1 + 1e-15), 0);
  EXPECT_EQ(core_f64::arc_cosine(7), 0);
  EXPECT_EQ(core_f64::arc_cosine(std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(core_f64::arc_cosine(-1 - 1e-15), PI);
  EXPECT_EQ(core_f64::arc_cosine(-7), PI);
}

TEST(Trig, AngleBetweenIsAccurateNearZeroARightAngleAndAHalfTurn) {
  const Vec3 a = glm::normalize(Vec3(0.3, -0.8, 0.52)), side = glm::normalize(glm::cross(a, Vec3(0, 0, 1)));
  const long double half_turn = 3.14159265358979323846264338327950288L;
  for (const long double base : {0.0L, half_turn / 2, half_turn}) {
    for (const long double off : {0.0L, 1e-15L, 1e-12L, 1e-9L, 1e-8L, 1e-6L, 1e-3L, 0.1L}) {
      for (const long double sense : {-1.0L, 1.0L}) {
        const Vec3 b = turned_in_plane(a, side, base + sense * off);
        EXPECT_NEAR(core_f64::angle_between(a, b), double(reference_angle(a, b)), SINE_ROUNDING)
            << double(base) << " " << double(off);
      }
    }
  }
}

TEST(Trig, AngleBetweenOverTheSphere) {
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = glm::normalize(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    const Vec3 b = glm::normalize(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    const double angle = core_f64::angle_between(a, b);
    EXPECT_NEAR(angle, double(reference_angle(a, b)), SINE_ROUNDING) << i;
    EXPECT_EQ(core_f64::angle_between(b, a), angle) << i;
  }
}

TEST(Trig, AngleBetweenEqualAndOppositeVectorsIsExact) {
  const Vec3 a(0.6, 0, -0.8);
  EXPECT_EQ(core_f64::angle_between(a, a), 0);
  EXPECT_EQ(core_f64::angle_between(a, -a), PI);
}

}  // namespace
}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/mirror.h"
#include "core/quaternion.h"

namespace wholehand {
namespace {

// A quarter turn about y, then one about x: x goes to y, y to z, z to x.
constexpr Rotation ROUND{0, 0, 1, 1, 0, 0, 0, 1, 0};

TEST(Vectors, KnownLengthsAndPlaces) {
  const Triple a{2, -3, 6}, b{5, 1, -6};
  EXPECT_EQ(norm(a), 7);
  EXPECT_EQ(distance(a, b), 13);
  EXPECT_EQ(distance(b, a), 13);
  EXPECT_EQ(dot(a, b), -29);
  EXPECT_EQ(midpoint(a, b), (Triple{3.5, -1, 0}));
  EXPECT_EQ(point_between(a, b, 0), a);
  EXPECT_EQ(point_between(a, b, 0.25), (Triple{2.75, -2, 3}));
}

TEST(Vectors, ThereAndBack) {
  const Triple a{0.1, -0.2, 0.3};
  EXPECT_EQ(to_triple(to_vec3(a)), a);
  EXPECT_EQ(to_triple(to_vec3<float>(a)), (Triple{0.1F, -0.2F, 0.3F}));
  EXPECT_EQ(to_rotation(to_mat3(ROUND)), ROUND);
}

TEST(Vectors, RotationsAreWrittenRowByRow) {
  EXPECT_EQ(to_mat3(ROUND) * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0));
  EXPECT_EQ(to_mat3(ROUND) * glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1));
  EXPECT_EQ(to_mat3(ROUND) * glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0));
}

// A third of a turn about (1, 1, 1).
TEST(Vectors, QuaternionsAreWrittenFromX) {
  const Quaternion q = quaternion_of(ROUND);
  for (const double part : q) EXPECT_NEAR(part, 0.5, 1e-15);
  const double half = std::sqrt(0.5);
  const glm::dvec3 turned = to_quat(Quaternion{0, 0, half, half}) * glm::dvec3(1, 0, 0);  // a quarter about z
  EXPECT_NEAR(glm::distance(turned, glm::dvec3(0, 1, 0)), 0, 1e-15);
  EXPECT_EQ(to_quaternion(to_quat(Quaternion{0, 0.6, 0, 0.8})), (Quaternion{0, 0.6, 0, 0.8}));
}

TEST(Vectors, AMirrorChangesXAndTheSenseOfTurns) {
  const Triple p{1, 2, 3};
  EXPECT_EQ(mirrored(p, Handedness::right), p);
  EXPECT_EQ(mirrored(p, Handedness::left), (Triple{-1, 2, 3}));
  EXPECT_EQ(mirrored(to_vec3(p), Handedness::left), glm::dvec3(-1, 2, 3));
  const glm::dmat3 turn = to_mat3(ROUND), other = mirrored(turn, Handedness::left);
  EXPECT_EQ(mirrored(turn, Handedness::right), turn);
  EXPECT_EQ(other * mirrored(to_vec3(p), Handedness::left), mirrored(turn * to_vec3(p), Handedness::left));
}

}  // namespace
}  // namespace wholehand

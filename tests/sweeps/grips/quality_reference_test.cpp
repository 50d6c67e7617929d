// SPDX-License-Identifier: MIT
// sanitizers: none
// Epsilon and the volume of the wrenches against Qhull alone, on contacts at random on vessels: every cone replaced by a fixed polyhedral one
// inside of it, and by one around it. The whole of it: WHOLEHAND_QUALITY_SETS=2000 of the environment.
#include <gtest/gtest.h>
#include <libqhull_r/libqhull_r.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "sweeps/grips/quality.h"
#include "tests/support/contact_sets.h"

namespace wholehand::sweeps {
namespace {

using core_f64::ContactPoint;
using core_f64::Vec3;

constexpr double WRENCH_SCALE = 0.06;           // m
constexpr std::size_t FACETS_OF_A_SET = 3'000;  // a search that ends early, since its brackets hold the answer at any time

std::size_t asked_quality_sets() {
  const char* asked = std::getenv("WHOLEHAND_QUALITY_SETS");
  return asked ? static_cast<std::size_t>(std::strtoull(asked, nullptr, 10)) : 80;
}

// Corners on the unit ball of (tangential force / mu, moment / mu gamma), and the radius of the largest ball inside of their hull.
struct EdgedBall {
  std::vector<Vec3> corners;
  double inside = 1;
};

// An octahedron, whose faces are 1 / sqrt 3 from the middle; where there are `more`, with the eight corners of a cube. Each of the 24 faces
// then has a corner of the octahedron and an edge of the cube beside it.
EdgedBall edged_ball(bool more) {
  EdgedBall ball;
  for (const double sense : {1.0, -1.0})
    ball.corners.insert(ball.corners.end(), {Vec3(sense, 0, 0), Vec3(0, sense, 0), Vec3(0, 0, sense)});
  ball.inside = 1 / std::sqrt(3.0);
  if (!more) return ball;
  const double part = 1 / std::sqrt(3.0);
  for (const double x : {-part, part})
    for (const double y : {-part, part})
      for (const double z : {-part, part}) ball.corners.emplace_back(x, y, z);
  const Vec3 a(1, 0, 0), b(part, part, part), c(part, part, -part);
  ball.inside = std::abs(glm::dot(glm::normalize(glm::cross(b - a, c - a)), a));
  return ball;
}

// A regular polygon, for contacts without torsion.
EdgedBall edged_disc(int sides) {
  EdgedBall disc;
  for (int k = 0; k < sides; ++k) disc.corners.emplace_back(std::cos(2 * PI * k / sides), std::sin(2 * PI * k / sides), 0);
  disc.inside = std::cos(PI / sides);
  return disc;
}

std::vector<double> wrenches_of(const ContactSet& set, const EdgedBall& ball, double friction, const Vec3& center) {
  std::vector<double> numbers(6, 0.0);
  for (const ContactPoint& contact : set.contacts) {
    const Vec3 n = contact.normal, a = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0)));
    const Vec3 b = glm::cross(n, a);
    for (const Vec3& corner : ball.corners) {
      const Vec3 force = n + friction * (corner.x * a + corner.y * b);
      const Vec3 moment = (glm::cross(contact.place - center, force) + friction * set.hand.torsion * corner.z * n) / WRENCH_SCALE;
      for (int k = 0; k < 3; ++k) numbers.push_back(force[k]);
      for (int k = 0; k < 3; ++k) numbers.push_back(moment[k]);
    }
  }
  return numbers;
}

struct HullMeasure {
  bool exists = false;
  double epsilon = 0, volume = 0;
  double moved = 0;  // how far Qhull moved the points
};

HullMeasure measure_hull(std::vector<double> numbers) {
  HullMeasure measure;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> nowhere(std::fopen("/dev/null", "w"), &std::fclose);
  qhT qhull;
  qh_zero(&qhull, nullptr);
  qhT* qh = &qhull;
  char command[] = "qhull QJ FA";
  measure.exists =
      qh_new_qhull(qh, 6, static_cast<int>(numbers.size() / 6), numbers.data(), False, command, nowhere.get(), nowhere.get()) == 0;
  if (measure.exists) {
    double least = HUGE_VAL;
    facetT* facet = nullptr;  // the name that Qhull's macro wants
    FORALLfacets least = std::min(least, -facet->offset);
    measure.epsilon = std::max(0.0, least);
    measure.volume = qh->totvol;
    measure.moved = qh->JOGGLEmax * std::sqrt(6.0);
  }
  qh_freeqhull(qh, !qh_ALL);
  int long_blocks = 0, long_bytes = 0;
  qh_memfreeshort(qh, &long_blocks, &long_bytes);
  return measure;
}

// The hull of the edged cones inside lies in the exact set, and that of those around holds it, so that the true numbers lie between theirs,
// and within the brackets that are tested: these overlap. Qhull moves the points, by some 1e-9 of their size mostly, and further where it has
// to try again. Each face then moves as far. A set of the size 1 with a ball of 0.01 in it changes by 600 times that of its volume, and
// a flat one gains some of it.
constexpr double MOST_MOVED = 1e-5;
constexpr double VOLUME_OF_MOVED = 600;

TEST(QualityReference, BracketsOverlapThoseOfEdgedCones) {
  const std::size_t sets = asked_quality_sets();
  std::size_t enclosing = 0, one_sided = 0, sharp = 0, sharp_volumes = 0;
  for (std::uint64_t seed = 0; seed < sets; ++seed) {
    const ContactSet set = vessel_contact_set(seed);
    const std::string which = "seed " + std::to_string(seed) + ", " + std::to_string(set.contacts.size()) + " contacts";
    const Vec3 center(0, 0.05, 0);
    const bool is_few = set.contacts.size() <= 8;
    const EdgedBall ball = set.hand.torsion > 0 ? edged_ball(is_few) : edged_disc(is_few ? 16 : 8);
    const HullMeasure inside = measure_hull(wrenches_of(set, ball, set.hand.friction, center));
    const HullMeasure around = measure_hull(wrenches_of(set, ball, set.hand.friction / ball.inside, center));
    ASSERT_TRUE(inside.exists && around.exists) << which;
    const double moved = inside.moved + around.moved, room = VOLUME_OF_MOVED * moved;
    ASSERT_LT(moved, MOST_MOVED) << which;
    const WrenchQuality found =
        wrench_quality(set.contacts, {set.hand.friction, set.hand.torsion}, center, WRENCH_SCALE, FACETS_OF_A_SET);
    EXPECT_LE(found.epsilon[0], found.epsilon[1]) << which;
    EXPECT_LE(found.volume[0], found.volume[1]) << which;
    EXPECT_LE(found.epsilon[0], around.epsilon + moved) << which;
    EXPECT_GE(found.epsilon[1], inside.epsilon - moved) << which;
    EXPECT_LE(found.volume[0], around.volume * (1 + room) + room) << which;
    EXPECT_GE(found.volume[1], inside.volume * (1 - room) - room) << which;
    (inside.epsilon > moved ? enclosing : one_sided) += 1;
    sharp += inside.epsilon > 0.8 * around.epsilon;
    sharp_volumes += inside.volume > 0.5 * around.volume;
  }
  EXPECT_GT(enclosing, sets / 2);
  EXPECT_GT(one_sided, sets / 20);
  // else the edged cones tell little
  EXPECT_GT(sharp, sets / 5);
  EXPECT_GT(sharp_volumes, sets / 5);
}

}  // namespace
}  // namespace wholehand::sweeps

// SPDX-License-Identifier: MIT
// Epsilon and the volume of the wrenches against closed forms, against sampling, and against what must not change them.
// sanitizers: none
#include "sweeps/grips/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "core/vectors.h"
#include "sweeps/grips/hull.h"
#include "sweeps/grips/report.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

using core_f64::ContactPoint;
using core_f64::Vec3;
using core_f64::Wrench;
using Contacts = std::vector<ContactPoint>;

constexpr double SPAN = 0.04;          // m
constexpr double ROUNDED = 1e-9;       // of brackets that meet at the answer: Qhull moves points by some 1e-11
constexpr double SMALLEST_LOW = 0.95;  // of the answer: what a search with FEW_FACETS comes to
constexpr std::size_t FEW_FACETS = 20'000;

// A search that ends early, since the brackets hold the answer at any time.
WrenchQuality quality_of(std::span<const ContactPoint> contacts, const ContactMaterial& material, const Vec3& center,
                         double scale) {
  return wrench_quality(contacts, material, center, scale, FEW_FACETS);
}

ContactPoint pressing(Vec3 place, Vec3 inward) { return {place, glm::normalize(inward), 0}; }

Contacts antipodal() { return {pressing({SPAN, 0, 0}, {-1, 0, 0}), pressing({-SPAN, 0, 0}, {1, 0, 0})}; }

Contacts round_a_ball(int count) {
  Contacts contacts;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * PI * k / count;
    const Vec3 place(SPAN * std::cos(angle), 0, SPAN * std::sin(angle));
    contacts.push_back(pressing(place, -place));
  }
  return contacts;
}

Contacts cube_faces() {
  Contacts contacts;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sense : {SPAN, -SPAN}) {
      Vec3 place(0);
      place[axis] = sense;
      contacts.push_back(pressing(place, -place));
    }
  return contacts;
}

// On the wall of a cylinder, at random heights and with walls that lean a little.
Contacts somewhere(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Contacts contacts;
  for (int k = 0; k < count; ++k) {
    const double angle = PI * number(random), c = std::cos(angle), s = std::sin(angle);
    contacts.push_back(pressing({SPAN * c, SPAN * number(random), SPAN * s}, {-c, 0.2 * number(random), -s}));
  }
  return contacts;
}

// The wrench at unit normal force that does most along u = (a, b), by definition: h = n.v + mu |(tangent of v, gamma b.n)|.
double support_of(const Contacts& contacts, const ContactMaterial& material, double scale, const Point6& u) {
  double most = 0;
  for (const ContactPoint& contact : contacts) {
    const Vec3 a(u[0], u[1], u[2]), b(u[3], u[4], u[5]), n = contact.normal;
    const Vec3 v = a + glm::cross(b, contact.place / scale), tangent = v - glm::dot(v, n) * n;
    const double spin = material.torsion / scale * glm::dot(b, n);
    most = std::max(most, glm::dot(n, v) + material.friction * std::sqrt(glm::dot(tangent, tangent) + spin * spin));
  }
  return most;
}

Point6 random_direction(std::mt19937& random) {
  std::normal_distribution<double> number;
  Point6 u{};
  double square = 0;
  for (double& value : u) {
    value = number(random);
    square += value * value;
  }
  for (double& value : u) value /= std::sqrt(square);
  return u;
}

void expect_epsilon(const WrenchQuality& found, double answer, const std::string& what) {
  EXPECT_LE(found.epsilon[0], answer + ROUNDED) << what;
  EXPECT_GE(found.epsilon[1], answer - ROUNDED) << what;
  EXPECT_GE(found.epsilon[0], SMALLEST_LOW * answer) << what;
  EXPECT_LE(found.epsilon[1], answer / SMALLEST_LOW) << what;
}

// min(mu gamma / rho, mu / sqrt(1 + mu^2 + rho^2 / a^2)): the torsion about the line, or a push across it with a turn that loads one tip.
TEST(Quality, OfTwoAntipodalContacts) {
  for (const double scale : {SPAN, 0.06})
    for (const double torsion : {0.005, 0.03, 0.08}) {
      const double across = 0.6 / std::sqrt(1 + 0.36 + scale * scale / (SPAN * SPAN));
      const WrenchQuality found = quality_of(antipodal(), {0.6, torsion}, {}, scale);
      expect_epsilon(found, std::min(0.6 * torsion / scale, across), std::to_string(scale) + " " + std::to_string(torsion));
    }
}

TEST(Quality, OfThreeHardContactsRoundABall) {
  for (const double friction : {0.6, 0.9})
    expect_epsilon(quality_of(round_a_ball(3), {friction, 0}, {}, SPAN), friction / std::sqrt(3.0), std::to_string(friction));
}

TEST(Quality, OfTheFacesOfACube) {
  for (const double friction : {0.2, 0.6})
    expect_epsilon(quality_of(cube_faces(), {friction, 0}, {}, SPAN), friction * std::sqrt(2.0 / 3), std::to_string(friction));
}

// Without friction the set is the hull of the contacts' wrenches: of six and 0 a simplex. 0 is its corner.
TEST(Quality, OfSixWrenchesIsASimplex) {
  const Contacts six{pressing({0, SPAN, 0}, {1, 0, 0}), pressing({0, 0, SPAN}, {0, 1, 0}), pressing({SPAN, 0, 0}, {0, 0, 1}),
                     pressing({0, 0, 0}, {1, 0, 0}),    pressing({0, 0, 0}, {0, 1, 0}),    pressing({0, 0, 0}, {0, 0, 1})};
  const WrenchQuality found = quality_of(six, {}, {}, SPAN);
  EXPECT_EQ(found.epsilon[0], 0);
  EXPECT_EQ(found.epsilon[1], 0);
  // the moments are -z, -x and -y, each of 1, and the last three wrenches have none: the determinant is 1 in magnitude
  EXPECT_NEAR(found.volume[0], 1.0 / 720, ROUNDED);
  EXPECT_NEAR(found.volume[1], 1.0 / 720, ROUNDED);
}

// The volume is that of the unit ball, pi^3 / 6, times the mean of 1 / gauge^6 over all directions; kernel 10 gives the gauge.
TEST(Quality, VolumeHoldsASampledOne) {
  constexpr int SAMPLES = 4000;
  const Contacts contacts = cube_faces();
  const ContactMaterial material{0.6, 0.5 * SPAN};
  const WrenchQuality found = quality_of(contacts, material, {}, SPAN);
  core_f64::EffortSolver solver(contacts, {material.friction, material.torsion, {1, 1, 1, 1, 1, 1}}, {});
  std::mt19937 random(5);
  double sum = 0, squares = 0;
  for (int k = 0; k < SAMPLES; ++k) {
    const Point6 u = random_direction(random);
    const Wrench load{{-u[0], -u[1], -u[2]}, -SPAN * Vec3(u[3], u[4], u[5])};
    const double ball = PI * PI * PI / 6 / std::pow(solver.solve(load, 1e-4).effort, 6);
    sum += ball;
    squares += ball * ball;
  }
  const double mean = sum / SAMPLES, deviation = std::sqrt((squares / SAMPLES - mean * mean) / SAMPLES);
  EXPECT_LT(found.volume[0], mean + 4 * deviation);
  EXPECT_GT(found.volume[1], mean - 4 * deviation);
  EXPECT_LT(found.volume[1], 1.8 * found.volume[0]);
  EXPECT_LT(deviation, 0.05 * mean);
}

// No direction has a support below the lower end, whatever the contacts.
TEST(Quality, NoDirectionIsBelowTheLowerEnd) {
  std::mt19937 random(11);
  const ContactMaterial material{0.6, 0.005};
  for (const int count : {2, 5, 24}) {
    const Contacts contacts = somewhere(count, 40u + static_cast<unsigned>(count));
    const WrenchQuality found = quality_of(contacts, material, {}, 0.06);
    EXPECT_LE(found.epsilon[0], found.epsilon[1]);
    EXPECT_LE(found.volume[0], found.volume[1]);
    for (int k = 0; k < 20'000; ++k)
      ASSERT_GE(support_of(contacts, material, 0.06, random_direction(random)), found.epsilon[0]) << count;
  }
}

TEST(Quality, FurtherContactsTakeNothingAway) {
  const Contacts all = somewhere(6, 3);
  WrenchQuality last;
  for (std::size_t count = 2; count <= all.size(); ++count) {
    const WrenchQuality found = quality_of(std::span(all).first(count), {0.6, 0.005}, {}, 0.06);
    EXPECT_GE(found.epsilon[1], last.epsilon[0]) << count;
    EXPECT_GE(found.volume[1], last.volume[0]) << count;
    last = found;
  }
  EXPECT_GT(last.epsilon[0], 0);
}

// Neither the place nor the direction of all counts, nor the unit of length.
TEST(Quality, RigidMotionChangesNothing) {
  const Contacts contacts = somewhere(4, 9);
  const Vec3 center(0.01, 0.005, -0.01), shift(0.3, -0.2, 0.1), axis = glm::normalize(Vec3(1, 2, -2));
  const auto turned = [&](const Vec3& p) {  // by 1 rad about the axis
    return std::cos(1.0) * p + std::sin(1.0) * glm::cross(axis, p) + (1 - std::cos(1.0)) * glm::dot(axis, p) * axis;
  };
  Contacts moved;
  for (const ContactPoint& contact : contacts)
    moved.push_back(pressing(2.0 * (turned(contact.place) + shift), turned(contact.normal)));
  const WrenchQuality here = quality_of(contacts, {0.6, 0.005}, center, 0.06);
  const WrenchQuality there = quality_of(moved, {0.6, 0.01}, 2.0 * (turned(center) + shift), 0.12);
  for (const auto bracket : {&WrenchQuality::epsilon, &WrenchQuality::volume}) {
    EXPECT_LE((here.*bracket)[0], (there.*bracket)[1]);
    EXPECT_LE((there.*bracket)[0], (here.*bracket)[1]);
  }
  const WrenchQuality again = quality_of(contacts, {0.6, 0.005}, center, 0.06);
  EXPECT_EQ(again.epsilon, here.epsilon);
  EXPECT_EQ(again.volume, here.volume);
}

// Sets without extent in some dimension, and sets of which 0 is no inner point. Qhull prints nothing.
TEST(Quality, OfDegenerateSetsIsNothing) {
  const auto expect_nothing = [](const Contacts& contacts, const ContactMaterial& material, const char* what) {
    const WrenchQuality found = quality_of(contacts, material, {}, SPAN);
    for (const double number : {found.epsilon[0], found.epsilon[1], found.volume[0], found.volume[1]}) EXPECT_EQ(number, 0) << what;
  };
  testing::internal::CaptureStderr();
  expect_nothing({}, {0.6, 0.005}, "no contact");
  expect_nothing({antipodal()[0]}, {0.6, 0.005}, "one contact");
  expect_nothing(antipodal(), {0.6, 0}, "two hard contacts");
  expect_nothing(antipodal(), {0, 0.005}, "no friction");
  expect_nothing(cube_faces(), {0, 0.005}, "six without friction");
  expect_nothing({antipodal()[0], antipodal()[0], antipodal()[0]}, {0.6, 0.005}, "three at one place");
  EXPECT_FALSE(hull_of({}, {}));
  const Contacts beside{pressing({SPAN, 0, 0}, {-1, 0, 0}), pressing({SPAN, SPAN, 0}, {-1, 0, 0}),
                        pressing({SPAN, 0, SPAN}, {-1, 0.1, 0})};
  const WrenchQuality found = quality_of(beside, {0.6, 0.005}, {}, SPAN);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(found.epsilon[1], 0) << "from one side";
  EXPECT_GT(found.volume[0], 0);
}

// The search of the product is as narrow as it says.
TEST(Quality, BracketsAreNarrow) {
  const WrenchQuality found = wrench_quality(somewhere(5, 45), {0.6, 0.005}, {}, 0.06);
  EXPECT_LE(found.epsilon[1] - found.epsilon[0], 0.01 * found.epsilon[1]);
  EXPECT_LE(found.volume[1] - found.volume[0], 0.2 * found.volume[1]);
}

GripReport measured_report(const Scene& scene, std::size_t vessel, double height) {
  GripInput grip;
  grip.height = height;
  GripReport report = make_grip_report(scene, vessel, grip, {}, core_grip_methods(scene, make_core_evaluator(scene), "core"));
  add_quality(report, scene, vessel);
  return report;
}

// A beaker of 80 x 110 mm: its center of mass is on the axis, and the farthest points are on the rim or on the base's edge.
TEST(Quality, IsInTheReport) {
  const Scene scene = three_beakers();
  const GripReport report = measured_report(scene, 0, 0.055);
  ASSERT_TRUE(report.quality);
  const Triple& center = report.quality->center;
  EXPECT_EQ(center, make_core_evaluator(scene)->empty_center_of_mass(0));
  EXPECT_NEAR(report.quality->scale, std::hypot(0.04 + std::hypot(center[0], center[2]), std::max(center[1], 0.11 - center[1])),
              1e-12);
  EXPECT_GT(report.quality->wrenches.epsilon[0], 0);
  const auto json = parse_json(grip_json(report));
  EXPECT_EQ(json["epsilon"], report.quality->wrenches.epsilon);
  EXPECT_EQ(json["wrench_volume"], report.quality->wrenches.volume);
  EXPECT_EQ(json["torque_scale_m"], report.quality->scale);
  EXPECT_EQ(json["torque_center_m"], center);
  const std::string table = grip_table(report);
  EXPECT_NE(table.find("  epsilon        "), std::string::npos) << table;
  EXPECT_NE(table.find("  wrench volume  "), std::string::npos) << table;

  GripReport without = report;
  without.quality.reset();
  EXPECT_FALSE(parse_json(grip_json(without)).contains("epsilon"));
  EXPECT_EQ(grip_table(without).find("epsilon"), std::string::npos);
  const GripReport missed = measured_report(scene, 0, 5);
  EXPECT_FALSE(missed.quality);
  EXPECT_FALSE(parse_json(grip_json(missed)).contains("epsilon"));
}

}  // namespace
}  // namespace wholehand::sweeps

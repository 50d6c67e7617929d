// SPDX-License-Identifier: MIT
#include "tests/support/contact_sets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/sdf.h"
#include "tests/support/vectors.h"

namespace wholehand {

namespace {

using core_f64::ContactPoint;
using core_f64::Vec3;
using core_f64::Wrench;

struct RoundWall {
  double radius = 0, lean = 0;  // m at the middle; rad, of a cone
  bool is_sphere = false;
};

constexpr double MIDDLE = 0.055;  // m, the height about which contacts are spread

RoundWall random_wall(Random& random) {
  RoundWall wall;
  wall.radius = random.uniform(0.02, 0.06);
  const double kind = random.uniform(0, 3);
  wall.is_sphere = kind >= 2;
  if (kind >= 1 && kind < 2) wall.lean = random.uniform(-0.3, 0.3);
  return wall;
}

// Above the middle by `height` times 40 mm, or times 60 degrees of a sphere.
ContactPoint on_wall(const RoundWall& wall, double azimuth, double height, int digit) {
  const Vec3 out(std::cos(azimuth), 0, std::sin(azimuth)), up(0, 1, 0);
  ContactPoint contact;
  contact.digit = digit;
  if (wall.is_sphere) {
    const double latitude = height * PI / 3;
    contact.normal = -(std::cos(latitude) * out + std::sin(latitude) * up);
    contact.place = MIDDLE * up - wall.radius * contact.normal;
  } else {
    const double above = 0.04 * height;
    contact.normal = -(std::cos(wall.lean) * out + std::sin(wall.lean) * up);
    contact.place = (MIDDLE + above) * up + (wall.radius - above * std::tan(wall.lean)) * out;
  }
  return contact;
}

int random_digit(Random& random) { return static_cast<int>(random.uniform(0, core_f64::DIGITS)); }

int random_count(ContactKind kind, Random& random) {
  if (kind == ContactKind::single) return 1;
  if (kind == ContactKind::own_digits) return static_cast<int>(random.uniform(2, core_f64::DIGITS + 1));
  return static_cast<int>(random.uniform(2, 25));
}

// A vessel and how large it is.
struct Glass {
  core_f64::Vessel vessel;
  double radius = 0, height = 0;  // m
};

const std::vector<Glass>& glasses() {
  static const std::vector<Glass> all = [] {
    std::vector<Glass> made;
    for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges()})
      made.push_back({ready_vessel(data), largest_radius(data), data.height});
    return made;
  }();
  return all;
}

// The place nearest to one beside the wall. A hand does not press down on the mouth.
ContactPoint on_glass(const Glass& glass, Random& random, double azimuth, double height, int digit) {
  ContactPoint contact;
  contact.digit = digit;
  do {
    const double away = glass.radius * random.uniform(0.5, 1.1);
    const Vec3 p(away * std::cos(azimuth), height * glass.height, away * std::sin(azimuth));
    int element = 0;
    const Vec3 out = core_f64::distance_gradient(glass.vessel, p, element);
    contact.place = p - core_f64::signed_distance(glass.vessel, p) * out;
    contact.normal = -out;
    height *= 0.9;  // of the next try
  } while (contact.normal.y < -0.9);
  return contact;
}

}  // namespace

Wrench balanced_load(const ContactSet& set, Random& random) {
  Wrench load;
  for (const ContactPoint& contact : set.contacts) {
    const double normal = random.uniform(0, 10), turn = random.uniform(-1, 1);
    const Vec3 across = glm::cross(contact.normal, random_unit(random));
    const double share = set.hand.friction * normal * random.uniform(0, 0.7);
    const Vec3 force = normal * contact.normal + share * across;
    load.force -= force;
    load.moment -= glm::cross(contact.place, force) + share * set.hand.torsion * turn * contact.normal;
  }
  return load;
}

Wrench random_load(Random& random) {
  const double size = random.uniform(0.1, 20);
  const Vec3 place(random.uniform(-0.02, 0.02), random.uniform(0.02, 0.09), random.uniform(-0.02, 0.02));
  return core_f64::wrench_at(place, size * random_unit(random));
}

ContactPoint random_contact(Random& random) {
  const RoundWall wall = random_wall(random);
  return on_wall(wall, random.uniform(-PI, PI), random.uniform(-1, 1), random_digit(random));
}

ContactSet random_contact_set(ContactKind kind, Random& random) {
  ContactSet set;
  set.kind = kind;
  set.hand.friction = random.uniform(0.1, 2);
  set.hand.torsion = std::max(0.0, random.uniform(-0.015, 0.03));
  for (double& digit : set.hand.digits) digit = random.uniform(5, 80);
  const RoundWall wall = random_wall(random);
  const double side = random.uniform(-PI, PI), common = random.uniform(-1, 1);
  const int count = random_count(kind, random);
  for (int i = 0; i < count; ++i) {
    const double azimuth = side + (kind == ContactKind::one_side ? random.uniform(-0.7, 0.7) : random.uniform(-PI, PI));
    const double height = kind == ContactKind::level ? common : random.uniform(-1, 1);
    const int digit = kind == ContactKind::own_digits ? i : random_digit(random);
    set.contacts.push_back(on_wall(wall, azimuth, height, digit));
    const auto other = static_cast<std::size_t>(random.uniform(0, i));
    if (kind != ContactKind::coincident || i == 0 || random.uniform(0, 1) < 0.3) continue;
    set.contacts.back() = set.contacts[other];
    set.contacts.back().digit = digit;
  }
  set.load = random.uniform(0, 1) < 0.5 ? balanced_load(set, random) : random_load(random);
  return set;
}

ContactSet contact_set(std::uint64_t seed) {
  Random random(seed);
  return random_contact_set(static_cast<ContactKind>(seed % CONTACT_KINDS), random);
}

ContactSet vessel_contact_set(std::uint64_t seed) {
  constexpr ContactKind KINDS[] = {ContactKind::around, ContactKind::one_side, ContactKind::around, ContactKind::level,
                                   ContactKind::coincident};
  Random random(seed);
  const Glass& glass = glasses()[static_cast<std::size_t>(random.uniform(0, static_cast<double>(glasses().size())))];
  ContactSet set;
  set.kind = KINDS[seed % 5];
  set.hand.friction = random.uniform(0.1, 2);
  set.hand.torsion = std::max(0.0, random.uniform(-0.015, 0.03));
  for (double& digit : set.hand.digits) digit = random.uniform(5, 80);
  const double side = random.uniform(-PI, PI), common = random.uniform(0.05, 0.95);
  const int count = static_cast<int>(random.uniform(2, 25));
  for (int i = 0; i < count; ++i) {
    const double azimuth = side + (set.kind == ContactKind::one_side ? random.uniform(-0.7, 0.7) : random.uniform(-PI, PI));
    const double height = set.kind == ContactKind::level ? common : random.uniform(0.05, 0.95);
    set.contacts.push_back(on_glass(glass, random, azimuth, height, random_digit(random)));
    if (set.kind != ContactKind::coincident || i == 0 || random.uniform(0, 1) < 0.3) continue;
    const int digit = set.contacts.back().digit;
    set.contacts.back() = set.contacts[static_cast<std::size_t>(random.uniform(0, i))];
    set.contacts.back().digit = digit;
  }
  set.load = random.uniform(0, 1) < 0.5 ? balanced_load(set, random) : random_load(random);
  return set;
}

double wrench_size(const Wrench& wrench, const Vec3& about, double arm) {
  return std::hypot(glm::length(wrench.force), glm::length(wrench.moment - glm::cross(about, wrench.force)) / arm);
}

}  // namespace wholehand

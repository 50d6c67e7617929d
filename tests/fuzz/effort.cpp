// SPDX-License-Identifier: MIT
// Kernel 10 with any contacts: coincident, coplanar and one-sided ones, hands without friction or torsion, digits that do not
// press, loads of nothing and of 10^6 N. The answer is a bracket in its order, or infinite with a motion that nobody opposes, and
// never NaN; forces that it comes with are summed up here.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/effort.h"
#include "tests/fuzz/choices.h"
#include "tests/fuzz/must.h"
#include "tests/support/force_sums.h"

namespace wholehand {
namespace {

using core_f64::ContactForce;
using core_f64::ContactPoint;
using core_f64::DIGITS;
using core_f64::Effort;
using core_f64::EffortSolver;
using core_f64::HandStrength;
using core_f64::Vec3;
using core_f64::Wrench;

constexpr int LARGEST_SET = 24;
constexpr Quantity COORDINATE{-1, 1};  // m
constexpr Quantity LOAD{-1e6, 1e6};    // N
constexpr Quantity FRICTION{0, 10};
constexpr Quantity TORSION{0, 0.1};  // m
constexpr double SUMMED = 1e-12;     // rounding of sums of some 10 numbers of the size of the forces
constexpr double BALANCED = 1e-9;    // of the load: forces that leave more are no answer
constexpr double NO_LOAD = 1e-150;   // of the strongest digit: the square of a smaller load may underflow

struct EffortCase {
  std::vector<ContactPoint> contacts;
  HandStrength hand;
  Vec3 center{};
  std::vector<Wrench> loads;
};

// Any, along an axis, or nearly along it.
Vec3 normal_of(Choices& choose) {
  Vec3 n(0);
  n[choose.of(3)] = choose.yes() ? 1 : -1;
  if (choose.yes()) n += Vec3(choose.in(COORDINATE), choose.in(COORDINATE), choose.in(COORDINATE));
  const double length = glm::length(n);
  return length > 1e-3 ? n / length : Vec3(0, 1, 0);
}

Vec3 place_of(Choices& choose) { return {choose.in(COORDINATE), choose.in(COORDINATE), choose.in(COORDINATE)}; }

// A new contact, or one that shares the place of an earlier one or its normal, equal or opposite.
ContactPoint contact_of(Choices& choose, const std::vector<ContactPoint>& before) {
  ContactPoint contact{place_of(choose), normal_of(choose), choose.of(DIGITS)};
  if (before.empty() || choose.yes()) return contact;
  const ContactPoint& other = before[static_cast<std::size_t>(choose.of(static_cast<int>(before.size())))];
  if (choose.yes()) contact.place = other.place;
  if (choose.yes()) contact.normal = choose.yes() ? -other.normal : other.normal;
  return contact;
}

// What contacts in their cones can balance with normal forces of up to 100 N, or any.
Wrench load_of(Choices& choose, const EffortCase& asked) {
  Wrench load{};
  switch (choose.of(4)) {
    case 0:
      return load;
    case 1:
      return core_f64::wrench_at(place_of(choose), {choose.in(LOAD), choose.in(LOAD), choose.in(LOAD)});
    case 2:  // a vessel's
      return core_f64::wrench_at(place_of(choose), {0, -10 * choose.share(), 0});
    default:
      for (const ContactPoint& contact : asked.contacts) {
        const double normal = 100 * choose.share(), share = asked.hand.friction * normal * choose.share();
        const Vec3 across = glm::cross(contact.normal, normal_of(choose));
        const Vec3 force = normal * contact.normal + share * across;
        load.force -= force;
        load.moment -= glm::cross(contact.place, force);
      }
      return load;
  }
}

EffortCase case_of(Choices& choose) {
  EffortCase asked;
  asked.hand.friction = choose.in(FRICTION);
  asked.hand.torsion = choose.yes() ? choose.in(TORSION) : 0;
  for (double& digit : asked.hand.digits) digit = choose.of(4) == 0 ? 0 : choose.in(ranges::GRIP_STRENGTH);
  const int count = choose.of(LARGEST_SET + 1);
  for (int k = 0; k < count; ++k) asked.contacts.push_back(contact_of(choose, asked.contacts));
  asked.center = choose.yes() ? place_of(choose) : Vec3(0);
  for (int k = 0; k < 3; ++k) asked.loads.push_back(load_of(choose, asked));
  return asked;
}

// The size of a wrench about the center in N, moments divided by the reach of the contacts.
double size_about(const EffortCase& asked, const Wrench& wrench) {
  double reach = 1e-3;
  for (const ContactPoint& contact : asked.contacts) reach = std::max(reach, glm::distance(contact.place, asked.center));
  return std::hypot(glm::length(wrench.force), glm::length(wrench.moment - glm::cross(asked.center, wrench.force)) / reach);
}

std::string description(const EffortCase& asked, const Wrench& load, const Effort& found) {
  std::string text = fmt::format("effort {} to {}, {} pivots\nmu {} gamma {} digits", found.low, found.effort, found.pivots,
                                 asked.hand.friction, asked.hand.torsion);
  for (const double digit : asked.hand.digits) text += fmt::format(" {}", digit);
  const auto vector = [](const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); };
  text += fmt::format("\ncenter {}, load {} {}\n", vector(asked.center), vector(load.force), vector(load.moment));
  for (const ContactPoint& contact : asked.contacts)
    text += fmt::format("digit {} at {} along {}\n", contact.digit, vector(contact.place), vector(contact.normal));
  return text;
}

void check_forces(const EffortCase& asked, const EffortSolver& solver, const Wrench& load, const Effort& found) {
  std::vector<ContactForce> forces(asked.contacts.size());
  solver.forces(forces);
  const ForceSums sums = sums_of_forces(asked.contacts, forces, asked.hand.torsion, load);
  double all = 0;
  for (const ContactLoad& contact : sums.contacts) {
    must(contact.normal >= 0, "a contact pulls\n" + description(asked, load, found));
    must(contact.across <= asked.hand.friction * contact.normal + SUMMED * contact.size,
         "out of its cone\n" + description(asked, load, found));
    must(!contact.twists_in_vain, "a torsion without torsion\n" + description(asked, load, found));
    all += contact.size;
  }
  const double size = size_about(asked, load), left = size_about(asked, sums.rest);
  if (found.effort == 0 && size <= NO_LOAD * std::max(1.0, *std::max_element(asked.hand.digits.begin(), asked.hand.digits.end())))
    return;
  must(left <= BALANCED * size + SUMMED * all,
       fmt::format("{} of {} N are not balanced, of forces of {} N\n", left, size, all) + description(asked, load, found));
  for (std::size_t digit = 0; digit < DIGITS; ++digit)
    must(sums.pressed[digit] <= found.effort * asked.hand.digits[digit] * (1 + SUMMED),
         "a digit presses more\n" + description(asked, load, found));
}

void check_bracket(const EffortCase& asked, const Wrench& load, const Effort& found) {
  must(!std::isnan(found.effort) && !std::isnan(found.low), "NaN\n" + description(asked, load, found));
  must(0 <= found.low && found.low <= found.effort, "no bracket\n" + description(asked, load, found));
  must(found.pivots <= 2 * core_f64::EFFORT_PIVOTS, "too many pivots\n" + description(asked, load, found));
  if (std::isfinite(found.effort)) return;
  double size = 0;
  for (const double part : found.escape) size += std::abs(part);
  must(std::isfinite(size) && size > 0, "no motion of which nobody resists the load\n" + description(asked, load, found));
}

void check_case(const EffortCase& asked) {
  EffortSolver solver(asked.contacts, asked.hand, asked.center);
  for (const Wrench& load : asked.loads) {
    const double bound = solver.bound(load);
    const Effort found = solver.solve(load);
    check_bracket(asked, load, found);
    must(!std::isnan(bound) && bound >= found.low * (1 - 1e-6), fmt::format("bound {}\n", bound) + description(asked, load, found));
    if (std::isfinite(found.effort)) check_forces(asked, solver, load, found);
  }
}

}  // namespace
}  // namespace wholehand

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  wholehand::Choices choose(data, size);
  wholehand::check_case(wholehand::case_of(choose));
  return 0;
}

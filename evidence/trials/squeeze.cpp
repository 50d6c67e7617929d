// SPDX-License-Identifier: MIT
#include "evidence/trials/squeeze.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grip_effort.h"

namespace wholehand {
namespace {

using core_f64::ContactForce;
using core_f64::ContactPoint;
using core_f64::EffortSolver;
using core_f64::HandStrength;

// Shares of the friction, tried for a load that the full friction does not hold.
constexpr std::array<double, 8> LARGER_SHARES{1.15, 1.35, 1.6, 2, 2.7, 4, 8, 16};
constexpr double BLIND_SHARE = 0.25;  // of the strength, where no forces are known

void take_forces(const EffortSolver& solver, double factor, Squeeze& found) {
  solver.forces(found.forces);
  for (ContactForce& contact : found.forces) {
    contact.force *= factor;
    contact.torsion *= factor;
  }
}

Squeeze blind_squeeze(std::span<const ContactPoint> contacts, const HandStrength& hand) {
  Squeeze found{{}, hand.friction, std::numeric_limits<double>::infinity()};
  std::array<int, core_f64::DIGITS> count{};
  for (const ContactPoint& contact : contacts) ++count[contact.digit];
  for (const ContactPoint& contact : contacts)
    found.forces.push_back({BLIND_SHARE * hand.digits[contact.digit] / count[contact.digit] * contact.normal, 0});
  return found;
}

}  // namespace

Squeeze squeeze_forces(std::span<const ContactPoint> contacts, const HandStrength& hand, const core_f64::Wrench& load,
                       double squeeze) {
  Squeeze found;
  found.forces.resize(contacts.size());
  if (contacts.empty()) return found;
  HandStrength pressing = hand;
  const auto try_share = [&](double share, bool is_enough) {
    pressing.friction = share * hand.friction;
    EffortSolver solver(contacts, pressing, core_f64::contacts_center(contacts));
    const double effort = solver.solve(load).effort;
    if (!std::isfinite(effort) || (is_enough && effort * squeeze > 1)) return false;
    found.friction = pressing.friction;
    found.effort = effort;
    take_forces(solver, effort * squeeze > 1 ? 1 / effort : squeeze, found);
    return true;
  };
  for (const double share : FRICTION_SHARES)
    if (try_share(share, true)) return found;
  if (try_share(1, false)) return found;
  for (const double share : LARGER_SHARES)
    if (try_share(share, false)) return found;
  return blind_squeeze(contacts, hand);
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/grip_effort.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace CORE_NS {

namespace {

constexpr Real UNHELD = std::numeric_limits<Real>::infinity();
constexpr Real RISE_TOLERANCE = Real(0.05);  // of an effort that only directs the search
constexpr int RISE_STEPS = 6;
// Largest computed effort of a state that needs exactly all of the strength: both ends of its bracket are rounded sums.
constexpr Real JUST_HELD = 1 + EFFORT_ROUNDING;

struct Worst {
  Real effort = 0;
  std::size_t fill = 0, tilt = 0;
};

// Whether the effort for a load is up to 1, to the solver's tolerance. The last basis or the last cut may decide without a pivot. Rounding must not
// decide: forces with an effort of 1 still hold if the computed effort is slightly larger, and a direction with a slightly larger computed bound does
// not prove that nothing holds.
bool is_held(EffortSolver& solver, const Wrench& load, Real tolerance, int& pivots) {
  if (solver.bound(load) <= JUST_HELD) return true;
  if (solver.low(load) > JUST_HELD) return false;
  const Effort found = solver.solve(load, tolerance, JUST_HELD, JUST_HELD);
  pivots += found.pivots;
  return found.effort <= JUST_HELD;
}

// The largest effort over the states of fills first..last - 1. A direction u that certifies one state bounds the effort of all others from below,
// (-w).u / h(u). The search goes where this bound is largest, at first inexactly, and solves exactly where it stays. Each other state is then only
// compared with that effort: mostly the last basis holds it with less, or does after a pivot or two. The tolerance has two halves: an effort is
// within one of its state's, and a state is skipped within the other of the worst.
void find_worst(EffortSolver& solver, const GripLoads& loads, std::size_t first, std::size_t last, Real tolerance, Worst& worst,
                GripEffort& grip) {
  const Real half = tolerance / 2, margin = 1 + half;
  const auto rise = [&](std::size_t fill, std::size_t tilt) {
    for (int step = 0; step < RISE_STEPS; ++step) {
      const Effort found = solver.solve(loads.weight(fill, tilt), RISE_TOLERANCE);
      grip.pivots += found.pivots;
      if (std::isinf(found.effort)) break;
      const std::size_t fill_before = fill, tilt_before = tilt;
      Real most = found.effort;  // a state certainly above this is worse
      for (std::size_t f = first; f < last; ++f)
        for (std::size_t t = 0; t < loads.counted[f]; ++t) {
          const Real low = solver.low(loads.weight(f, t));
          if (!(low > most)) continue;
          most = low;
          fill = f;
          tilt = t;
        }
      if (fill == fill_before && tilt == tilt_before) break;
    }
    const Effort found = solver.solve(loads.weight(fill, tilt), half);
    grip.pivots += found.pivots;
    if (found.effort > worst.effort) worst = {found.effort, fill, tilt};
  };
  for (std::size_t fill = last; fill-- > first;)
    for (std::size_t tilt = loads.counted[fill]; tilt-- > 0;) {
      if (worst.effort == 0) rise(last - 1, loads.counted[last - 1] / 2);
      const Wrench weight = loads.weight(fill, tilt);
      if (std::isinf(worst.effort) || solver.bound(weight) <= worst.effort * margin) {
        ++grip.skipped;
        continue;
      }
      const Effort found = solver.solve(weight, half, worst.effort * margin, worst.effort * margin);
      grip.pivots += found.pivots;
      grip.skipped += found.pivots == 0;
      if (found.effort > worst.effort * margin) rise(fill, tilt);
    }
}

}  // namespace

// Up in the vessel frame at a tilt t: cos t y - sin t n.
Wrench GripLoads::weight(const Load& load, StateTilt tilt) const {
  return wrench_at(load_center(load, pour), -load.mass * gravity * up_direction(pour, tilt.sine, tilt.cosine));
}

Vec3 contacts_center(std::span<const ContactPoint> contacts) {
  Vec3 center(0);
  for (const ContactPoint& contact : contacts) center += contact.place;
  return contacts.empty() ? center : center / static_cast<Real>(contacts.size());
}

GripEffort grip_effort(std::span<const ContactPoint> contacts, std::optional<std::span<const ContactPoint>> tips,
                       const HandStrength& hand, const GripLoads& loads, std::span<FillEffort> fills, Real tolerance) {
  GripEffort grip, pinch;
  const Vec3 center = contacts_center(contacts);
  EffortSolver whole(contacts, hand, center), two(tips.value_or(std::span<const ContactPoint>()), hand, center);
  Worst worst;
  find_worst(whole, loads, 0, fills.size(), tolerance, worst, grip);
  grip.worst = worst.effort;
  grip.fill = worst.fill;
  grip.tilt = worst.tilt;
  if (!tips) grip.tips_worst = std::numeric_limits<Real>::quiet_NaN();
  for (std::size_t fill = 0; fill < fills.size(); ++fill) {
    Worst most;
    if (tips) find_worst(two, loads, fill, fill + 1, tolerance, most, pinch);
    fills[fill].tips = tips ? most.effort : grip.tips_worst;
    fills[fill].tips_hold = fills[fill].tips * hand.weaker_tip();
    fills[fill].held = 0;
    grip.states += static_cast<int>(loads.counted[fill]);
    grip.tips_worst = std::max(grip.tips_worst, most.effort);
  }
  // once the worst is known, most grips need nothing more
  for (std::size_t fill = 0; fill < fills.size(); ++fill) {
    std::size_t& held = fills[fill].held;
    const std::size_t counted = loads.counted[fill];
    if (grip.worst <= JUST_HELD) {
      held = counted;
      continue;
    }
    while (held < counted && is_held(whole, loads.weight(fill, held), tolerance, grip.pivots)) ++held;
  }
  return grip;
}

// The largest push along a direction is one over the gauge, in that direction, of what the hand can carry beside the weight.
Real push_held(std::span<const ContactPoint> contacts, const HandStrength& hand, const Wrench& weight, Vec3 center,
               Real tolerance) {
  EffortSolver solver(contacts, hand, contacts_center(contacts));
  if (!(solver.solve(weight, tolerance, 1, 1).effort < 1)) return 0;
  solver.displace(weight);
  Real worst = 1 / MOST_PUSH;
  for (int axis = 0; axis < 3; ++axis)
    for (const Real sense : {Real(1), Real(-1)}) {
      Vec3 direction(0);
      direction[axis] = sense;
      const Wrench push = wrench_at(center, direction);
      if (!(solver.bound(push) <= worst)) worst = std::max(worst, solver.solve(push, tolerance, worst).effort);
    }
  return 1 / worst;
}

// More friction holds everything that less holds, so one pass through the states is enough. A direction that certifies an effort above 1 gives the
// least friction needed for it: the search goes there, and a step further, so that it ends. The direction of an effort at another friction gives one
// too, so the search starts with the worst state's.
Real friction_needed(std::span<const ContactPoint> contacts, const HandStrength& hand, const GripLoads& loads,
                     const GripEffort& found, Real tolerance) {
  const Real half = tolerance / 2;  // a bracket of that width about 1 gives no more information
  EffortSolver solver(contacts, hand, contacts_center(contacts));
  Real friction = hand.friction;
  const auto raise_for = [&](const Wrench& weight) {
    Real low = friction, high = MOST_FRICTION;  // less than `low` does not hold
    for (int raises = 0;; ++raises) {
      const bool is_held = solver.bound(weight) <= 1 || solver.solve(weight, half, 1, 1).effort * (1 - half) <= 1;
      if (is_held && friction <= low + FRICTION_STEP) return true;
      if (!is_held && friction >= MOST_FRICTION) return false;
      if (is_held) {
        high = friction;
      } else {
        low = std::max(friction, solver.least_friction(weight, MOST_FRICTION));
      }
      friction = std::max(low + FRICTION_STEP, raises < QUICK_RAISES ? Real(0) : (low + high) / 2);
      friction = std::min(MOST_FRICTION, friction);
      solver.set_friction(friction);
    }
  };
  const Wrench worst = loads.weight(found.fill, found.tilt);
  if (solver.solve(worst, RISE_TOLERANCE).effort == 0) return 0;
  friction = std::min(MOST_FRICTION, solver.least_friction(worst, MOST_FRICTION));
  solver.set_friction(friction);
  if (!raise_for(worst)) return UNHELD;
  for (std::size_t fill = loads.counted.size(); fill-- > 0;)
    for (std::size_t tilt = loads.counted[fill]; tilt-- > 0;)
      if (!raise_for(loads.weight(fill, tilt))) return UNHELD;
  return found.worst <= 1 ? std::min(friction, hand.friction) : friction;
}

}  // namespace CORE_NS

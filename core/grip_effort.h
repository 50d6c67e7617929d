// SPDX-License-Identifier: MIT
// Kernel 10 over the states of one grip: the worst effort, what the tips need, what may push, and the friction that is needed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/effort.h"
#include "core/force.h"

namespace CORE_NS {

constexpr Real MOST_PUSH = Real(1e6);  // N
constexpr Real MOST_FRICTION = 10;
constexpr Real FRICTION_STEP = Real(1e-3);  // of the friction that is needed
constexpr int QUICK_RAISES = 20;            // of the friction for one state, after which its range is halved

// Sine and cosine of a tilt.
struct StateTilt {
  Real sine = 0, cosine = 1;
};

// The loads of a vessel as one grip holds it. A fill counts its first `counted` tilts. Vessel frame.
struct GripLoads {
  std::span<const Load> loads;  // fill-major over the tilts
  std::span<const StateTilt> tilts;
  std::span<const std::size_t> counted;  // one for each fill
  Vec3 pour{};                           // unit, level
  Real gravity = 0;                      // m/s2

  Wrench weight(const Load& load, StateTilt tilt) const;
  Wrench weight(std::size_t fill, std::size_t tilt) const { return weight(loads[fill * tilts.size() + tilt], tilts[tilt]); }
};

// One fill.
struct FillEffort {
  Real tips = 0;         // the largest effort of thumb and index tip alone
  Real tips_hold = 0;    // what each of the two must press with there, N: that effort times the strength of the weaker
  std::size_t held = 0;  // tilts from the first on at which the whole hand holds with an effort up to 1
};

// Over the states that count. Without states, or without weight: 0.
struct GripEffort {
  Real worst = 0;                  // to the tolerance that was asked for; infinite where a state is not resisted
  std::size_t fill = 0, tilt = 0;  // a state of that effort
  Real tips_worst = 0;
  int states = 0;   // that count
  int skipped = 0;  // of them, those that needed no pivot of the whole hand
  int pivots = 0;   // of the whole hand
};

// The mean place of the contacts, about which moments are taken; the origin without contacts.
Vec3 contacts_center(std::span<const ContactPoint> contacts);

// The whole hand presses with `contacts`, thumb and index tip alone with `tips`; their efforts are NaN without tips. `fills` has one
// entry for each fill. `tolerance` is the relative width of an effort's bracket, here and below. Allocates nothing.
GripEffort grip_effort(std::span<const ContactPoint> contacts, std::optional<std::span<const ContactPoint>> tips,
                       const HandStrength& hand, const GripLoads& loads, std::span<FillEffort> fills,
                       Real tolerance = EFFORT_TOLERANCE);

// The largest force, N, that may act at `center` along each of +-x, +-y, +-z beside `weight` with an effort up to 1: the least of
// the six, at most MOST_PUSH. 0 where the weight alone takes more.
Real push_held(std::span<const ContactPoint> contacts, const HandStrength& hand, const Wrench& weight, Vec3 center,
               Real tolerance = EFFORT_TOLERANCE);

// The least friction with which the effort of every state that counts is up to 1, to FRICTION_STEP, never too small by more than the
// tolerance of the effort; neither `hand.friction` nor the state with which the search begins matters beyond that. Infinite: none up to
// MOST_FRICTION.
// `found`: what grip_effort says of the same. A worst effort up to 1 says that `hand.friction` is enough: then it is no more than that.
Real friction_needed(std::span<const ContactPoint> contacts, const HandStrength& hand, const GripLoads& loads,
                     const GripEffort& found, Real tolerance = EFFORT_TOLERANCE);

}  // namespace CORE_NS

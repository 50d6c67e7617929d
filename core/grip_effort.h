// SPDX-License-Identifier: MIT
// Kernel 10 over the states of one grip: the worst effort, the effort of the tips alone, the largest push, and the friction needed.
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
constexpr int QUICK_RAISES = 20;            // of the friction for one state; then its range is halved

// Sine and cosine of a tilt.
struct StateTilt {
  Real sine = 0, cosine = 1;
};

// The loads of a vessel held by one grip. The first `counted` tilts of a fill count. Vessel frame.
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
  Real tips_hold = 0;    // the force on each of the two there, N: that effort times the strength of the weaker
  std::size_t held = 0;  // number of leading tilts at which the whole hand holds with an effort up to 1
};

// Over the states that count. 0 without states or weight.
struct GripEffort {
  Real worst = 0;                  // to the requested tolerance; infinite if a state is not resisted
  std::size_t fill = 0, tilt = 0;  // a state of that effort
  Real tips_worst = 0;
  int states = 0;   // that count
  int skipped = 0;  // those of them that needed no pivot of the whole hand
  int pivots = 0;   // of the whole hand
};

// The mean position of the contacts, about which moments are taken; the origin without contacts.
Vec3 contacts_center(std::span<const ContactPoint> contacts);

// The whole hand presses with `contacts`, thumb and index tip alone with `tips`; without tips their efforts are NaN. `fills` has one entry for each
// fill. `tolerance` is the relative width of an effort's bracket, here and below. Allocates nothing.
GripEffort grip_effort(std::span<const ContactPoint> contacts, std::optional<std::span<const ContactPoint>> tips,
                       const HandStrength& hand, const GripLoads& loads, std::span<FillEffort> fills,
                       Real tolerance = EFFORT_TOLERANCE);

// The largest force, N, that may act at `center` along each of +-x, +-y, +-z in addition to `weight` with an effort up to 1: the least of the six, at
// most MOST_PUSH. 0 if the weight alone needs more.
Real push_held(std::span<const ContactPoint> contacts, const HandStrength& hand, const Wrench& weight, Vec3 center,
               Real tolerance = EFFORT_TOLERANCE);

// The least friction at which the effort of every counted state is at most 1, to FRICTION_STEP; it is never too small by more than the effort's
// tolerance. Neither `hand.friction` nor the first state searched affects it beyond that. Infinite: more than MOST_FRICTION. `found`: grip_effort's
// result for the same grip. If its worst effort is at most 1, `hand.friction` is enough, and the answer is no more than that.
Real friction_needed(std::span<const ContactPoint> contacts, const HandStrength& hand, const GripLoads& loads,
                     const GripEffort& found, Real tolerance = EFFORT_TOLERANCE);

}  // namespace CORE_NS

// SPDX-License-Identifier: MIT
// The most turns that the loops of each kernel take in a dispatch. What a grip or a state takes decides how the host splits work into
// dispatches, and what it leaves to the core.
//
// Mesa's CPU driver ends every loop without a word after 65,535 turns of a vector of invocations, counted over all its loops together. A loop
// counts the turns until its last lane leaves it, and one for each time that the vector comes to it. No kernel takes more than TURN_BUDGET turns
// in a dispatch: the loops of most have bounds, and layout.h bounds those of efforts.
#pragma once

#include <algorithm>
#include <cstdint>

#include "shaders/layout.h"

namespace wholehand::host {

constexpr int TURN_BUDGET = 60000;
constexpr int MOST_LANES = 16;      // of a vector: 512 bits of float
constexpr int SELECT_LARGEST = 64;  // best grips that the device can select; the host selects more

// The turns of a loop of that many turns with `inside` turns in the loops of each.
constexpr std::int64_t loop_turns(std::int64_t turns, std::int64_t inside = 0) { return turns * (1 + inside) + 1; }

// ---- closure, rest, contact and overlap ----
struct GripSteps {
  int trace = TRACE_STEPS, advance = ADVANCE_STEPS;
};

struct GripLoops {
  int looped_elements = 0;  // of an outline that is not unrolled; 0: unrolled, or a lattice
  int between = 0;          // spheres on a bone
  bool proxies = false;
  int azimuths = 0;  // at which the wrist is evaluated
};

constexpr std::int64_t distance_turns(const GripLoops& loops) {
  return loops.looped_elements > 0 ? loop_turns(loops.looped_elements) : 0;
}

constexpr std::int64_t POINTS_TURNS = loop_turns(3);  // of a finger

constexpr std::int64_t closure_turns(const GripSteps& steps, const GripLoops& loops) {
  return loop_turns(2, loop_turns(steps.trace, distance_turns(loops))) + loop_turns(GAP_STEPS, 2 * POINTS_TURNS) +
         4 * POINTS_TURNS + loop_turns(JOINTS) + loop_turns(FINGERS, loop_turns(2, POINTS_TURNS));
}

constexpr std::int64_t rest_turns(const GripSteps& steps, const GripLoops& loops) {
  const std::int64_t distance = distance_turns(loops), places = 3 * (loops.between + 1);
  // A finger evaluates all points before each of four stages and once at rest; in pose paper it moves three points instead.
  return loop_turns(3, std::max(loop_turns(4 * (steps.advance + 1) + 5 * places, distance) + POINTS_TURNS,
                                loop_turns(3, distance + loop_turns(steps.advance, distance))));
}

constexpr std::int64_t contact_turns(const GripLoops& loops) {
  const std::int64_t distance = distance_turns(loops), proxy = loops.proxies ? loop_turns(PROXY_STEPS, 2 * distance) + distance : 0;
  return loop_turns(FINGERS, loop_turns(5, distance + proxy + 4) + loop_turns(4 * loops.between, distance + 4));
}

constexpr std::int64_t overlap_turns(const GripLoops& loops) {
  return (loops.between > 0 ? loop_turns(PHALANGES - 3, loop_turns(PHALANGES - 2, loop_turns(2))) : 0) +
         loop_turns(loops.azimuths, loop_turns(ARM_RAISES));
}

// The largest step limit, for a trace and a stage alike, that stays within the budget; below 1 if there is none.
constexpr int most_steps(const GripLoops& loops) {
  const auto most = [&](auto turns) {
    const std::int64_t none = turns(GripSteps{0, 0}, loops), each = turns(GripSteps{1, 1}, loops) - none;
    return static_cast<int>(std::min<std::int64_t>((TURN_BUDGET - none) / each, TRACE_STEPS));
  };
  return std::min(most(closure_turns), most(rest_turns));
}

// Whether a grip with that step limit stays within the budget in every kernel.
constexpr bool are_granted(const GripSteps& steps, const GripLoops& loops) {
  return closure_turns(steps, loops) <= TURN_BUDGET && rest_turns(steps, loops) <= TURN_BUDGET &&
         contact_turns(loops) <= TURN_BUDGET && overlap_turns(loops) <= TURN_BUDGET;
}
static_assert(are_granted({}, {0, MOST_BETWEEN, true, ARM_AZIMUTHS}));

// ---- force and score, of so many fills and states ----
constexpr std::int64_t force_turns(int states) { return loop_turns(states, loop_turns(1)); }  // each of a fill of its own
constexpr std::int64_t score_turns(int fills) { return loop_turns(fills) + loop_turns(6); }
static_assert(force_turns(STATES_IN_BLOCK) <= TURN_BUDGET);

// ---- efforts and reserves ----
// A pivot's: the loop over pivots, the one that finds the next state to solve, and three loops of a single turn. Beside them states that a lane
// passes by, and what a lane looks through by itself: all lanes of a vector may do so at different times.
constexpr int PIVOT_TURNS = 1 + 1 + 1 + 3 * 2;
constexpr std::int64_t effort_turns(int fills) {
  return loop_turns(EFFORT_TURNS, PIVOT_TURNS - 1) + MOST_LANES * (STATES_IN_BLOCK + DEVICE_RISES * loop_turns(STATES_IN_BLOCK)) +
         loop_turns(fills) + 2 * loop_turns(1);
}
constexpr std::int64_t reserve_turns() {
  return loop_turns(RESERVE_TURNS, PIVOT_TURNS - 1) + MOST_LANES * (STATES_IN_BLOCK + RESERVE_RAISE_TURNS + loop_turns(JOINTS)) +
         loop_turns(STATES_IN_BLOCK) + 4 * loop_turns(1);
}

constexpr int MANY_FILLS = 180;  // more than a scene may have
static_assert(effort_turns(MANY_FILLS) <= TURN_BUDGET && reserve_turns() <= TURN_BUDGET);

// ---- select ----
constexpr std::int64_t select_turns(int best) { return loop_turns(SELECT_ENTRIES, loop_turns(best)) + 2 * loop_turns(best); }
static_assert(select_turns(SELECT_LARGEST) <= TURN_BUDGET);

}  // namespace wholehand::host

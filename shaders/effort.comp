// SPDX-License-Identifier: MIT
// Kernel 10 over states, one plausible grip per invocation, as in core/grip_effort.cpp. A dispatch goes through the push.number states of a uniform
// block; the planes hold the previous dispatch's results.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "effort_solve.glsl"

#define JUST_HELD (Real(1) + ROUNDING)  // see core/grip_effort.cpp

bool is_safe;  // whether this dispatch is for safe tilts

// The state that the last lower bound's direction bounds highest, if that exceeds `most`.
uint highest(Solve solve, Real most, uint state) {
  for (uint i = 0u; i < push.number; ++i) {
    Real low = dot6(column(CUT), wanted_for(states_in[2u * i], states_in[2u * i + 1u])) / solve.cut_height;
    state = low > most ? i : state;
    most = max(most, low);
  }
  return state;
}

void put_worst(Real worst, Vec4 tilted, uint grip) {
  put_real(TASK == EFFORT_TIPS ? PLANE_TIPS_WORST_EFFORT : PLANE_WORST_EFFORT, 0, grip, worst);
  if (TASK == EFFORT_TIPS) return;
  put_real(PLANE_WORST_EFFORT_FILL, 0, grip, tilted.w);
  put_real(PLANE_WORST_EFFORT_TILT, 0, grip, tilted.z);
}

// Whether this task has work for a grip. NaN if a grip is not plausible, or not judged.
bool is_busy(uint grip) {
  uint status = uint_out[uint(PLANE_STATUS) * push.stride + grip];
  // the score is still an upper bound if a run has a floor
  bool is_new = TASK == EFFORT_WORST && !is_safe && push.first == 0u && push_floor() > Real(0);
  if (is_plausible(status) && is_new && real_out[uint(PLANE_SCORE) * push.stride + grip] < push_floor()) {
    status |= STATUS_UNJUDGED;
    put_uint(PLANE_STATUS, grip, status);
  }
  if (is_judged(status)) return !is_safe || kept(PLANE_WORST_EFFORT, 0, grip) > JUST_HELD;
  if (is_safe) {
    for (uint fill = 0u; fill < scene.fills; ++fill) put_real(PLANE_SAFE_TILT, int(fill), grip, NOT_A_NUMBER);
  } else {
    put_worst(NOT_A_NUMBER, Vec4(NOT_A_NUMBER), grip);
  }
  return false;
}

void main() {
  is_safe = TASK == EFFORT_WORST && push.flag != 0u;
  uint grip;
  bool has_grip = take_grip(INVOCATION < push.count && is_busy(INVOCATION), grip);
  ONCE_IF(has_grip) load_contacts(grip);
  // the largest effort so far; an effort up to `enough` need not be known
  Real worst = Real(0);
  if (!is_safe && has_grip) {
    if (push.first == 0u) put_worst(worst, states_in[1], grip);
    worst = kept(TASK == EFFORT_TIPS ? PLANE_TIPS_WORST_EFFORT : PLANE_WORST_EFFORT, 0, grip);
  }
  // the search first goes where the direction of a lower bound is highest, inexactly; then it compares each other state with the result
  int rises = DEVICE_RISES;
  bool is_rising = !is_safe;
  uint state = 0u;
  Solve solve;
  Search search = Search(false, false, false, 0);
  int turns = 0;
  uint k = has_grip ? 0u : push.number;
  for (; k < push.number && turns < EFFORT_TURNS; ++turns) {
    Real enough = is_safe ? JUST_HELD : is_rising ? Real(0) : worst * (Real(1) + HALF_TOLERANCE);
    // skips states that the last basis shows to be small, or on which nothing depends
    bool is_new = !search.is_solving;
    while (k < push.number && !search.is_solving) {
      state = is_rising ? state : k;
      Vec4 tilted = states_in[2u * state + 1u];
      Six wanted = wanted_for(states_in[2u * state], tilted);
      bool is_past = false;
      ONCE_IF(is_safe && tilted.z >= Real(0)) {
        Real safe_tilt = kept(PLANE_SAFE_TILT, int(tilted.w), grip);
        is_past = is_no_number(safe_tilt) || safe_tilt < tilted.z;
      }
      bool is_small = dot6(wanted, wanted) == Real(0) || (!is_rising && bound(wanted, search.has_basis) <= enough);
      search.is_solving = !is_past && !is_small;
      if (search.is_solving) solve = start(wanted);
      is_rising = is_rising && search.is_solving;
      k += search.is_solving ? 0u : 1u;
    }
    turn(search, solve, is_new && search.is_solving, is_rising && rises > 0 ? RISE_TOLERANCE : HALF_TOLERANCE, enough, is_safe ? JUST_HELD : INFINITE);
    ONCE_IF(search.is_solving && solve.done) {
      finish(search, solve);
      Vec4 tilted = states_in[2u * state + 1u];
      // a basis of another load may end in a corner: an effort that is then unknown is solved from the start
      bool is_decided = search.has_basis || !search.is_warm;
      bool is_coarse = is_rising && rises > 0 && search.has_basis;
      ONCE_IF(is_coarse) {
        uint next = highest(solve, solve.low * (Real(1) + RISE_TOLERANCE), state);
        rises = next == state ? 0 : rises - 1;
        state = next;
      }
      if (is_coarse || !is_decided) continue;
      if (is_safe) {
        if (!solve.is_enough && solve.effort > JUST_HELD) put_real(PLANE_SAFE_TILT, int(tilted.w), grip, tilted.z < Real(0) ? NOT_A_NUMBER : tilted.z);
      } else if (!solve.is_enough && solve.effort > max(enough, worst)) {
        worst = solve.effort;
        put_worst(worst, tilted, grip);
      }
      k += is_rising ? 0u : 1u;
      is_rising = false;
    }
  }
  leave_unfinished(grip, k < push.number);
}

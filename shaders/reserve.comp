// SPDX-License-Identifier: MIT
// One plausible grip per invocation, as push_held and friction_needed of core/grip_effort.cpp: the largest force in addition to the weight, or the
// least friction at which every state of a uniform block is held.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "effort_solve.glsl"

#define MOST_PUSH Real(1000000)
#define MOST_FRICTION Real(10)
#define FRICTION_STEP RATIO(1, 1000)
#define QUICK_RAISES 20  // of the friction for one state; then its range is halved
#define PUSHES 7u        // the weight alone, and a force along six directions

int raise_turns = 0;  // in which this grip searched for a friction

// The friction at which h(u) reaches a value: Newton's method, as in EffortSolver::least_friction. Each contact's support along u without friction,
// and the increase by a friction of 1, are the same in all turns, so where they are kept they are found once.
Real least_friction(Six direction, Real value) {
#if !SMALL
  Real along_copy[JOINTS], across_copy[JOINTS];
  UNROLL for (int j = 0; j < JOINTS; ++j) {
    along_copy[j] = press(arm_of(j), normal_of(j), Real(0), gamma, direction);
    across_copy[j] = press(arm_of(j), normal_of(j), Real(1), gamma, direction) - along_copy[j];
  }
#endif
  Real least = friction;
  ++raise_turns;  // the end of the loop, too
  [[dont_unroll]] for (int turn = 0; turn < JOINTS; ++turn) {
    ++raise_turns;
    Real height = Real(0), slope = Real(0), most = Real(0), growth = Real(0);
    UNROLL for (int k = 0; k < JOINTS; ++k) {
      int j = joint_in_order(k);
#if SMALL
      Real along = press(arm_of(j), normal_of(j), Real(0), gamma, direction);
      Real across = press(arm_of(j), normal_of(j), Real(1), gamma, direction) - along;
#else
      Real along = along_copy[j], across = across_copy[j];
#endif
      Real does = along + least * across;
      bool is_more = does > most;
      most = is_more ? does : most;
      growth = is_more ? across : growth;
      if (ends_digit(k)) {
        Real share = share_of(digit_in_order(k));
        height += share * most;
        slope += share * growth;
        most = growth = Real(0);
      }
    }
    if (turn > 0 && !(height > value)) return height < value && least >= MOST_FRICTION ? INFINITE : least;
    Real step = (height - value) / slope;
    Real next = slope > Real(0) ? clamp(least - step, Real(0), MOST_FRICTION) : height < value ? MOST_FRICTION : least;
    if (next == least) break;
    least = next;
  }
  return least;
}

// The weight upright at the largest fill, or a force of 1 N along an axis at its center.
Six wanted_push(uint k) {
  Vec3 fixed_center = (Real(1) - scene.largest_share) * own_center;
  Vec3 at = load_center(Load(scene.largest_mass, fixed_center, Real(0), scene.largest_height), pour);
  Vec3 lift = Vec3(Real(0), scene.largest_mass * gravity / unit_force, Real(0));
  if (k > 0u) {
    lift = Vec3(0);
    lift[(k - 1u) / 2u] = ((k & 1u) == 1u ? Real(-1) : Real(1)) / unit_force;
  }
  return wanted_at(at, lift);
}

int plane_of_task() { return TASK == EFFORT_PUSH ? PLANE_PUSH : PLANE_FRICTION_NEEDED; }

bool is_busy(uint grip) {
  uint status = uint_out[uint(PLANE_STATUS) * push.stride + grip];
  if (is_judged(status))
    return TASK == EFFORT_PUSH || push.first == 0u || kept(plane_of_task(), 0, grip) < NO_DISTANCE;
  put_real(plane_of_task(), 0, grip, NOT_A_NUMBER);
  return false;
}

void main() {
  uint grip;
  bool has_grip = take_grip(INVOCATION < push.count && is_busy(INVOCATION), grip);
  ONCE_IF(has_grip) load_contacts(grip);
  // the friction starts at the value of the worst state's direction, and continues from there in later blocks
  uint hardest = 0u;
  bool is_first = TASK == EFFORT_FRICTION && push.first == 0u;
  ONCE_IF(has_grip && TASK == EFFORT_FRICTION) {
    if (!is_first) friction = kept(PLANE_FRICTION_NEEDED, 0, grip);
    Real fill = kept(PLANE_WORST_EFFORT_FILL, 0, grip), tilt = kept(PLANE_WORST_EFFORT_TILT, 0, grip);
    for (uint i = 0u; i < push.number; ++i) hardest = states_in[2u * i + 1u].w == fill && states_in[2u * i + 1u].z == tilt ? i : hardest;
  }
  uint number = TASK == EFFORT_PUSH ? PUSHES : push.number;
  Real worst = Real(1) / MOST_PUSH;  // of the pushes' efforts
  Real low = friction, high = MOST_FRICTION;  // of this state: less friction than `low` does not hold
  int raises = 0;
  Solve solve;
  Search search = Search(false, false, false, 0);
  int turns = 0;
  uint k = has_grip ? 0u : number;
  for (; k < number && turns < RESERVE_TURNS && raise_turns < RESERVE_RAISE_TURNS; ++turns) {
    bool is_push = TASK == EFFORT_PUSH && k > 0u;
    Real enough = is_push ? worst : is_first ? Real(0) : Real(1), too_much = is_push || is_first ? INFINITE : Real(1);
    bool is_new = !search.is_solving;
    while (k < number && !search.is_solving) {
      uint state = k == 0u ? hardest : k <= hardest ? k - 1u : k;
      Six wanted = TASK == EFFORT_PUSH ? wanted_push(k) : wanted_for(states_in[2u * state], states_in[2u * state + 1u]);
      if (k > 0u) enough = TASK == EFFORT_PUSH ? worst : Real(1);
      if (k > 0u) too_much = TASK == EFFORT_PUSH ? INFINITE : Real(1);
      bool may_pass = TASK == EFFORT_PUSH || friction <= low + FRICTION_STEP;
      search.is_solving = dot6(wanted, wanted) > Real(0) && !(may_pass && bound(wanted, search.has_basis) <= enough);
      if (search.is_solving) solve = start(wanted);
      if (search.is_solving) continue;
      k += 1u;
      low = friction;
      high = MOST_FRICTION;
      raises = 0;
    }
    turn(search, solve, is_new && search.is_solving, is_first ? RISE_TOLERANCE : HALF_TOLERANCE, enough, too_much);
    ONCE_IF(search.is_solving && solve.done) {
      finish(search, solve);
      if (!search.has_basis && search.is_warm && !is_first) continue;  // once more from the start
      bool is_held = solve.effort * (Real(1) - HALF_TOLERANCE) <= Real(1);
      // one call for both uses, because each call is compiled separately
      bool asks = TASK == EFFORT_FRICTION && (is_first || (!is_held && !(friction >= MOST_FRICTION)));
      Real asked = friction;
      ONCE_IF(asks) asked = least_friction(column(CUT), dot6(column(CUT), solve.wanted));
      if (TASK == EFFORT_PUSH) {
        bool is_alone = k == 0u;
        worst = is_alone ? (solve.effort < Real(1) ? worst : INFINITE) : max(worst, solve.effort);
        k = worst < NO_DISTANCE ? k + 1u : number;
        if (is_alone) displaced = solve.wanted;
        search.has_basis = search.has_basis && !is_alone;
      } else if (is_first) {
        friction = min(MOST_FRICTION, asked);
        low = friction;
        is_first = false;
        search.has_basis = false;
      } else if (is_held && friction <= low + FRICTION_STEP) {
        k += 1u;
        low = friction;
        high = MOST_FRICTION;
        raises = 0;
      } else if (!is_held && friction >= MOST_FRICTION) {
        friction = INFINITE;
        k = number;
      } else {
        Real before = friction;
        if (is_held) {
          high = friction;
        } else {
          low = max(friction, asked);
        }
        friction = min(MOST_FRICTION, max(low + FRICTION_STEP, raises < QUICK_RAISES ? Real(0) : (low + high) / Real(2)));
        search.has_basis = search.has_basis && friction >= before;
        raises += 1;
      }
    }
  }
  if (TASK == EFFORT_FRICTION && has_grip && kept(PLANE_WORST_EFFORT, 0, grip) <= Real(1)) friction = min(friction, scene.friction);
  ONCE_IF(has_grip)
    put_real(plane_of_task(), 0, grip, TASK == EFFORT_FRICTION ? (is_first ? Real(0) : friction) : worst < NO_DISTANCE ? Real(1) / worst : Real(0));
  leave_unfinished(grip, k < number);
}

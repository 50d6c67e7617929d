// SPDX-License-Identifier: MIT
// Shared by the effort kernels: the contacts of a grip, the support function of Z, and a solve pivot by pivot.
#ifndef EFFORT_SOLVE_GLSL
#define EFFORT_SOLVE_GLSL

#include "build.glsl"
#include "force.glsl"
#include "gauge.glsl"
#include "grips.glsl"
#include "trig.glsl"

#define HALF_TOLERANCE (Real(0.5) * EFFORT_TOLERANCE)
#define RISE_TOLERANCE RATIO(1, 20)  // of an effort that only directs the search
#define FRESH_PIVOTS 20  // pivots after which the inverse is refined

layout(constant_id = CONST_CONTACTS) const int CONTACTS = -1;
layout(constant_id = CONST_EFFORT_TASK) const int TASK = EFFORT_WORST;

// The hand's contacts about `center` in units of length, 0 if there is none; strengths in units of force.
Vec3 center, pour;
Real unit_length, unit_force, unit_strength, gamma, dear;
Real friction;
Six displaced;      // by which points of Z are smaller, see EffortSolver::displace
Vec3 line, middle;  // of the two tips: unit; m from `center`; without torsion
bool are_alone;     // the tips

// The joints digit by digit: three of the thumb, four of each finger, and those of the palm.
int joint_in_order(int k) { return k < 3 ? k + 1 : k < 19 ? k + 2 + (k - 3) / 4 : max(5 * (k - 19) - 1, 0); }
int digit_in_order(int k) { return k < 3 ? 0 : k < 19 ? 1 + (k - 3) / 4 : FINGERS; }
bool ends_digit(int k) { return k == JOINTS - 1 || digit_in_order(k) != digit_in_order(k + 1); }

Real strength_of(int digit) {
  return digit == 0   ? scene.thumb_strength
         : digit == 1 ? scene.index_strength
         : digit == 2 ? scene.middle_strength
         : digit == 3 ? scene.ring_strength
         : digit == 4 ? scene.little_strength
                      : scene.palm_strength;
}

bool is_pressing(int joint, Vec3 normal) {
  return (TASK != EFFORT_TIPS || joint == THUMB_TIP || joint == INDEX_TIP) && dot(normal, normal) > Real(0);
}

#if SMALL

uint own_grip;
void read_contacts(uint grip) { own_grip = grip; }
Vec3 place_at(int joint) { return kept_vector(CONTACTS + CONTACT_STRIDE * joint, own_grip); }
Vec3 normal_of(int joint) { return kept_vector(CONTACTS + CONTACT_STRIDE * joint + 3, own_grip); }
#define own_center Vec3(scene.center_x, scene.center_y, scene.center_z)
#define gravity scene.gravity
Real share_of(int digit) { return strength_of(digit) / unit_strength; }
Vec3 arm_of(int joint) { return (place_at(joint) - center) / unit_length; }
void keep_arms() {}

#else

// Loaded before the loops over states, in which llvmpipe would gather each value lane by lane.
Vec3 arms[JOINTS], normals[JOINTS];  // at first places instead of arms
Vec3 own_center;
Real gravity;
Real shares[DIGITS];
void read_contacts(uint grip) {
  UNROLL for (int j = 0; j < JOINTS; ++j) {
    arms[j] = kept_vector(CONTACTS + CONTACT_STRIDE * j, grip);
    normals[j] = kept_vector(CONTACTS + CONTACT_STRIDE * j + 3, grip);
  }
  own_center = Vec3(scene.center_x, scene.center_y, scene.center_z);
  gravity = scene.gravity;
}
Vec3 place_at(int joint) { return arms[joint]; }
Vec3 normal_of(int joint) { return normals[joint]; }
Real share_of(int digit) { return shares[digit]; }
Vec3 arm_of(int joint) { return arms[joint]; }
void keep_arms() {
  UNROLL for (int j = 0; j < JOINTS; ++j) arms[j] = is_pressing(j, normals[j]) ? (arms[j] - center) / unit_length : Vec3(0);
  UNROLL for (int digit = 0; digit < DIGITS; ++digit) shares[digit] = strength_of(digit) / unit_strength;
}

#endif

void load_contacts(uint grip) {
  read_contacts(grip);
  Real count = Real(0), strongest = Real(0), weakest = NO_DISTANCE;
  center = Vec3(0);
  friction = scene.friction;
  displaced = Six(Vec3(0), Vec3(0));
  UNROLL for (int k = 0; k < JOINTS; ++k) {
    int j = joint_in_order(k);
    bool presses = is_pressing(j, normal_of(j));
    Real strength = strength_of(digit_in_order(k));
    center += presses ? place_at(j) : Vec3(0);
    count += presses ? Real(1) : Real(0);
    strongest = presses ? max(strongest, strength) : strongest;
    weakest = presses ? min(weakest, strength) : weakest;
  }
  center /= max(count, Real(1));
  unit_length = max(LEAST_LENGTH, scene.torsion);
  UNROLL for (int j = 0; j < JOINTS; ++j)
    unit_length = is_pressing(j, normal_of(j)) ? max(unit_length, length(place_at(j) - center)) : unit_length;
  if (BARE) {
    bool has_thumb = is_pressing(THUMB_TIP, normal_of(THUMB_TIP)), has_index = is_pressing(INDEX_TIP, normal_of(INDEX_TIP));
    Vec3 thumb = has_thumb ? place_at(THUMB_TIP) - center : Vec3(0), index = has_index ? place_at(INDEX_TIP) - center : Vec3(0);
    middle = (thumb + index) / Real(2);
    are_alone = count == Real(2);
    line = has_thumb && has_index && thumb != index ? normalize(index - thumb) : Vec3(0);
  }
  unit_strength = unit_force = strongest > Real(0) ? strongest : Real(1);
  dear = UNRESISTED_EFFORT * (strongest > Real(0) ? strongest / weakest : Real(1));
  gamma = scene.torsion / unit_length;
  keep_arms();
  if (PLANE_GAP >= 0 && scene.tip_radii > Real(0)) {
    Real gap = real_out[uint(PLANE_GAP) * push.stride + grip];
    unit_force *= strength_at(gap - grip_axis(AXIS_HAND_SCALE, grip) * scene.tip_radii);
  }
  pour = pour_direction(grip_direction(grip_axis(AXIS_AZIMUTH, grip), grip_axis(AXIS_OBLIQUITY, grip)), scene.pour_sense);
}

// h(u), and the point of Z that attains it: for each digit the contact with the largest support, if positive.
Real support(Six direction, out Six point) {
  point = Six(-displaced.first, -displaced.second);
  Real most = Real(0);
  Vec3 arm = Vec3(0), normal = Vec3(0);
  UNROLL for (int k = 0; k < JOINTS; ++k) {
    int j = joint_in_order(k);
    if (TASK != EFFORT_TIPS || j == THUMB_TIP || j == INDEX_TIP) {
      Vec3 arm_here = arm_of(j), normal_here = normal_of(j);
      Real value = press(arm_here, normal_here, friction, gamma, direction);
      bool is_more = value > most;
      most = is_more ? value : most;
      arm = is_more ? arm_here : arm;
      normal = is_more ? normal_here : normal;
    }
    if (ends_digit(k)) {
      point = plus(point, share_of(digit_in_order(k)), pressed(arm, normal, friction, gamma, direction));
      most = Real(0);
      arm = normal = Vec3(0);
    }
  }
  return dot6(direction, point);
}

// The wrench of a unit force at a place, in the units of force and length. Without torsion, it omits a lever about the tips' line that counts as 0.
Six wanted_at(Vec3 place, Vec3 lift) {
  Vec3 arm = place - center, moment = cross(arm / unit_length, lift);
  if (BARE) {
    Vec3 pivot = arm - middle;
    Real turn = dot(line, cross(pivot, lift)), force = length(lift);
    bool counts = abs(turn) > force * longest_bare_lever(length(pivot));
    Real least = are_alone ? force * unit_length : Real(0);
    Real kept = counts ? max(abs(turn), least) : Real(0);
    moment += (((turn > Real(0) ? kept : -kept) - turn) / unit_length) * line;
  }
  return Six(lift, moment);
}

// The wrench that balances the weight.
Six wanted_for(Vec4 weight, Vec4 tilted) {
  Load load = Load(weight.x, (Real(1) - weight.y) * own_center, weight.z, weight.w);
  return wanted_at(load_center(load, pour), (weight.x * gravity / unit_force) * up_direction(pour, tilted.x, tilted.y));
}

struct Solve {
  Six wanted;
  Real size, low, effort, cut_height;
  int pivots;
  bool done, is_enough, is_known, is_beyond;  // `is_enough`: forces exist for an effort that need not be known more closely
};

Solve start(Six wanted) {
  Solve solve;
  solve.wanted = wanted;
  solve.size = sqrt(dot6(solve.wanted, solve.wanted));
  set_column(CUT, Six(Vec3(0), Vec3(0)), true);
  solve.cut_height = Real(1);
  solve.low = solve.effort = Real(0);
  solve.pivots = 0;
  solve.done = solve.is_enough = solve.is_known = solve.is_beyond = false;
  return solve;
}

// An upper bound by the last basis; infinite if it does not hold the load, or there is none.
Real bound(Six wanted, bool has_basis) {
  Real levels[6];
  levels_of(wanted, levels);
  Cost cost = cost_of(levels);
  Real rounding = ROUNDING * sqrt(dot6(wanted, wanted));
  return has_basis && cost.least >= -rounding && cost.artificial <= rounding ? cost.real : INFINITE;
}

// One pivot of core/effort.cpp's solve.
void step(inout Solve solve, Real tolerance, Real enough, Real too_much, bool is_solving) {
  COUNT_LANES(is_solving);
  Real levels[6];
  levels_of(solve.wanted, levels);
  Cost cost = cost_of(levels);
  bool is_short = cost.artificial > ROUNDING * solve.size;
  Six direction = priced(is_short), point;
  Real height = support(direction, point), value = dot6(direction, solve.wanted);
  bool is_higher = value > Real(0) && value > solve.low * height;
  solve.low = is_higher ? (height > Real(0) ? value / height : INFINITE) : solve.low;
  set_column(CUT, direction, is_higher);
  solve.cut_height = is_higher ? height : solve.cut_height;
  bool is_never = solve.low > dear * solve.size;
  solve.is_beyond = solve.low > too_much;
  solve.is_enough = !is_short && cost.real <= enough;
  solve.is_known = solve.is_enough || (!is_short && cost.real - solve.low <= tolerance * cost.real);
  solve.done = is_never || solve.is_beyond || solve.is_known || solve.pivots == DEVICE_PIVOTS || !(height > (is_short ? Real(0) : Real(1)));
  solve.effort = is_never || solve.is_beyond || is_short ? INFINITE : cost.real;
  bool is_entered = enter(point, levels, ROUNDING * solve.size, is_solving && !solve.done);
  solve.done = solve.done || !is_entered;
  solve.pivots += 1;
}

// State of a grip's loop over states: whether there is a basis, whether it is another load's, whether a state is being solved.
struct Search {
  bool has_basis, is_warm, is_solving;
  int pivots;  // since the inverse was refined
};

// One turn of that loop. It has no branch, and a loop only where the inverse is refined, because both copy the basis.
void turn(inout Search search, inout Solve solve, bool is_new, Real tolerance, Real enough, Real too_much) {
  search.is_warm = is_new ? search.has_basis : search.is_warm;
  restart(solve.wanted, ROUNDING * solve.size, is_new && !search.has_basis, is_new && search.has_basis);
  search.has_basis = search.has_basis || is_new;
  ONCE_IF(search.is_solving && search.pivots >= FRESH_PIVOTS) {
    refine();
    search.pivots = 0;
  }
  search.pivots += search.is_solving ? 1 : 0;
  step(solve, tolerance, enough, too_much, search.is_solving);
  // if no column enters and the effort is not known, rounding may have accumulated: tries once more from a refined inverse
  bool is_decided = solve.is_known || solve.is_beyond || solve.low > dear * solve.size;
  if (search.is_solving && solve.done && !is_decided && search.pivots > 1 && solve.pivots < DEVICE_PIVOTS) {
    solve.done = false;
    search.pivots = FRESH_PIVOTS;
  }
}

// The effort computed anew, without the rounding of the inverse. One that was enough stays so, even if it is now a little larger.
void finish(inout Search search, inout Solve solve) {
  Real levels[6];
  balanced_levels(solve.wanted, levels);
  Cost cost = cost_of(levels);
  bool holds = cost.artificial <= ROUNDING * solve.size && solve.effort < NO_DISTANCE;
  solve.effort = holds ? cost.real : INFINITE;
  solve.is_enough = solve.is_enough && holds;
  search.has_basis = (solve.effort < NO_DISTANCE && solve.is_known) || solve.is_beyond;
  search.is_solving = false;
}

// If a grip's turns ran out before its states did.
void leave_unfinished(uint grip, bool is_unfinished) {
  ONCE_IF(is_unfinished) uint_out[uint(PLANE_STATUS) * push.stride + grip] |= STATUS_OUT_OF_TURNS;
}

#endif

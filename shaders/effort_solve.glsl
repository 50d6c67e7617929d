// SPDX-License-Identifier: MIT
// What the kernels of efforts share: the contacts of a grip in registers, the support function of Z, and a solve pivot by pivot.
#ifndef EFFORT_SOLVE_GLSL
#define EFFORT_SOLVE_GLSL

#include "force.glsl"
#include "gauge.glsl"
#include "grips.glsl"
#include "planes.glsl"
#include "status.h"
#include "trig.glsl"

#define HALF_TOLERANCE (Real(0.5) * EFFORT_TOLERANCE)
#define RISE_TOLERANCE RATIO(1, 20)  // of an effort that only directs the search
#define FRESH_PIVOTS 20  // pivots after which the inverse is refined

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_CONTACTS) const int CONTACTS = -1;
layout(constant_id = CONST_EFFORT_TASK) const int TASK = EFFORT_WORST;
layout(constant_id = CONST_BARE) const bool BARE = true;
layout(std140, binding = BINDING_STATES) uniform StateBlock { Vec4 states_in[2 * STATES_IN_BLOCK]; };

// The grips of the group that there is something to do for, one after another: all lanes of a vector run until the slowest is done.
shared uint busy_grips[GROUP_SIZE];
shared uint busy_count;

// What a grip holds with: contacts about `center` in units of length, 0 where there is none; strengths in units of force.
Vec3 arms[JOINTS], normals[JOINTS];
Vec3 center, pour;
Real unit_length, unit_force, gamma, dear;
// Scene values, loaded before the loops over states: in them a driver would gather each lane by lane.
Vec3 own_center;
Real gravity;
Real friction;
Real shares[DIGITS];
Six displaced;      // what points of Z are less, see EffortSolver::displace
Vec3 line, middle;  // of the two tips: unit; m from `center`; without torsion
bool are_alone;     // the tips

int digit_of(int joint) {
  int finger = joint < 4 ? 0 : (joint + 1) / 5;
  return joint == 0 || joint == 5 * finger - 1 ? FINGERS : finger;
}

bool is_pressing(int joint) {
  return (TASK != EFFORT_TIPS || joint == THUMB_TIP || joint == INDEX_TIP) && dot(normals[joint], normals[joint]) > Real(0);
}

Vec3 contact_vector(int vector, uint grip) {
  uint at = uint(CONTACTS + 3 * vector) * push.stride + grip;
  return Vec3(real_out[at], real_out[at + push.stride], real_out[at + 2u * push.stride]);
}

void load_contacts(uint grip) {
  shares = Real[](scene.thumb_strength, scene.index_strength, scene.middle_strength, scene.ring_strength, scene.little_strength,
                  scene.palm_strength);
  Real count = Real(0), strongest = Real(0), weakest = NO_DISTANCE;
  center = Vec3(0);
  friction = scene.friction;
  own_center = Vec3(scene.center_x, scene.center_y, scene.center_z);
  gravity = scene.gravity;
  displaced = Six(Vec3(0), Vec3(0));
  [[unroll]] for (int j = 0; j < JOINTS; ++j) {
    arms[j] = contact_vector(2 * j, grip);
    normals[j] = contact_vector(2 * j + 1, grip);
    bool presses = is_pressing(j);
    center += presses ? arms[j] : Vec3(0);
    count += presses ? Real(1) : Real(0);
    strongest = presses ? max(strongest, shares[digit_of(j)]) : strongest;
    weakest = presses ? min(weakest, shares[digit_of(j)]) : weakest;
  }
  center /= max(count, Real(1));
  unit_length = max(LEAST_LENGTH, scene.torsion);
  [[unroll]] for (int j = 0; j < JOINTS; ++j) {
    arms[j] = is_pressing(j) ? arms[j] - center : Vec3(0);
    unit_length = max(unit_length, length(arms[j]));
  }
  if (BARE) {
    bool is_pinch = is_pressing(THUMB_TIP) && is_pressing(INDEX_TIP) && arms[THUMB_TIP] != arms[INDEX_TIP];
    middle = (arms[THUMB_TIP] + arms[INDEX_TIP]) / Real(2);
    are_alone = count == Real(2);
    line = is_pinch ? normalize(arms[INDEX_TIP] - arms[THUMB_TIP]) : Vec3(0);
  }
  unit_force = strongest > Real(0) ? strongest : Real(1);
  dear = UNRESISTED_EFFORT * (strongest > Real(0) ? strongest / weakest : Real(1));
  gamma = scene.torsion / unit_length;
  [[unroll]] for (int j = 0; j < JOINTS; ++j) arms[j] /= unit_length;
  [[unroll]] for (int digit = 0; digit < DIGITS; ++digit) shares[digit] /= unit_force;
  if (PLANE_GAP >= 0 && scene.tip_radii > Real(0)) {
    Real gap = real_out[uint(PLANE_GAP) * push.stride + grip];
    unit_force *= strength_at(gap - grip_axis(AXIS_HAND_SCALE, grip) * scene.tip_radii);
  }
}

// h(u), and the point of Z where it is attained: of each digit the contact that does most, where it does more than nothing.
Real support(Six direction, out Six point) {
  point = Six(-displaced.first, -displaced.second);
  Real most[DIGITS];
  Vec3 arm[DIGITS], normal[DIGITS];
  [[unroll]] for (int digit = 0; digit < DIGITS; ++digit) {
    most[digit] = Real(0);
    arm[digit] = Vec3(0);
    normal[digit] = Vec3(0);
  }
  [[unroll]] for (int j = 0; j < JOINTS; ++j) {
    if (TASK == EFFORT_TIPS && j != THUMB_TIP && j != INDEX_TIP) continue;
    int digit = digit_of(j);
    Real value = press(arms[j], normals[j], friction, gamma, direction);
    bool is_more = value > most[digit];
    most[digit] = is_more ? value : most[digit];
    arm[digit] = is_more ? arms[j] : arm[digit];
    normal[digit] = is_more ? normals[j] : normal[digit];
  }
  [[unroll]] for (int digit = 0; digit < DIGITS; ++digit) {
    Six wrench = pressed(arm[digit], normal[digit], friction, gamma, direction);
    point.first += shares[digit] * wrench.first;
    point.second += shares[digit] * wrench.second;
  }
  return dot6(direction, point);
}

// The wrench of a force in its unit at a place, in the units of force and length. Without torsion, without the lever about the tips' line that is none.
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
  Six wanted, cut;  // the direction of the last lower bound
  Real size, low, effort, cut_height;
  int pivots;
  bool done, is_enough, is_known, is_beyond;  // `is_enough`: forces of an effort that need not be known closer are found
};

Solve start(Six wanted) {
  Solve solve;
  solve.wanted = wanted;
  solve.size = sqrt(dot6(solve.wanted, solve.wanted));
  solve.cut = Six(Vec3(0), Vec3(0));
  solve.cut_height = Real(1);
  solve.low = solve.effort = Real(0);
  solve.pivots = 0;
  solve.done = solve.is_enough = solve.is_known = solve.is_beyond = false;
  return solve;
}

// An upper bound by the last basis; infinite where it does not hold the load, or there is none.
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
  solve.cut.first = is_higher ? direction.first : solve.cut.first;
  solve.cut.second = is_higher ? direction.second : solve.cut.second;
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

// The effort anew, less the rounding of the inverse. One that was enough stays so, even if it is a little larger now.
void finish(inout Solve solve) {
  Real levels[6];
  balanced_levels(solve.wanted, levels);
  Cost cost = cost_of(levels);
  bool holds = cost.artificial <= ROUNDING * solve.size && solve.effort < INFINITE;
  solve.effort = holds ? cost.real : INFINITE;
  solve.is_enough = solve.is_enough && holds;
}

Real kept(int plane, int offset, uint grip) { return plane >= 0 ? real_out[uint(plane + offset) * push.stride + grip] : NOT_A_NUMBER; }

// Where a grip's turns ran out before its states did.
void leave_unfinished(uint grip, bool is_unfinished) {
  [[dont_unroll]] for (bool once = is_unfinished; once; once = false) uint_out[uint(PLANE_STATUS) * push.stride + grip] |= STATUS_OUT_OF_TURNS;
}

#endif

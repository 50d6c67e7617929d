// SPDX-License-Identifier: MIT
// Kernel 10 of one plausible grip an invocation over states, as core/grip_effort.cpp has it. A dispatch goes through the push.number states of
// a uniform block; what the dispatch before found is in the planes.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "force.glsl"
#include "gauge.glsl"
#include "grips.glsl"
#include "planes.glsl"
#include "trig.glsl"

#define HALF_TOLERANCE (Real(0.5) * EFFORT_TOLERANCE)
#define RISE_TOLERANCE RATIO(1, 20)  // of an effort that only tells where to look next
#define RISE_STEPS 4
#define FRESH_PIVOTS 20  // after so many the inverse is refined

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_CONTACTS) const int CONTACTS = -1;
layout(constant_id = CONST_EFFORT_TASK) const int TASK = EFFORT_WORST;
layout(std140, binding = BINDING_STATES) uniform StateBlock { Vec4 states_in[2 * STATES_IN_BLOCK]; };

// The grips of the group that there is something to do for, one after another: all lanes of a vector run until the slowest is done.
shared uint busy_grips[GROUP_SIZE];
shared uint busy_count;

// What a grip holds with: contacts about `center` in units of length, 0 where there is none; strengths in units of force.
Vec3 arms[JOINTS], normals[JOINTS];
Vec3 center, pour;
Real unit_length, unit_force, gamma, dear;
Real shares[DIGITS];

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
  unit_force = strongest > Real(0) ? strongest : Real(1);
  dear = UNRESISTED_EFFORT * (strongest > Real(0) ? strongest / weakest : Real(1));
  gamma = scene.torsion / unit_length;
  [[unroll]] for (int j = 0; j < JOINTS; ++j) arms[j] /= unit_length;
  [[unroll]] for (int digit = 0; digit < DIGITS; ++digit) shares[digit] /= unit_force;
}

// h(u), and the point of Z where it is attained: of each digit the contact that does most, where it does more than nothing.
Real support(Six direction, out Six point) {
  point = Six(Vec3(0), Vec3(0));
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
    Real value = press(arms[j], normals[j], scene.friction, gamma, direction);
    bool is_more = value > most[digit];
    most[digit] = is_more ? value : most[digit];
    arm[digit] = is_more ? arms[j] : arm[digit];
    normal[digit] = is_more ? normals[j] : normal[digit];
  }
  [[unroll]] for (int digit = 0; digit < DIGITS; ++digit) {
    Six wrench = pressed(arm[digit], normal[digit], scene.friction, gamma, direction);
    point.first += shares[digit] * wrench.first;
    point.second += shares[digit] * wrench.second;
  }
  return dot6(direction, point);
}

// The wrench that balances the weight, in the units of force and length.
Six wanted_for(Vec4 weight, Vec4 tilted) {
  Load load = Load(weight.x, (Real(1) - weight.y) * Vec3(scene.center_x, scene.center_y, scene.center_z), weight.z, weight.w);
  Vec3 lift = (weight.x * scene.gravity / unit_force) * up_direction(pour, tilted.x, tilted.y);
  return Six(lift, cross((load_center(load, pour) - center) / unit_length, lift));
}

struct Solve {
  Six wanted, cut;  // the direction of the last lower bound
  Real size, low, effort, cut_height;
  int pivots;
  bool done, is_known, is_beyond;
};

Solve start(Six wanted) {
  Solve solve;
  solve.wanted = wanted;
  solve.size = sqrt(dot6(solve.wanted, solve.wanted));
  solve.cut = Six(Vec3(0), Vec3(0));
  solve.cut_height = Real(1);
  solve.low = solve.effort = Real(0);
  solve.pivots = 0;
  solve.done = solve.is_known = solve.is_beyond = false;
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
  solve.is_known = !is_short && (cost.real <= enough || cost.real - solve.low <= tolerance * cost.real);
  solve.done = is_never || solve.is_beyond || solve.is_known || solve.pivots == DEVICE_PIVOTS || !(height > (is_short ? Real(0) : Real(1)));
  solve.effort = is_never || solve.is_beyond || is_short ? INFINITE : cost.real;
  bool is_entered = enter(point, levels, ROUNDING * solve.size, is_solving && !solve.done);
  solve.done = solve.done || !is_entered;
  solve.pivots += 1;
}

// The effort anew, less the rounding of the inverse.
void finish(inout Solve solve) {
  Real levels[6];
  balanced_levels(solve.wanted, levels);
  Cost cost = cost_of(levels);
  bool holds = cost.artificial <= ROUNDING * solve.size && solve.effort < INFINITE;
  solve.effort = holds ? cost.real : INFINITE;
}

Real kept(int plane, int offset, uint grip) { return plane >= 0 ? real_out[uint(plane + offset) * push.stride + grip] : NOT_A_NUMBER; }

// The state that the last lower bound's direction bounds most, where that is more than `most`.
uint highest(Solve solve, Real most, uint state) {
  for (uint i = 0u; i < push.number; ++i) {
    Real low = dot6(solve.cut, wanted_for(states_in[2u * i], states_in[2u * i + 1u])) / solve.cut_height;
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

// Whether this task has something to do for a grip. NaN where a grip is not plausible.
bool is_busy(uint grip) {
  uint status = uint_out[uint(PLANE_STATUS) * push.stride + grip];
  if ((status & (STATUS_REASON_MASK | STATUS_PLAUSIBLE)) == STATUS_PLAUSIBLE)
    return TASK != EFFORT_SAFE || kept(PLANE_WORST_EFFORT, 0, grip) > Real(1);
  if (TASK == EFFORT_SAFE) {
    for (uint fill = 0u; fill < scene.fills; ++fill) put_real(PLANE_SAFE_TILT, int(fill), grip, NOT_A_NUMBER);
  } else {
    put_worst(NOT_A_NUMBER, Vec4(NOT_A_NUMBER), grip);
  }
  return false;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) busy_count = 0u;
  barrier();
  if (INVOCATION < push.count && is_busy(INVOCATION)) busy_grips[atomicAdd(busy_count, 1u)] = INVOCATION;
  barrier();
  bool has_grip = gl_LocalInvocationIndex < busy_count;
  uint grip = 0u;
  // a loop of one turn is passed by where no lane takes it; a branch is not
  [[dont_unroll]] for (bool once = has_grip; once; once = false) {
    grip = busy_grips[gl_LocalInvocationIndex];
    load_contacts(grip);
    Real sa, ca, sb, cb;
    sine_cosine(grip_axis(AXIS_AZIMUTH, grip), sa, ca);
    sine_cosine(grip_axis(AXIS_OBLIQUITY, grip), sb, cb);
    pour = pour_direction(Vec3(cb * ca, sb, -cb * sa), scene.pour_sense);
  }
  // the largest effort so far; one up to `enough` need not be known
  Real worst = Real(0);
  if (TASK != EFFORT_SAFE && has_grip) {
    if (push.first == 0u) put_worst(worst, states_in[1], grip);
    worst = kept(TASK == EFFORT_TIPS ? PLANE_TIPS_WORST_EFFORT : PLANE_WORST_EFFORT, 0, grip);
  }
  // first the search goes where the direction of a lower bound is highest, not yet exactly; then each other state is compared with what it found
  int rises = RISE_STEPS;
  bool is_rising = TASK != EFFORT_SAFE;
  uint state = 0u;
  int pivots = 0;  // since the inverse was refined
  Solve solve;
  Six wanted;
  bool has_basis = false, is_warm = false, is_solving = false;
  uint k = has_grip ? 0u : push.number;
  while (k < push.number) {
    Real enough = TASK == EFFORT_SAFE ? Real(1) : is_rising ? Real(0) : worst * (Real(1) + HALF_TOLERANCE);
    // states that the last basis shows to be small, or that nothing depends on, are passed by
    bool is_new = !is_solving;
    while (k < push.number && !is_solving) {
      state = is_rising ? state : k;
      Vec4 tilted = states_in[2u * state + 1u];
      wanted = wanted_for(states_in[2u * state], tilted);
      bool is_past = TASK == EFFORT_SAFE && tilted.z >= Real(0) && !(kept(PLANE_SAFE_TILT, int(tilted.w), grip) >= tilted.z);
      bool is_small = dot6(wanted, wanted) == Real(0) || (!is_rising && bound(wanted, has_basis) <= enough);
      is_solving = !is_past && !is_small;
      is_rising = is_rising && is_solving;
      k += is_solving ? 0u : 1u;
    }
    // without a loop or a branch: those copy the basis
    is_new = is_new && is_solving;
    is_warm = is_new ? has_basis : is_warm;
    if (is_new) solve = start(wanted);
    restart(solve.wanted, ROUNDING * solve.size, is_new && !has_basis, is_new && has_basis);
    has_basis = has_basis || is_new;
    Real tolerance = is_rising && rises > 0 ? RISE_TOLERANCE : HALF_TOLERANCE;
    [[dont_unroll]] for (bool once = is_solving && pivots >= FRESH_PIVOTS; once; once = false) {
      refine();
      pivots = 0;
    }
    pivots += is_solving ? 1 : 0;
    step(solve, tolerance, enough, TASK == EFFORT_SAFE ? Real(1) : INFINITE, is_solving);
    // where no column enters and the effort is not known, rounding may have gathered: once more from a refined inverse
    bool is_told_apart = solve.is_known || solve.is_beyond || solve.low > dear * solve.size;
    if (is_solving && solve.done && !is_told_apart && pivots > 1 && solve.pivots < DEVICE_PIVOTS) {
      solve.done = false;
      pivots = FRESH_PIVOTS;
    }
    [[dont_unroll]] for (bool once = is_solving && solve.done; once; once = false) {
      finish(solve);
      Vec4 tilted = states_in[2u * state + 1u];
      has_basis = (solve.effort < INFINITE && solve.is_known) || solve.is_beyond;
      is_solving = false;
      // a basis of another load may end in a corner: what is not known then is told from the start
      bool is_told = has_basis || !is_warm;
      bool is_coarse = is_rising && rises > 0 && has_basis;
      [[dont_unroll]] for (bool rise = is_coarse; rise; rise = false) {
        uint next = highest(solve, solve.low * (Real(1) + RISE_TOLERANCE), state);
        rises = next == state ? 0 : rises - 1;
        state = next;
      }
      if (is_coarse || !is_told) continue;
      if (TASK == EFFORT_SAFE) {
        if (solve.effort > Real(1)) put_real(PLANE_SAFE_TILT, int(tilted.w), grip, tilted.z < Real(0) ? NOT_A_NUMBER : tilted.z);
      } else if (solve.effort > max(enough, worst)) {
        worst = solve.effort;
        put_worst(worst, tilted, grip);
      }
      k += is_rising ? 0u : 1u;
      is_rising = false;
    }
  }
}

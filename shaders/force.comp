// SPDX-License-Identifier: MIT
// Kernel 7 of TOGETHER grips an invocation over fills and tilts, reduced to per-grip terms here. A dispatch goes through push.number states from
// push.first on, fill by fill, as many as a uniform block holds: read from a storage buffer they cost twice the time. A fill that is cut goes on
// from what its planes hold.
//
// A state asks for two numbers alone. With the arm from the midpoint of the tips to the center of mass along n (pour), y (up) and p = y x n,
//   torque^2 = (m g sin t)^2 |arm|^2     (exact: (m g (sin t arm_y + cos t arm_n))^2)
//   hold     = m g / 2 (sqrt(1 - a^2 + (lever / gamma)^2) / mu + |a|),     a = d_y cos t = d . u
//   lever    = |arm . (u x d)| = |cos t (y x d)_n arm_n - sin t (d_p arm_y - d_y arm_p)|,     as d . n = 0
// which are the formulas of core/held.cpp with what a grip's states share taken out of them. A square grows with its root, so the largest torque is
// found without roots: the torque at which F comes to F_max caps it, as tilts beyond that are equal.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "force.glsl"
#include "grips.glsl"
#include "trig.glsl"

// lavapipe gathers a state lane by lane, because it does not see that all lanes read the same one. This takes longer than the forces of one grip, so
// an invocation has several grips, for which it reads a state once. A GPU should need one: it reads the state once for all lanes.
layout(constant_id = CONST_TOGETHER) const int TOGETHER = 1;
layout(constant_id = CONST_TORQUE) const int TORQUE = TORQUE_PAPER;
layout(constant_id = CONST_REFERENCE) const int REFERENCE = REFERENCE_PER_OBJECT;
layout(constant_id = CONST_UNTIL_POURED) const bool UNTIL_POURED = false;
layout(constant_id = CONST_OFF_AXIS) const bool OFF_AXIS = true;

Real plane_real(int plane, uint fill, uint grip, Real absent) {
  return plane >= 0 ? real_out[(uint(plane) + fill) * push.stride + grip] : absent;
}

// How a grip holds the vessel: along pour, up and beside, m; `center` of the empty vessel's mass. The factors of the lever and of the hold force
// already include gamma, mu and a half.
struct Held {
  Vec3 midpoint, center;
  Real across, level, rise;  // (y x d)_n, d_p, d_y
  Real half_rise, half_per_friction, per_torsion;
  Real reference;   // N m
  Real cap;         // N2 m2, the square of the torque at which F is F_max; 0 if F does not change with the torque
  Real safe_below;  // N2 m2, under which F < F_max
  Real strength;    // N, of the grip; kept here, because a load within the loop over states is a gather
  bool antipodal, feasible;
};

Real torque_reference(Vec3 center, Vec3 midpoint) {
  Real reference = scene.reference;
  if (REFERENCE == REFERENCE_PER_GRIP) {
    Vec3 heaviest = (Real(1) - scene.largest_share) * center + Vec3(Real(0), scene.largest_height, Real(0));
    reference = grip_reference(scene.largest_mass, scene.gravity, length(heaviest - midpoint));
  }
  return reference;
}

Held held_by(uint grip) {
  Held held;
  uint status = status_of(grip);
  held.feasible = is_feasible(status);
  held.antipodal = (status & STATUS_ANTIPODAL) != 0u;
  Vec3 direction = grip_direction(grip_axis(AXIS_AZIMUTH, grip), grip_axis(AXIS_OBLIQUITY, grip));
  Vec3 pour = held.feasible ? pour_direction(direction, scene.pour_sense) : Vec3(1, 0, 0);
  Vec3 beside = cross(Vec3(0, 1, 0), pour);
  Vec3 midpoint = kept_vector(PLANE_MIDPOINT, grip);
  Vec3 center = Vec3(scene.center_x, scene.center_y, scene.center_z);
  held.midpoint = Vec3(dot(midpoint, pour), midpoint.y, dot(midpoint, beside));
  held.center = Vec3(dot(center, pour), center.y, dot(center, beside));
  held.across = dot(cross(Vec3(0, 1, 0), direction), pour);
  held.level = dot(direction, beside);
  held.rise = direction.y;
  held.half_rise = Real(0.5) * abs(direction.y);
  held.half_per_friction = Real(0.5) / scene.friction;
  held.per_torsion = BARE ? Real(0) : Real(1) / scene.torsion;
  held.reference = torque_reference(held.center, held.midpoint);
  Real room = max(Real(0), scene.force_max - scene.force_base);
  bool grows = held.reference > Real(0) && scene.force_range > Real(0);
  Real torque = grows ? room * (held.reference / scene.force_range) : Real(0);
  held.cap = torque * torque;
  held.safe_below = grows || !(room > Real(0)) ? held.cap : NO_DISTANCE;
  held.strength = scene.grip_strength;
  return held;
}

// Terms of one fill, over its counted tilts so far.
struct FillTerms {
  Real peak_square, peak_tilt, largest_hold, safe_tilt;
  bool safe;
};

// A pinch that is not antipodal needs an infinite force, which only a hand of infinite strength has; in a scene with efforts, the efforts decide.
FillTerms no_terms(Held held) {
  bool may_hold = held.antipodal || !(scene.grip_strength < NO_DISTANCE);
  return FillTerms(Real(-1), Real(0), Real(0), NOT_A_NUMBER, may_hold);
}

// As the previous dispatch left them; its last tilt was `before`.
FillTerms kept_terms(Held held, uint fill, uint grip, Real before) {
  FillTerms terms = no_terms(held);
  Real force = plane_real(PLANE_PEAK_FORCE, fill, grip, Real(-1));
  Real torque = held.cap > Real(0) ? max(Real(0), force - scene.force_base) * (held.reference / scene.force_range) : Real(0);
  terms.peak_square = force < Real(0) ? Real(-1) : force < scene.force_max ? torque * torque : held.cap;
  terms.peak_tilt = plane_real(PLANE_PEAK_TILT, fill, grip, terms.peak_tilt);
  terms.largest_hold = held.antipodal ? plane_real(PLANE_LARGEST_HOLD, fill, grip, terms.largest_hold) : Real(0);
  terms.safe_tilt = plane_real(PLANE_SAFE_TILT, fill, grip, terms.safe_tilt);
  terms.safe = terms.safe_tilt == before;
  return terms;
}

struct StateForces {
  Real pivot_square, torque_square, hold;
};

Real exact_torque_of(Vec4 weight, Vec4 tilted, Real lean, Real rise) { return weight.x * (tilted.x * rise + tilted.y * lean); }

// `weight`: N, the vessel's own share of the mass, lean and height of the center of mass without what lies off the axis; `tilted`: sine, cosine, ..
StateForces state_forces(Held held, Vec4 weight, Vec4 tilted) {
  Real lean = weight.z - held.midpoint.x, rise = weight.w - held.midpoint.y, beside = -held.midpoint.z;
  if (OFF_AXIS) {
    lean += weight.y * held.center.x;
    beside += weight.y * held.center.z;
  }
  StateForces forces;
  forces.pivot_square = lean * lean + rise * rise + beside * beside;
  Real lift = weight.x * tilted.x;
  forces.torque_square = lift * lift * forces.pivot_square;
  if (TORQUE == TORQUE_EXACT) {
    Real exact = exact_torque_of(weight, tilted, lean, rise);
    forces.torque_square = exact * exact;
  }
  Real along = held.rise * tilted.y;
  Real lever = tilted.y * (held.across * lean) - tilted.x * (held.level * rise - held.rise * beside);
  Real twist = held.per_torsion * lever;
  Real level_share = Real(1) - along * along;
  Real sideways = sqrt((level_share > Real(0) ? level_share : Real(0)) + twist * twist);
  forces.hold = weight.x * (sideways * held.half_per_friction + held.half_rise * abs(tilted.y));
  bool is_unheld = BARE && weight.x > Real(0) && abs(lever) > longest_bare_lever(sqrt(forces.pivot_square));
  forces.hold = is_unheld ? INFINITE : forces.hold;
  return forces;
}

// Comparisons instead of min and max: Vulkan lets those return either number, and drivers add code to fix that.
void add_state(Held held, StateForces forces, Real angle, inout FillTerms terms) {
  Real square = forces.torque_square < held.cap ? forces.torque_square : held.cap;
  bool higher = square > terms.peak_square;
  terms.peak_tilt = higher ? angle : terms.peak_tilt;
  terms.peak_square = higher ? square : terms.peak_square;
  terms.largest_hold = forces.hold > terms.largest_hold ? forces.hold : terms.largest_hold;
  terms.safe = terms.safe && forces.torque_square < held.safe_below && !(forces.hold > held.strength);
  terms.safe_tilt = terms.safe ? angle : terms.safe_tilt;
}

Real feedback_of(Held held, Real square) {
  Real normal = normal_force(scene.force_base, scene.force_range, sqrt(square), held.reference);
  bool capped = held.cap > Real(0) && !(square < held.cap);
  return capped ? scene.force_max : feedback_force(normal, Real(0), scene.force_max);
}

void put_state(Held held, int state, uint grip, bool counts, StateForces forces, Vec4 weight, Vec4 tilted) {
  bool exists = held.feasible && counts;
  Real torque = weight.x * tilted.x * sqrt(forces.pivot_square);
  put_real(PLANE_PIVOT_LENGTH, state, grip, exists ? sqrt(forces.pivot_square) : NOT_A_NUMBER);
  put_real(PLANE_TORQUE, state, grip, exists ? torque : NOT_A_NUMBER);
  if (PLANE_EXACT_TORQUE >= 0) {
    Real lean = weight.z + weight.y * held.center.x - held.midpoint.x, rise = weight.w - held.midpoint.y;
    put_real(PLANE_EXACT_TORQUE, state, grip, exists ? exact_torque_of(weight, tilted, lean, rise) : NOT_A_NUMBER);
  }
  Real normal = normal_force(scene.force_base, scene.force_range, sqrt(forces.torque_square), held.reference);
  put_real(PLANE_NORMAL_FORCE, state, grip, exists ? normal : NOT_A_NUMBER);
  put_real(PLANE_FEEDBACK_FORCE, state, grip, exists ? feedback_of(held, forces.torque_square) : NOT_A_NUMBER);
  put_real(PLANE_HOLD_FORCE, state, grip, exists ? (held.antipodal ? forces.hold : INFINITE) : NOT_A_NUMBER);
}

void put_terms(Held held, uint fill, uint grip, FillTerms terms) {
  bool feasible = held.feasible;
  Real force = terms.peak_square < Real(0) ? Real(-1) : feedback_of(held, terms.peak_square);
  put_real(PLANE_PEAK_FORCE, int(fill), grip, feasible ? force : NOT_A_NUMBER);
  put_real(PLANE_PEAK_TILT, int(fill), grip, feasible ? terms.peak_tilt : NOT_A_NUMBER);
  put_real(PLANE_LARGEST_HOLD, int(fill), grip, feasible ? (held.antipodal ? terms.largest_hold : INFINITE) : NOT_A_NUMBER);
  put_real(PLANE_SAFE_TILT, int(fill), grip, feasible ? terms.safe_tilt : NOT_A_NUMBER);
}

void main() {
  // neighboring lanes have neighboring grips
  uint invocations = (push.count + uint(TOGETHER) - 1u) / uint(TOGETHER);
  if (INVOCATION >= invocations) return;
  uint grips[TOGETHER];
  bool exists[TOGETHER];  // the last invocations may have fewer
  Held held[TOGETHER];
  [[unroll]] for (int g = 0; g < TOGETHER; ++g) {
    uint grip = INVOCATION + uint(g) * invocations;
    exists[g] = grip < push.count;
    grips[g] = min(grip, push.count - 1u);
    held[g] = held_by(grips[g]);
  }
  uint fill = push.first / scene.tilts, tilt = push.first % scene.tilts;
  uint k = 0u;
  while (k < push.number) {
    FillTerms terms[TOGETHER];
    [[unroll]] for (int g = 0; g < TOGETHER; ++g) {
      terms[g] = no_terms(held[g]);
      if (tilt > 0u && exists[g]) terms[g] = kept_terms(held[g], fill, grips[g], states_in[1].w);
    }
    uint end = min(push.number, k + scene.tilts - tilt);
    [[dont_unroll]] for (; k < end; ++k) {
      Vec4 weight = states_in[2u * k], tilted = states_in[2u * k + 1u];
      bool counts = !UNTIL_POURED || tilted.z >= Real(0);
      [[unroll]] for (int g = 0; g < TOGETHER; ++g) {
        StateForces forces = state_forces(held[g], weight, tilted);
        COUNT_LANES(exists[g] && held[g].feasible && counts);
        if (counts) add_state(held[g], forces, tilted.z, terms[g]);
        if (exists[g]) put_state(held[g], int(push.first + k), grips[g], counts, forces, weight, tilted);
      }
    }
    [[unroll]] for (int g = 0; g < TOGETHER; ++g)
      if (exists[g]) put_terms(held[g], fill, grips[g], terms[g]);
    fill += 1u;
    tilt = 0u;
  }
}

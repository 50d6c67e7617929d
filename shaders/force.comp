// SPDX-License-Identifier: MIT
// Kernel 7 of one grip an invocation over fills and tilts, reduced to per-grip terms here. A dispatch goes through push.number states from
// push.first on, fill by fill, as many as a uniform block holds: read from a storage buffer, lane by lane, they cost twice the time.
// A fill that is cut goes on from what its planes hold.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "force.glsl"
#include "grips.glsl"
#include "planes.glsl"
#include "trig.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_TORQUE) const int TORQUE = TORQUE_PAPER;
layout(constant_id = CONST_REFERENCE) const int REFERENCE = REFERENCE_PER_OBJECT;
layout(constant_id = CONST_UNTIL_POURED) const bool UNTIL_POURED = false;
layout(std140, binding = BINDING_STATES) uniform StateBlock { Vec4 states_in[2 * STATES_IN_BLOCK]; };

Real plane_real(int plane, uint fill, uint grip, Real absent) {
  return plane >= 0 ? real_out[(uint(plane) + fill) * push.stride + grip] : absent;
}

// Of one fill, over those of its tilts so far that count.
struct FillTerms {
  Real peak_force, peak_tilt, largest_hold, safe_tilt;
  bool safe;
};

FillTerms no_terms() { return FillTerms(Real(-1), Real(0), Real(0), NOT_A_NUMBER, true); }

// As the dispatch before left them, whose last tilt was `before`.
FillTerms kept_terms(uint fill, uint grip, Real before) {
  FillTerms terms = no_terms();
  terms.peak_force = plane_real(PLANE_PEAK_FORCE, fill, grip, terms.peak_force);
  terms.peak_tilt = plane_real(PLANE_PEAK_TILT, fill, grip, terms.peak_tilt);
  terms.largest_hold = plane_real(PLANE_LARGEST_HOLD, fill, grip, terms.largest_hold);
  terms.safe_tilt = plane_real(PLANE_SAFE_TILT, fill, grip, terms.safe_tilt);
  terms.safe = terms.safe_tilt == before;
  return terms;
}

// How a grip holds the vessel; `center` of the empty vessel's mass.
struct Held {
  Vec3 direction, pour, midpoint, center;
  Real reference;
  bool antipodal;
};

Real torque_reference(Held held) {
  Real reference = scene.reference;
  if (REFERENCE == REFERENCE_PER_GRIP) {
    Load largest = Load(scene.largest_mass, (Real(1) - scene.largest_share) * held.center, Real(0), scene.largest_height);
    reference = grip_reference(scene.largest_mass, scene.gravity, length(load_center(largest, held.pour) - held.midpoint));
  }
  return reference;
}

struct StateForces {
  Real pivot_length, torque, exact_torque, normal, feedback, hold;
};

StateForces state_forces(Held held, Vec4 weight, Real sine_tilt, Real cosine_tilt) {
  StateForces forces;
  Real mass = weight.x;
  Load load = Load(mass, (Real(1) - weight.y) * held.center, weight.z, weight.w);
  Vec3 arm = load_center(load, held.pour) - held.midpoint;
  forces.pivot_length = length(arm);
  forces.torque = pendulum_torque(mass, scene.gravity, forces.pivot_length, sine_tilt);
  forces.exact_torque = Real(0);
  if (TORQUE == TORQUE_EXACT || PLANE_EXACT_TORQUE >= 0)
    forces.exact_torque = exact_pendulum_torque(mass, scene.gravity, arm, held.pour, sine_tilt, cosine_tilt);
  Real torque = TORQUE == TORQUE_EXACT ? abs(forces.exact_torque) : forces.torque;
  forces.normal = normal_force(scene.force_base, scene.force_range, torque, held.reference);
  forces.feedback = feedback_force(forces.normal, Real(0), scene.force_max);
  Vec3 up = up_direction(held.pour, sine_tilt, cosine_tilt);
  forces.hold = hold_force(mass, scene.gravity, arm, held.direction, up, scene.friction, scene.torsion);
  if (!held.antipodal) forces.hold = INFINITE;
  return forces;
}

void add_state(StateForces forces, Real angle, inout FillTerms terms) {
  bool higher = forces.feedback > terms.peak_force;
  terms.peak_tilt = higher ? angle : terms.peak_tilt;
  terms.peak_force = higher ? forces.feedback : terms.peak_force;
  terms.largest_hold = max(terms.largest_hold, forces.hold);
  terms.safe = terms.safe && forces.normal < scene.force_max && forces.hold <= scene.grip_strength;
  terms.safe_tilt = terms.safe ? angle : terms.safe_tilt;
}

void put_state(int state, uint grip, bool feasible, StateForces forces) {
  put_real(PLANE_PIVOT_LENGTH, state, grip, feasible ? forces.pivot_length : NOT_A_NUMBER);
  put_real(PLANE_TORQUE, state, grip, feasible ? forces.torque : NOT_A_NUMBER);
  put_real(PLANE_EXACT_TORQUE, state, grip, feasible ? forces.exact_torque : NOT_A_NUMBER);
  put_real(PLANE_NORMAL_FORCE, state, grip, feasible ? forces.normal : NOT_A_NUMBER);
  put_real(PLANE_FEEDBACK_FORCE, state, grip, feasible ? forces.feedback : NOT_A_NUMBER);
  put_real(PLANE_HOLD_FORCE, state, grip, feasible ? forces.hold : NOT_A_NUMBER);
}

void put_terms(uint fill, uint grip, bool feasible, FillTerms terms) {
  put_real(PLANE_PEAK_FORCE, int(fill), grip, feasible ? terms.peak_force : NOT_A_NUMBER);
  put_real(PLANE_PEAK_TILT, int(fill), grip, feasible ? terms.peak_tilt : NOT_A_NUMBER);
  put_real(PLANE_LARGEST_HOLD, int(fill), grip, feasible ? terms.largest_hold : NOT_A_NUMBER);
  put_real(PLANE_SAFE_TILT, int(fill), grip, feasible ? terms.safe_tilt : NOT_A_NUMBER);
}

void main() {
  uint grip = INVOCATION;
  if (grip >= push.count) return;
  uint status = uint_out[uint(PLANE_STATUS) * push.stride + grip];
  bool feasible = (status & STATUS_REASON_MASK) == REASON_NONE;
  Held held;
  held.antipodal = (status & STATUS_ANTIPODAL) != 0u;
  Real azimuth = grip_axis(AXIS_AZIMUTH, grip), obliquity = grip_axis(AXIS_OBLIQUITY, grip);
  Real sa, ca, sb, cb;
  sine_cosine(azimuth, sa, ca);
  sine_cosine(obliquity, sb, cb);
  held.direction = Vec3(cb * ca, sb, -cb * sa);
  held.pour = feasible ? pour_direction(held.direction, scene.pour_sense) : Vec3(1, 0, 0);
  uint at = uint(PLANE_MIDPOINT) * push.stride + grip;
  held.midpoint = Vec3(real_out[at], real_out[at + push.stride], real_out[at + 2u * push.stride]);
  held.center = Vec3(scene.center_x, scene.center_y, scene.center_z);
  held.reference = torque_reference(held);
  FillTerms terms = no_terms();
  uint fill = push.first / scene.tilts, tilt = push.first % scene.tilts;
  for (uint k = 0u; k < push.number; ++k) {
    Vec4 weight = states_in[2u * k], tilted = states_in[2u * k + 1u];
    if (k == 0u && tilt > 0u) {
      terms = kept_terms(fill, grip, tilted.w);
    } else if (tilt == 0u) {
      terms = no_terms();
    }
    StateForces forces = state_forces(held, weight, tilted.x, tilted.y);
    bool counts = !UNTIL_POURED || tilted.z >= Real(0);
    if (counts) add_state(forces, tilted.z, terms);
    put_state(int(push.first + k), grip, feasible && counts, forces);
    bool ends = tilt + 1u == scene.tilts;
    if (ends || k + 1u == push.number) put_terms(fill, grip, feasible, terms);
    fill += ends ? 1u : 0u;
    tilt = ends ? 0u : tilt + 1u;
  }
}

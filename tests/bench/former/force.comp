// SPDX-License-Identifier: MIT
// As of commit 289a04a, to compare with (tests/bench/former_bench.cpp). Only the names of what layout.h has follow the program,
// and a state has its weight and the height of its centre of mass already.
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
layout(std140, binding = BINDING_STATES) uniform StateBlock { Vec4 states_in[2 * STATES_IN_BLOCK]; };

Real plane_real(int plane, uint fill, uint grip, Real absent) {
  return plane >= 0 ? real_out[(uint(plane) + fill) * push.stride + grip] : absent;
}

void main() {
  uint grip = INVOCATION;
  if (grip >= push.count) return;
  uint status = uint_out[uint(PLANE_STATUS) * push.stride + grip];
  bool feasible = (status & STATUS_REASON_MASK) == REASON_NONE;
  bool antipodal = (status & STATUS_ANTIPODAL) != 0u;
  Real azimuth = grip_axis(AXIS_AZIMUTH, grip), obliquity = grip_axis(AXIS_OBLIQUITY, grip);
  Real sa, ca, sb, cb;
  sine_cosine(azimuth, sa, ca);
  sine_cosine(obliquity, sb, cb);
  Vec3 direction = Vec3(cb * ca, sb, -cb * sa);
  Vec3 pour = feasible ? pour_direction(direction, scene.pour_sense) : Vec3(1, 0, 0);
  uint at = uint(PLANE_MIDPOINT) * push.stride + grip;
  Vec3 midpoint = Vec3(real_out[at], real_out[at + push.stride], real_out[at + 2u * push.stride]);
  Vec3 center = Vec3(scene.center_x, scene.center_y, scene.center_z);
  Real reference = scene.reference;
  if (REFERENCE == REFERENCE_PER_GRIP) {
    Load largest = Load(scene.largest_mass, (Real(1) - scene.largest_share) * center, Real(0), scene.largest_height);
    reference = grip_reference(scene.largest_mass, scene.gravity, length(load_center(largest, pour) - midpoint));
  }
  Real peak_force = Real(-1), peak_tilt = Real(0), largest_hold = Real(0), safe_tilt = NOT_A_NUMBER;
  bool safe = true;
  uint fill = push.first / scene.tilts, tilt = push.first % scene.tilts;
  for (uint k = 0u; k < push.number; ++k) {
    Vec4 held = states_in[2u * k], tilted = states_in[2u * k + 1u];
    Real mass = held.x, sine_tilt = tilted.x, cosine_tilt = tilted.y, angle = tilted.z;
    if (k == 0u && tilt > 0u) {
      peak_force = plane_real(PLANE_PEAK_FORCE, fill, grip, peak_force);
      peak_tilt = plane_real(PLANE_PEAK_TILT, fill, grip, peak_tilt);
      largest_hold = plane_real(PLANE_LARGEST_HOLD, fill, grip, largest_hold);
      safe_tilt = plane_real(PLANE_SAFE_TILT, fill, grip, safe_tilt);
      safe = safe_tilt == tilted.w;
    } else if (tilt == 0u) {
      peak_force = Real(-1);
      peak_tilt = largest_hold = Real(0);
      safe_tilt = NOT_A_NUMBER;
      safe = true;
    }
    Load load = Load(mass, held.y * Vec3(center.x, Real(0), center.z), held.z, held.w);
    Vec3 arm = load_center(load, pour) - midpoint;
    Real pivot_length = length(arm);
    Real torque = pendulum_torque(mass, Real(1), pivot_length, sine_tilt);
    Real exact_torque = Real(0);
    if (TORQUE == TORQUE_EXACT || PLANE_EXACT_TORQUE >= 0)
      exact_torque = exact_pendulum_torque(mass, Real(1), arm, pour, sine_tilt, cosine_tilt);
    Real normal = normal_force(scene.force_base, scene.force_range, TORQUE == TORQUE_EXACT ? abs(exact_torque) : torque, reference);
    Real feedback = feedback_force(normal, Real(0), scene.force_max);
    Real hold = hold_force(mass, Real(1), arm, direction, up_direction(pour, sine_tilt, cosine_tilt), scene.friction, scene.torsion);
    if (!antipodal) hold = INFINITE;
    bool higher = feedback > peak_force;
    peak_tilt = higher ? angle : peak_tilt;
    peak_force = higher ? feedback : peak_force;
    largest_hold = max(largest_hold, hold);
    safe = safe && normal < scene.force_max && hold <= scene.grip_strength;
    safe_tilt = safe ? angle : safe_tilt;
    int plane = int(push.first + k);
    put_real(PLANE_PIVOT_LENGTH, plane, grip, feasible ? pivot_length : NOT_A_NUMBER);
    put_real(PLANE_TORQUE, plane, grip, feasible ? torque : NOT_A_NUMBER);
    put_real(PLANE_EXACT_TORQUE, plane, grip, feasible ? exact_torque : NOT_A_NUMBER);
    put_real(PLANE_NORMAL_FORCE, plane, grip, feasible ? normal : NOT_A_NUMBER);
    put_real(PLANE_FEEDBACK_FORCE, plane, grip, feasible ? feedback : NOT_A_NUMBER);
    put_real(PLANE_HOLD_FORCE, plane, grip, feasible ? hold : NOT_A_NUMBER);
    bool ends = tilt + 1u == scene.tilts;
    if (ends || k + 1u == push.number) {
      put_real(PLANE_PEAK_FORCE, int(fill), grip, feasible ? peak_force : NOT_A_NUMBER);
      put_real(PLANE_PEAK_TILT, int(fill), grip, feasible ? peak_tilt : NOT_A_NUMBER);
      put_real(PLANE_LARGEST_HOLD, int(fill), grip, feasible ? largest_hold : NOT_A_NUMBER);
      put_real(PLANE_SAFE_TILT, int(fill), grip, feasible ? safe_tilt : NOT_A_NUMBER);
    }
    fill += ends ? 1u : 0u;
    tilt = ends ? 0u : tilt + 1u;
  }
}

// Kernel 7 of one grip an invocation over fills and tilts, reduced to per-grip terms here: a fill's planes are written once. The fills
// of a dispatch are push.first .. + push.number, so that no invocation loops without bound.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "force.glsl"
#include "grips.glsl"
#include "planes.glsl"
#include "trig.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_TORQUE) const int TORQUE = TORQUE_PAPER;
layout(constant_id = CONST_REFERENCE) const int REFERENCE = REFERENCE_PER_OBJECT;
layout(std430, binding = BINDING_TILTS) readonly buffer TiltBlock { Real tilts_in[]; };
layout(std430, binding = BINDING_LOADS) readonly buffer LoadBlock { Real loads_in[]; };

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
  for (uint fill = push.first; fill < push.first + push.number; ++fill) {
    Real peak_force = Real(-1), peak_tilt = Real(0), largest_hold = Real(0), safe_tilt = NOT_A_NUMBER;
    bool safe = true;
    for (uint tilt = 0u; tilt < scene.tilts; ++tilt) {
      uint state = fill * scene.tilts + tilt;
      Real sine_tilt = tilts_in[3u * tilt], cosine_tilt = tilts_in[3u * tilt + 1u], angle = tilts_in[3u * tilt + 2u];
      uint from = LOAD_STRIDE * state;
      Real mass = loads_in[from];
      Load load = Load(mass, (Real(1) - loads_in[from + 1u]) * center, loads_in[from + 2u], loads_in[from + 3u]);
      Vec3 arm = load_center(load, pour) - midpoint;
      Real pivot_length = length(arm);
      Real torque = pendulum_torque(mass, scene.gravity, pivot_length, sine_tilt);
      Real exact_torque = Real(0);
      if (TORQUE == TORQUE_EXACT || PLANE_EXACT_TORQUE >= 0)
        exact_torque = exact_pendulum_torque(mass, scene.gravity, arm, pour, sine_tilt, cosine_tilt);
      Real normal = normal_force(scene.force_base, scene.force_range, TORQUE == TORQUE_EXACT ? abs(exact_torque) : torque, reference);
      Real feedback = feedback_force(normal, Real(0), scene.force_max);
      Real hold = hold_force(mass, scene.gravity, arm, direction, up_direction(pour, sine_tilt, cosine_tilt), scene.friction, scene.torsion);
      if (!antipodal) hold = INFINITE;
      bool higher = feedback > peak_force;
      peak_tilt = higher ? angle : peak_tilt;
      peak_force = higher ? feedback : peak_force;
      largest_hold = max(largest_hold, hold);
      safe = safe && normal < scene.force_max && hold <= scene.grip_strength;
      safe_tilt = safe ? angle : safe_tilt;
      int plane = int(state);
      put_real(PLANE_PIVOT_LENGTH, plane, grip, feasible ? pivot_length : NOT_A_NUMBER);
      put_real(PLANE_TORQUE, plane, grip, feasible ? torque : NOT_A_NUMBER);
      put_real(PLANE_EXACT_TORQUE, plane, grip, feasible ? exact_torque : NOT_A_NUMBER);
      put_real(PLANE_NORMAL_FORCE, plane, grip, feasible ? normal : NOT_A_NUMBER);
      put_real(PLANE_FEEDBACK_FORCE, plane, grip, feasible ? feedback : NOT_A_NUMBER);
      put_real(PLANE_HOLD_FORCE, plane, grip, feasible ? hold : NOT_A_NUMBER);
    }
    int plane = int(fill);
    put_real(PLANE_PEAK_FORCE, plane, grip, feasible ? peak_force : NOT_A_NUMBER);
    put_real(PLANE_PEAK_TILT, plane, grip, feasible ? peak_tilt : NOT_A_NUMBER);
    put_real(PLANE_LARGEST_HOLD, plane, grip, feasible ? largest_hold : NOT_A_NUMBER);
    put_real(PLANE_SAFE_TILT, plane, grip, feasible ? safe_tilt : NOT_A_NUMBER);
  }
}

// SPDX-License-Identifier: MIT
// Kernel 7 for a held vessel: its load at a fill and tilt, and the forces on the fingers. Sweeps and live sessions share this code.
#pragma once

#include "core/force.h"
#include "core/sdf.h"

namespace CORE_NS {

// The vessel with liquid of a mass (kg) whose center lies at `lean` along the pour direction and `height`, m.
Load load_with(const Vessel& vessel, Real liquid_mass, Real lean, Real height);
// tau_ref of a vessel: its largest load upright, times the farther of base and mouth (heights in m), N m.
Real object_reference(Load largest, Real gravity, Real base_height, Real mouth_height);

// Eq. (1): m g L sin(theta), N m.
Real pendulum_torque(Real mass, Real gravity, Real pivot_length, Real sine_tilt);
// Torque about the tilt direction, signed: > 0 topples further, N m.
Real exact_pendulum_torque(Real mass, Real gravity, Vec3 arm, Vec3 pour, Real sine_tilt, Real cosine_tilt);
// k_open (g_grasp - g), N; `squeeze` = g_grasp - g, m.
Real opening_force(Real k_open, Real squeeze);
// Grip force per finger that a soft-finger pinch needs, N.
Real hold_force(Real mass, Real gravity, Vec3 arm, Vec3 direction, Vec3 up, Real friction, Real torsion);
// Virtual coupling of a tip to its proxy before the grasp: K (proxy - tip) - B v_n along the surface's outward normal; it never pulls towards the
// surface. N, vessel frame; v: the tip's velocity, m/s.
Vec3 coupling_force(Vec3 tip, Vec3 proxy, Vec3 normal, Vec3 velocity, Real stiffness, Real damping);

// Forces in N, torques in N m, lengths in m; `center` of mass in the vessel frame.
struct HeldForces {
  Real pivot_length = 0, torque = 0, exact_torque = 0, normal = 0, opening = 0, feedback = 0, hold = 0;
  Vec3 center{};
};

// A vessel held by tips on a line along `direction` about `midpoint`, leaning towards `pour` by the tilt; `largest` as for object_reference;
// `squeeze` = g_grasp - g, m. The hold force of a pinch that is not antipodal is infinite.
HeldForces held_forces(const ForceScale& scale, Load load, Load largest, Vec3 direction, Vec3 midpoint, Vec3 pour, Real sine_tilt,
                       Real cosine_tilt, bool antipodal, Real squeeze);

}  // namespace CORE_NS

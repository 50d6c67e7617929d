// SPDX-License-Identifier: MIT
#include "core/load.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/hand_size.h"
#include "core/mesh_body.h"
#include "core/mirror.h"
#include "core/touch.h"
#include "core/trig.h"
#include "core/vectors.h"

namespace CORE_NS {

using wholehand::to_vec3;

Slices revolved_element(const Quadrature& quadrature, const Element& element) {
  Slices sum;
  const Real middle = Real(0.5) * (element.a.y + element.b.y);
  const Real half = Real(0.5) * (element.b.y - element.a.y);
  if (half == 0) return sum;
  for (int i = 0; i < quadrature.count; ++i) {
    const Real y = middle - half * quadrature.cosine[i];
    const Real r = element_radius(element, y);
    const Real area = Real(2) * HALF_PI * r * r * (half * quadrature.weight[i]);
    sum.volume += area;
    sum.height += area * y;
  }
  return sum;
}

namespace {

Vec2 to_vec2(const std::array<double, 2>& t) { return Vec2(Real(t[0]), Real(t[1])); }

// Mass and center of mass of the wall: what the hull encloses less the cavity, by revolution of their elements; of a mesh, what it
// encloses, less the cavity where that is enclosed too.
void weigh_wall(Vessel& vessel, const wholehand::PreparedVessel& prepared, const wholehand::VesselData& data,
                const Quadrature& quadrature, wholehand::Handedness handedness) {
  const wholehand::MeshBody* body = data.mesh ? data.mesh->body.get() : nullptr;
  Real volume = 0;
  Vec3 moment(0);
  if (body) {
    volume = Real(body->volume);
    moment = volume * to_vec3<Real>(wholehand::mirrored(body->center_of_mass, handedness));
  }
  for (const auto& element : prepared.hull) {
    const Slices part = revolved_element(quadrature, load_element(element));
    volume += part.volume;
    moment.y += part.height;
  }
  if (!body || body->holds_cavity) {
    for (const auto& piece : vessel.cavity) {
      const Slices part = revolved_element(quadrature, piece);
      volume -= part.volume;
      moment.y -= part.height;
    }
  }
  vessel.mass = Real(data.density) * volume;
  vessel.center_of_mass = moment / volume;
}

}  // namespace

Hand load_hand(const wholehand::PreparedHand& prepared, const wholehand::HandData& data) {
  Hand hand;
  for (int f = 0; f < FINGERS; ++f) {
    const auto& finger = prepared.fingers[f];
    hand.frame[f] = {to_vec3<Real>(finger.base), to_vec3<Real>(finger.forward), to_vec3<Real>(finger.palmward)};
    for (int k = 0; k < 4; ++k) hand.length[f][k] = Real(finger.length[k]);
    for (int k = 0; k < 5; ++k) hand.radius[f][k] = Real(finger.radius[k]);
  }
  hand.thumb_open = to_vec3<Real>(prepared.thumb_open);
  hand.thumb_swing = to_vec3<Real>(prepared.thumb_swing);
  hand.finger_open = to_vec3<Real>(prepared.finger_open);
  hand.finger_swing = to_vec3<Real>(prepared.finger_swing);
  hand.joint_limit = to_vec3<Real>(data.joint_limit);
  hand.max_angle = Real(data.max_angle);
  hand.paper_max_angle = Real(data.paper_max_angle);
  hand.contact_tolerance = Real(wholehand::judged_contact_tolerance(data));
  hand.depth_limit = Real(wholehand::judged_depth_limit(data));
  hand.between = data.between;
  hand.scale = Real(data.scale);
  hand.gap_open = Real(prepared.gap_open);
  hand.gap_closed = Real(prepared.gap_closed);
  for (const double closure : prepared.gap_table) hand.gap_table.push_back(Real(closure));
  return hand;
}

Quadrature load_quadrature(const wholehand::PreparedQuadrature& prepared) {
  Quadrature rule;
  rule.count = static_cast<int>(prepared.cosine.size());
  for (int i = 0; i < rule.count; ++i) {
    rule.cosine[i] = Real(prepared.cosine[i]);
    rule.weight[i] = Real(prepared.weight[i]);
  }
  return rule;
}

Element load_element(const wholehand::PreparedElement& element) {
  Element loaded;
  loaded.a = to_vec2(element.a);
  loaded.b = to_vec2(element.b);
  loaded.center = to_vec2(element.center);
  loaded.radius = Real(element.radius);
  loaded.side = element.side;
  loaded.supports = element.supports;
  return loaded;
}

Vessel load_vessel(const wholehand::PreparedVessel& prepared, const wholehand::VesselData& data, const Quadrature& quadrature,
                   bool with_liquid, wholehand::Handedness handedness) {
  Vessel vessel;
  for (const auto& element : prepared.outline) vessel.outline.push_back(load_element(element));
  for (const auto& element : prepared.cavity) vessel.cavity.push_back(load_element(element));
  vessel.lid = prepared.lid;
  vessel.bound_height = Real(prepared.bound_height);
  vessel.bound_radius = Real(prepared.bound_radius);
  vessel.floor_height = Real(prepared.floor_height);
  vessel.mouth_height = Real(prepared.mouth_height);
  vessel.mouth_radius = Real(prepared.mouth_radius);
  const bool has_center = data.mass && !std::isnan(data.center_of_mass[0]);
  if (has_center) {
    vessel.center_of_mass = to_vec3<Real>(wholehand::mirrored(data.center_of_mass, handedness));
  } else {
    weigh_wall(vessel, prepared, data, quadrature, handedness);
  }
  if (data.mass) vessel.mass = Real(*data.mass);
  if (with_liquid && !vessel.cavity.empty()) {
    vessel.capacity = lip_capacity(vessel, quadrature, Real(0), Real(1));
    for (int degree = 0; degree < WHOLE_DEGREES; ++degree) {
      const Real tilt = Real(wholehand::radians(degree));
      vessel.lip_capacity.push_back(lip_capacity(vessel, quadrature, sine(tilt), cosine(tilt)));
    }
  }
  return vessel;
}

Lattice load_lattice(const wholehand::PreparedLattice& prepared) {
  Lattice lattice;
  lattice.origin = to_vec3<Real>(prepared.origin);
  lattice.spacing = Real(prepared.spacing);
  lattice.nx = prepared.nx;
  lattice.ny = prepared.ny;
  lattice.nz = prepared.nz;
  lattice.halves = prepared.halves;
  lattice.words = prepared.words;
  return lattice;
}

void use_lattice(Vessel& vessel, Lattice lattice) {
  vessel.lattice = std::move(lattice);
  vessel.is_lattice = true;
  vessel.lid = -1;
}

Arm load_arm(const wholehand::Scene& scene, const wholehand::VesselData& data) {
  Arm arm;
  if (!scene.arm) return arm;
  const wholehand::ArmData& from = *scene.arm;
  arm.azimuths = wholehand::arm_azimuths(scene, data);
  arm.shoulder = to_vec3<Real>(wholehand::mirrored(wholehand::shoulder_place(scene, data), scene.hand.handedness));
  arm.upper_arm = Real(from.upper_arm);
  arm.forearm = Real(from.forearm);
  arm.wrist_radius = Real(from.wrist_radius);
  arm.elbow_radius = Real(from.elbow_radius);
  arm.flexion = Real(from.flexion);
  arm.extension = Real(from.extension);
  arm.ulnar = Real(from.ulnar);
  arm.radial = Real(from.radial);
  arm.pronation = Real(from.pronation);
  arm.supination = Real(from.supination);
  return arm;
}

ForceScale load_force(const wholehand::Scene& scene, const wholehand::VesselData& data) {
  ForceScale scale;
  scale.gravity = Real(scene.gravity);
  scale.base = Real(scene.force.base);
  scale.range = Real(data.force_range.value_or(scene.force.range));
  scale.max = Real(scene.force.max);
  scale.exact_torque = scene.force.torque == wholehand::Torque::exact;
  scale.per_grip = scene.force.reference == wholehand::TorqueReference::per_grip;
  scale.k_open = Real(scene.force.k_open);
  scale.friction = Real(scene.force.friction);
  scale.torsion = Real(scene.force.torsion);
  return scale;
}

HandStrength load_strength(const wholehand::Scene& scene, Real gap, Real scale) {
  HandStrength hand{Real(scene.force.friction), Real(scene.force.torsion), {}};
  if (!scene.strength) return hand;
  const Real share = scene.strength->by_opening ? strength_at(gap - scale * Real(wholehand::tip_radii(scene.hand))) : Real(1);
  for (std::size_t digit = 0; digit < DIGITS; ++digit) hand.digits[digit] = share * Real(scene.strength->digits[digit]);
  return hand;
}

HandStrength load_strength(const wholehand::Scene& scene, const wholehand::GripResult& held) {
  const Real bone = glm::length(to_vec3<Real>(held.posed[1]) - to_vec3<Real>(held.posed[0]));  // no pose moves it
  return load_strength(scene, Real(held.gap), bone / Real(scene.hand.fingers[0].segments[0]));
}

}  // namespace CORE_NS

#include "core/load.h"

#include <algorithm>
#include <cmath>

#include "core/trig.h"

namespace CORE_NS {
namespace {

Vec3 to_vec(const wholehand::Triple& t) { return Vec3(Real(t[0]), Real(t[1]), Real(t[2])); }
Vec2 to_vec(const std::array<double, 2>& t) { return Vec2(Real(t[0]), Real(t[1])); }

// Mass and centre of mass of the wall: what the hull encloses less the cavity, by revolution of their elements.
void weigh_wall(Vessel& vessel, const wholehand::PreparedVessel& prepared, const Quadrature& quadrature, Real density) {
  Real volume = 0;
  Real moment = 0;
  for (const auto& element : prepared.hull) {
    const Slices part = revolved_element(quadrature, load_element(element));
    volume += part.volume;
    moment += part.height;
  }
  for (const auto& piece : vessel.cavity) {
    const Slices part = revolved_element(quadrature, piece);
    volume -= part.volume;
    moment -= part.height;
  }
  vessel.mass = density * volume;
  vessel.center_of_mass = Vec3(0, moment / volume, 0);
}

}  // namespace

Hand load_hand(const wholehand::PreparedHand& prepared, const wholehand::HandData& data) {
  Hand hand;
  for (int f = 0; f < FINGERS; ++f) {
    const auto& finger = prepared.fingers[f];
    hand.frame[f] = {to_vec(finger.base), to_vec(finger.forward), to_vec(finger.palmward)};
    for (int k = 0; k < 4; ++k) hand.length[f][k] = Real(finger.length[k]);
    for (int k = 0; k < 5; ++k) hand.radius[f][k] = Real(finger.radius[k]);
  }
  hand.thumb_open = to_vec(prepared.thumb_open);
  hand.thumb_swing = to_vec(prepared.thumb_swing);
  hand.finger_open = to_vec(prepared.finger_open);
  hand.finger_swing = to_vec(prepared.finger_swing);
  hand.joint_limit = to_vec(data.joint_limit);
  hand.max_angle = Real(data.max_angle);
  hand.paper_max_angle = Real(data.paper_max_angle);
  hand.contact_tolerance = Real(data.contact_tolerance);
  hand.depth_limit = Real(data.depth_limit);
  hand.scale = Real(data.scale);
  hand.gap_open = Real(prepared.gap_open);
  hand.gap_closed = Real(prepared.gap_closed);
  for (int k = 0; k < GAP_TABLE_SIZE; ++k) hand.gap_table[k] = Real(prepared.gap_table[k]);
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
  loaded.a = to_vec(element.a);
  loaded.b = to_vec(element.b);
  loaded.center = to_vec(element.center);
  loaded.radius = Real(element.radius);
  loaded.side = element.side;
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
  if (data.mass) {
    vessel.mass = Real(*data.mass);
    vessel.center_of_mass = to_vec(wholehand::mirrored(data.center_of_mass, handedness));
  } else {
    weigh_wall(vessel, prepared, quadrature, Real(data.density));
  }
  if (with_liquid) {
    vessel.capacity = lip_capacity(vessel, quadrature, Real(0), Real(1));
    for (int degree = 0; degree < WHOLE_DEGREES; ++degree) {
      const Real tilt = Real(wholehand::radians(degree));
      vessel.lip_capacity.push_back(lip_capacity(vessel, quadrature, sine(tilt), cosine(tilt)));
    }
  }
  return vessel;
}

Grid sample_grid(const Vessel& vessel, int samples) {
  Real widest = 0, low = 0, high = 0;
  for (const Element& e : vessel.outline) {
    widest = std::max({widest, e.a.x, e.b.x, e.side > 0 ? e.center.x + e.radius : Real(0)});
    low = std::min({low, e.a.y, e.b.y});
    high = std::max({high, e.a.y, e.b.y});
  }
  Grid grid;
  const Real longest = std::max(Real(2) * widest, high - low);
  grid.spacing = longest / Real(samples - 5);
  const auto count = [&](Real length) { return static_cast<int>(std::ceil(length / grid.spacing)) + 5; };
  grid.nx = grid.nz = count(Real(2) * widest);
  grid.ny = count(high - low);
  grid.origin = Vec3(-widest, low, -widest) - Vec3(Real(2) * grid.spacing);
  grid.samples.reserve(static_cast<std::size_t>(grid.nx) * grid.ny * grid.nz);
  for (int k = 0; k < grid.nz; ++k)
    for (int j = 0; j < grid.ny; ++j)
      for (int i = 0; i < grid.nx; ++i)
        grid.samples.push_back(signed_distance(vessel, grid.origin + grid.spacing * Vec3(Real(i), Real(j), Real(k))));
  return grid;
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

}  // namespace CORE_NS

// SPDX-License-Identifier: MIT
#include "tests/support/contact_rig.h"

#include <fmt/format.h>

#include "core/vectors.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

constexpr double BALL = 7e-3, WALL = 0.06, THICK = 5e-3;  // m: radius; half of a wall's side, and of its thickness

}  // namespace

HeldSetup rig_setup(const std::vector<core_f64::ContactPoint>& contacts, const core_f64::HandStrength& hand,
                    const RigOptions& options) {
  HeldSetup setup;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 place = contacts[i].place + THICK * contacts[i].normal, along = contacts[i].normal;
    setup.form.geoms += fmt::format("<geom name=\"wall{}\" type=\"box\" pos=\"{} {} {}\" size=\"{} {} {}\" zaxis=\"{} {} {}\"/>\n",
                                    i, place.x, place.y, place.z, WALL, WALL, THICK, along.x, along.y, along.z);
    setup.form.names.push_back(fmt::format("wall{}", i));
    setup.pairs.push_back({i, i});
  }
  GraspContacts grasp;
  grasp.points = contacts;
  grasp.strength = hand;
  setup.grasp = sliding_contacts(std::vector<double>(contacts.size(), BALL), grasp);
  if (!options.has_springs)
    for (GraspJoint& joint : setup.grasp.joints) joint.stiffness = 0;
  setup.friction = hand.friction;
  setup.torsion = hand.torsion;
  const double inertia = options.mass * 0.08 * 0.08 / 6;
  setup.load = {options.mass, to_triple(options.center), {inertia, 0, 0, 0, inertia, 0, 0, 0, inertia}};
  setup.most_contacts = options.most_contacts;
  return setup;
}

void press_and_release(HeldBody& body, const std::vector<double>& normal_forces, const Vec3& force) {
  body.drive(normal_forces);
  body.push(force);
  for (int k = 0; k < 200; ++k) body.step();
  body.set_rest_pose();
  body.release();
}

}  // namespace wholehand

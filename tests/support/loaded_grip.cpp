// SPDX-License-Identifier: MIT
#include "tests/support/loaded_grip.h"

#include <cmath>

#include "core/counted_tilts.h"
#include "core/load.h"
#include "core/planes.h"
#include "core/vectors.h"
#include "tests/support/scenes.h"

namespace wholehand {

LoadedGrip held_grip(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripInput& grip,
                     const GripResult& result) {
  LoadedGrip held;
  for (const GripContact& found : evaluator.contacts(vessel, result)) {
    held.contacts.push_back({to_vec3<double>(found.point), to_vec3<double>(found.normal), found.digit, found.is_tip});
    if (found.is_tip) held.tips.push_back(held.contacts.back());
  }
  held.hand = core_f64::load_strength(scene, result);
  held.counted = counted_tilts(scene, vessel);
  held.gravity = scene.gravity;
  const core_f64::Vec3 line(std::cos(grip.azimuth) * std::cos(grip.obliquity), std::sin(grip.obliquity),
                            -std::sin(grip.azimuth) * std::cos(grip.obliquity));
  held.pour = core_f64::pour_direction(line, scene.hand.handedness == Handedness::left ? -1 : 1);
  for (const double tilt : scene.tilts) held.tilts.push_back({std::sin(tilt), std::cos(tilt)});
  for (const double fill : vessel_fills(scene, scene.vessels[vessel]))
    for (const double tilt : scene.tilts) {
      const StateResult state = evaluator.state(vessel, grip, result, evaluator.liquid(vessel, fill, tilt), tilt);
      held.states.push_back({state.mass, to_vec3<double>(state.center_of_mass), 0, 0});
    }
  return held;
}

std::vector<LoadedGrip> random_loaded_grips(std::size_t count, Handedness handedness, std::uint64_t seed) {
  Scene scene = three_beakers();
  scene.strength.emplace();
  scene.hand.handedness = handedness;
  const auto evaluator = make_core_evaluator(scene);
  Random random(seed);
  std::vector<LoadedGrip> grips;
  while (grips.size() < count) {
    const std::size_t vessel = grips.size() % scene.vessels.size();
    GripInput grip;
    grip.height = random.uniform(0.1, 0.95) * scene.vessels[vessel].height;
    grip.obliquity = radians(random.uniform(-20, 20));
    grip.roll = radians(random.uniform(-90, 30));
    GripResult result;
    evaluator->grip(vessel, grip, result);
    if (result.plausible) grips.push_back(held_grip(scene, *evaluator, vessel, grip, result));
  }
  return grips;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "tests/support/adversarial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/absent.h"
#include "core/reader/ranges.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

// Draws one of the numbers.
double one_of(Random& random, const std::vector<double>& numbers) {
  return numbers[static_cast<std::size_t>(random.uniform(0, static_cast<double>(numbers.size())))];
}

// Nothing, roundings of both precisions, stop tolerances, and the smallest numbers.
const std::vector<double> NUDGES{0,     0,    1e-17, -1e-17, 1e-12, -1e-12, 1e-9,   -1e-9,   1e-8,
                                 -1e-8, 1e-6, -1e-6, 2e-4,   -2e-4, 1e-3,   5e-324, -5e-324, 1.4e-45};

// Heights and radii at which an outline or its cavity has something.
struct Features {
  std::vector<double> heights{0}, radii{0};
};

Features features_of(const VesselData& vessel) {
  Features features;
  for (const OutlineElement& element : vessel.outline) {
    for (const double r : {element.end[0], element.center[0], element.end[0] - vessel.wall}) features.radii.push_back(r);
    for (const double y : {element.end[1], element.center[1], element.end[1] - vessel.wall, vessel.wall})
      features.heights.push_back(y);
  }
  features.heights.push_back(vessel.center_of_mass[1]);
  return features;
}

double clamped(double value, const Quantity& range) {
  return std::clamp(value, to_si(range.low, range.unit), to_si(range.high, range.unit));
}

double end_of(Random& random, const Quantity& range) {
  return to_si(random.uniform(0, 1) < 0.5 ? range.low : range.high, range.unit);
}

constexpr std::size_t CHUNK = 2048;  // grips evaluated at a time

}  // namespace

std::vector<GripInput> adversarial_grips(const Scene& scene, std::size_t vessel, std::size_t count, std::uint64_t seed) {
  const VesselData& data = scene.vessels[vessel];
  const Features features = features_of(data);
  const HandData& hand = scene.hand;
  const double widest = largest_radius(data);
  const std::vector<double> tips{0, hand.scale * hand.fingers[0].radii[3], hand.scale * hand.fingers[1].radii[4]};
  Random random(seed);
  const auto chance = [&random](double share) { return random.uniform(0, 1) < share; };
  const auto nudged = [&random](double value) { return value + one_of(random, NUDGES); };
  const std::vector<double> turns{0, radians(45), radians(90), radians(180), radians(270), radians(360), radians(30)};
  const auto angle = [&](double most) {
    const double sign = chance(0.5) ? 1 : -1;
    return chance(0.5) ? random.uniform(-most, most) : sign * nudged(std::min(most, one_of(random, turns)));
  };
  std::vector<GripInput> grips(count);
  for (GripInput& grip : grips) {
    // sizes first: where features lie to a fingertip depends on its thickness. Most hands span the vessel.
    const double spanning = widest / (0.04 * hand.scale);
    grip.hand_scale = chance(0.7)   ? spanning * random.uniform(0.35, 3)
                      : chance(0.5) ? std::exp(random.uniform(std::log(0.05), std::log(20.0)))
                                    : end_of(random, ranges::SCALE);
    grip.hand_scale = clamped(grip.hand_scale, ranges::SCALE);
    const double tip = grip.hand_scale * one_of(random, tips);
    grip.height = chance(0.5)    ? random.uniform(-0.1, 1.1) * data.height
                  : chance(0.96) ? nudged(one_of(random, features.heights) + one_of(random, {0, tip, -tip}))
                                 : end_of(random, ranges::GRIP_HEIGHT);
    grip.offset = chance(0.4)    ? nudged(0)
                  : chance(0.5)  ? random.uniform(-1.2, 1.2) * widest
                  : chance(0.96) ? (chance(0.5) ? 1 : -1) * nudged(one_of(random, features.radii) + one_of(random, {0, tip, -tip}))
                                 : end_of(random, ranges::OFFSET);
    grip.azimuth = angle(radians(360));
    grip.roll = angle(radians(360));
    grip.obliquity = chance(0.5) ? random.uniform(-radians(30), radians(30)) : chance(0.5) ? nudged(0) : angle(radians(90));
    grip.height = clamped(grip.height, ranges::GRIP_HEIGHT);
    grip.offset = clamped(grip.offset, ranges::OFFSET);
    grip.azimuth = clamped(grip.azimuth, ranges::ROTATION);
    grip.roll = clamped(grip.roll, ranges::ROTATION);
    grip.obliquity = clamped(grip.obliquity, ranges::OBLIQUITY);
  }
  return grips;
}

std::vector<Scene> adversarial_scenes() {
  std::vector<Scene> scenes;
  const auto add = [&scenes](std::vector<VesselData> vessels, Pose pose, const HandData& hand) -> Scene& {
    Scene scene = scene_of(std::move(vessels), pose, hand);
    scene.tilts = {0, 1e-9, radians(90), radians(180)};
    scenes.push_back(std::move(scene));
    return scenes.back();
  };
  const auto fill = [](Scene& scene) {
    scene.liquid = LiquidData{};
    scene.liquid->fills = {0, 1e-12, 1};
  };
  fill(add({beaker1(), beaker2(), beaker3()}, Pose::articulated, {}));
  fill(add({vase(), shell_of(vase())}, Pose::articulated, odd_hand()));
  add({ledges(), lopsided()}, Pose::articulated, left_hand()).force.torque = Torque::exact;
  add({shell_of(beaker1()), shell_of(beaker2())}, Pose::paper, {}).force.reference = TorqueReference::per_grip;
  add({beaker2(), beaker3()}, Pose::rigged, odd_hand()).force.friction = 0;
  add({beaker3()}, Pose::paper, left_hand()).force.torsion = 0;
  VesselData feather = scaled(beaker2(), 0.0125), tower = scaled(beaker1(), 90);
  feather.mass = 1e-6;
  feather.center_of_mass = {0, 0.5e-3, 0};
  tower.mass = 1e6;
  tower.center_of_mass = {10, -10, 10};
  HandData least = paper_hand(), most = paper_hand();
  least.scale = 0.05;
  most.scale = 20;
  add({feather}, Pose::articulated, least);
  add({tower, scaled(beaker2(), 70)}, Pose::articulated, most);
  Scene& weightless = add({beaker1()}, Pose::articulated, tiny_hand());
  weightless.gravity = 0;
  weightless.force = {};
  weightless.force.base = weightless.force.range = weightless.force.max = 0;
  return scenes;
}

std::size_t search_grips(std::size_t portion) {
  const char* asked = std::getenv("WHOLEHAND_SEARCH_GRIPS");
  return asked ? static_cast<std::size_t>(std::strtoull(asked, nullptr, 10)) : portion;
}

Searched search(std::size_t grips, const std::function<Answer(const Scene&)>& make) {
  Searched searched;
  const std::vector<Scene> scenes = adversarial_scenes();
  std::size_t vessels = 0;
  for (const Scene& scene : scenes) vessels += scene.vessels.size();
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const Answer answer = make(scenes[s]);
    for (std::size_t v = 0; v < scenes[s].vessels.size(); ++v) {
      const std::size_t share = grips / vessels + 1;
      for (std::size_t first = 0; first < share; first += CHUNK) {
        const auto asked = adversarial_grips(scenes[s], v, std::min(CHUNK, share - first), 1000 * s + 100 * v + 7919 * first);
        const GatheredPlanes planes = answer(v, asked);
        const Misplaced misplaced =
            misplaced_values(scenes[s], v, planes.fields, planes.count, planes.count, planes.reals.data(), planes.uints.data());
        if (misplaced.count > 0) {
          const GripInput& g = asked[misplaced.grip];
          ADD_FAILURE() << "scene " << s << ", vessel " << v << ": " << describe(misplaced) << "\nheight " << g.height
                        << " azimuth " << g.azimuth << " obliquity " << g.obliquity << " roll " << g.roll << " offset " << g.offset
                        << " hand " << g.hand_scale;
          return searched;
        }
        for (std::size_t i = 0; i < planes.count; ++i) {
          const std::uint32_t status = planes.uint(FIELD_STATUS, i);
          ++searched.grips;
          searched.feasible += (status & STATUS_REASON_MASK) == REASON_NONE ? 1 : 0;
          searched.not_converged += (status & STATUS_REASON_MASK) == REASON_NOT_CONVERGED ? 1 : 0;
          searched.unsettled += (status >> STATUS_UNSETTLED_SHIFT) != 0 || (status & STATUS_PROXY_UNSETTLED) != 0 ? 1 : 0;
        }
      }
    }
  }
  std::printf("  %zu grips, %zu feasible, %zu not converged, %zu with something unsettled\n", searched.grips, searched.feasible,
              searched.not_converged, searched.unsettled);
  return searched;
}

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/scene_states.h"

#include <bit>

#include "core/planes.h"
#include "core/score.h"
#include "core/trig.h"

namespace CORE_NS {

SceneStates::SceneStates(const wholehand::Scene& scene)
    : scene_(scene), pour_sense_(scene.liquid && scene.liquid->pour == wholehand::Pour::towards ? Real(-1) : Real(1)) {
  // a half turn's sine is 1e-16 in double: taken as it is, the kernels treat it as upright or inverted
  for (const double tilt : scene.tilts) tilts_.push_back({sine(Real(tilt)), cosine(Real(tilt))});
}

std::size_t SceneStates::fills() const { return tilts_.empty() ? 0 : wholehand::scene_fills(scene_); }

GripLoads SceneStates::loads(const VesselEntry& entry, const Pinch& pinch) const {
  return {entry.loads, tilts_, entry.counted_tilts, pour_direction(pinch.direction, pour_sense_), entry.force.gravity};
}

HeldForces SceneStates::forces(const VesselEntry& entry, const Pinch& pinch, const Load& load, TiltAngle tilt, Real opening) const {
  return held_forces(entry.force, load, entry.largest, pinch.direction, pinch.midpoint,
                     pour_direction(pinch.direction, pour_sense_), tilt.sine, tilt.cosine, pinch.is_antipodal, opening);
}

std::array<Real, 6> SceneStates::score_terms(const ScoredHand& hand, LargestForces largest, Real max) const {
  const bool has_forces = !tilts_.empty();
  return {fingers_term(std::popcount(hand.used_mask)),
          contacts_term(std::popcount(hand.touch_mask)),
          depth_term(hand.phalanx_depth, hand.palm_depth),
          hand.wrist_share ? wrist_term(posture_term(hand.closure), *hand.wrist_share) : posture_term(hand.closure),
          has_forces ? force_term(largest.feedback, max) : Real(0),
          largest.effort ? effort_term(*largest.effort)
          : has_forces   ? hold_term(largest.hold, Real(scene_.force.grip_strength))
                         : Real(0)};
}

// A scene without tilts has no force and hold terms; the other weights are scaled to sum to 1.
Real SceneStates::weighted(const std::array<Real, 6>& terms) const {
  const auto weights = wholehand::effective_weights(scene_);
  Real sum = 0;
  for (int k = 0; k < 6; ++k) sum += Real(weights[k]) * terms[k];
  return sum;
}

}  // namespace CORE_NS

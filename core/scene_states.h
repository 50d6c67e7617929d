// SPDX-License-Identifier: MIT
// A scene's vessels over its fills and tilts: the forces that hold them in every state, and the resulting score of a grip.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/grip_effort.h"
#include "core/held.h"
#include "core/planes.h"
#include "core/prepare.h"
#include "core/result.h"
#include "core/scene.h"

namespace CORE_NS {

// A vessel with all its grip-independent data.
struct VesselEntry {
  Vessel vessel;
  ForceScale force;
  Load largest;                            // upright at the largest fill, for the torque's reference
  Real largest_share = 0;                  // of the liquid in its mass
  std::vector<Load> loads;                 // fill-major over the tilts
  std::vector<std::size_t> counted_tilts;  // at each fill, from the first tilt on; the others are left out
  std::optional<wholehand::PreparedLattice> lattice;
};

// The line on which the tips hold a vessel, vessel frame, m.
struct Pinch {
  Vec3 direction{}, midpoint{};
  bool is_antipodal = false;
};

using TiltAngle = StateTilt;

// Over all states of a grip, N.
struct LargestForces {
  Real feedback = 0, hold = 0;
  std::optional<Real> effort;  // the worst, in a scene with efforts
  void add(const wholehand::FillTerms& terms) {
    feedback = std::max(feedback, Real(terms.peak_force));
    hold = std::max(hold, Real(terms.largest_hold));
  }
};

// The scored values of a grip other than forces: masks of fingers and points, depths in m.
struct ScoredHand {
  std::uint32_t used_mask = 0, touch_mask = 0;
  Real phalanx_depth = 0, palm_depth = 0, closure = 0;
  std::optional<Real> wrist_share;  // in a scene with an arm
};

class SceneStates {
 public:
  explicit SceneStates(const wholehand::Scene& scene);  // which outlives it

  std::size_t fills() const;  // none without tilts
  std::size_t tilts() const { return tilts_.size(); }

  // The states of a vessel in a grip. `entry` and this must outlive the answer.
  GripLoads loads(const VesselEntry& entry, const Pinch& pinch) const;

  // With another load than the states', at an opening g_grasp - g of the device, m.
  HeldForces forces(const VesselEntry& entry, const Pinch& pinch, const Load& load, TiltAngle tilt, Real opening) const;
  // Over the tilts that count at one fill. Calls `keep(tilt, forces)` for each of these states. `effort` is that fill's in a scene with efforts; null
  // there for an implausible grip.
  template <class Keep>
  wholehand::FillTerms fill_terms(const VesselEntry& entry, std::size_t fill, const Pinch& pinch, const FillEffort* effort,
                                  const Keep& keep) const;

  // In the order of FIELD_TERMS; `max` is the vessel's largest force, N.
  std::array<Real, 6> score_terms(const ScoredHand& hand, LargestForces largest, Real max) const;
  Real weighted(const std::array<Real, 6>& terms) const;

 private:
  const wholehand::Scene& scene_;
  Real pour_sense_;
  std::vector<TiltAngle> tilts_;
};

template <class Keep>
wholehand::FillTerms SceneStates::fill_terms(const VesselEntry& entry, std::size_t fill, const Pinch& pinch,
                                             const FillEffort* effort, const Keep& keep) const {
  Real peak_force = -1, peak_tilt = 0, largest_hold = 0;
  double safe_tilt = std::numeric_limits<double>::quiet_NaN();
  const bool by_effort = wholehand::has_effort(scene_);
  bool safe = !by_effort || effort;
  for (std::size_t t = 0; t < entry.counted_tilts[fill]; ++t) {
    const HeldForces state = forces(entry, pinch, entry.loads[fill * tilts_.size() + t], tilts_[t], 0);
    if (state.feedback > peak_force) {
      peak_force = state.feedback;
      peak_tilt = Real(scene_.tilts[t]);
    }
    largest_hold = std::max(largest_hold, state.hold);
    safe =
        safe && state.normal < entry.force.max && (by_effort ? t < effort->held : state.hold <= Real(scene_.force.grip_strength));
    if (safe) safe_tilt = scene_.tilts[t];
    keep(t, state);
  }
  if (by_effort) largest_hold = effort ? effort->tips_hold : std::numeric_limits<Real>::quiet_NaN();
  return {static_cast<double>(peak_force), static_cast<double>(peak_tilt), static_cast<double>(largest_hold), safe_tilt};
}

}  // namespace CORE_NS

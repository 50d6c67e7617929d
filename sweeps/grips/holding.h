// SPDX-License-Identifier: MIT
// What holding a vessel demands of the whole hand: kernels 9 and 10 over the states of one grip.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/effort.h"
#include "core/force.h"
#include "sweeps/grips/methods.h"

namespace wholehand::sweeps {

// One contact of the hand, with its force. Vessel frame; force on the vessel.
struct HeldContact {
  int joint = 0, digit = 0;  // the digit is a finger, or FINGER_COUNT for the palm
  Triple point{}, normal{};  // m; unit, into the vessel
  Triple force{};            // N
  double torsion = 0;        // moment about `normal`, N m
  int between = 0;           // number of a sphere of the bone that ends at the joint; 0: the joint
};

constexpr double SHARE_ROOM = 1.2;    // the efforts over which shares range, in least efforts
constexpr double SHARE_STEP = 0.005;  // of a range's ends

// The shares of index, middle, ring and little finger in the sum of these fingers' normal forces: in the forces of the least effort, and the range
// over all forces that balance the load with up to SHARE_ROOM of it. NaN where none of these fingers presses at the least effort.
struct FingerShares {
  std::array<double, FINGER_COUNT - 1> share{}, least{}, most{};
};

// One state. The least effort lies in [low, effort]; both are infinite if no force of the hand holds the vessel. `forces` of its contacts attain
// `effort`. All numbers are NaN if `until_poured` leaves the state out. If the effort is infinite the forces are zero, and `escape` is the vessel's
// escaping motion: velocity of the center of mass (m/s) and angular velocity (rad/s), scaled together.
struct StateHold {
  double effort = 0, low = 0;
  double tips = 0;                  // the effort of thumb and index tip alone
  core_f64::HandStrength strength;  // at the opening of the grip
  std::optional<std::array<double, 6>> escape;
  std::vector<HeldContact> contacts;
  std::optional<FingerShares> shares;  // nothing until add_quality, or without an effort
};

class Holding {
 public:
  // For a feasible grip in a scene with strengths; `pour` is the report's. `scene` and `evaluator`, made for it, must outlive this.
  Holding(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripResult& result, const Triple& pour);

  // At the opening of the grip.
  const core_f64::HandStrength& strength() const { return hand_; }
  StateHold state(const GripState& state) const;
  // Nothing for a state without an effort. `hold` is that of `state`.
  std::optional<FingerShares> shares(const GripState& state, const StateHold& hold) const;
  // Nothing if the scene has no tilts.
  std::optional<GripHold> over_states() const;

 private:
  core_f64::Wrench load(const StateResult& state, double tilt) const;
  core_f64::Load load_at(double fill, double tilt) const;

  const Scene& scene_;
  const Evaluator& evaluator_;
  std::size_t vessel_;
  Triple pour_;
  std::vector<int> joints_, between_;  // of the contacts
  std::vector<core_f64::ContactPoint> contacts_, tips_;
  core_f64::HandStrength hand_;
  core_f64::Vec3 center_{};  // of the contacts
};

}  // namespace wholehand::sweeps

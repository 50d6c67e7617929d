// SPDX-License-Identifier: MIT
// Hands that close on vessels, and the lines of their grips.
#pragma once

#include <cmath>

#include "core/closure.h"
#include "tests/support/scenes.h"

namespace wholehand {

// 1e-8 m: a tip stops within 1e-9 m of its distance, which is 1 / cos(contact angle) along the line: under 10 where not grazing.
constexpr double CLOSING_STOPPED = 1e-8;
constexpr double INDEX_RADIUS = 7e-3, THUMB_RADIUS = 8e-3;  // of the paper's hand

struct ClosingHand {
  ClosingHand(const VesselData& vessel_data, const HandData& hand_data = paper_hand())
      : hand(ready_hand(hand_data)), vessel(ready_vessel(vessel_data)) {}
  core_f64::Closing close(const GripInput& grip) const { return core_f64::close_fingers(hand, vessel, ready_grip(grip)); }
  core_f64::Hand hand;
  core_f64::Vessel vessel;
};

inline GripInput grip_of(double height_mm, double obliquity_deg = 0, double offset_mm = 0, double roll_deg = 0,
                         double azimuth_deg = 0) {
  GripInput grip;
  grip.height = height_mm * 1e-3;
  grip.obliquity = radians(obliquity_deg);
  grip.offset = offset_mm * 1e-3;
  grip.roll = radians(roll_deg);
  grip.azimuth = radians(azimuth_deg);
  return grip;
}

// t at which a ray against a cylinder of radius R + r, the line passing its axis at s and climbing by b, meets it.
inline double cylinder_hit(double R, double r, double s, double b) { return std::sqrt((R + r) * (R + r) - s * s) / std::cos(b); }

inline Long3 direction_of(const GripInput& grip) {
  return rotation_y(grip.azimuth) * (rotation_z(grip.obliquity) * Long3{1, 0, 0});
}

inline Long3 foot_of(const GripInput& grip) {
  const Long3 side = cross(direction_of(grip), {0, 1, 0});
  return Long3{0, grip.height, 0} + (grip.offset / length(side)) * side;
}

}  // namespace wholehand

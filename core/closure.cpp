// SPDX-License-Identifier: MIT
#include "core/closure.h"

#include <algorithm>
#include <cmath>

namespace CORE_NS {

// Sphere tracing from a sphere that encloses the vessel: sdf - radius is a lower bound of the remaining way, so no first touch is missed. So is the
// way to the nearest element's tangent plane, unless another element is met before it. A line that misses leaves the bounds on the far side.
Trace trace_tip(const Vessel& vessel, Vec3 origin, Vec3 direction, Real heading, Real radius) {
  const Vec3 center(0, vessel.bound_height, 0);
  const Real middle = glm::dot(center - origin, direction);
  const Real reach = vessel.bound_radius + radius + vessel.limits.stop_tolerance;
  Real traveled = 0;
  Trace trace;
  for (int step = 0; step < vessel.limits.trace_steps; ++step) {
    trace.t = middle + heading * (reach - traveled);
    trace.steps = step + 1;
    const Vec3 place = origin + trace.t * direction;
    const Support support = support_at(vessel, place);
    const Real clear = support.distance - radius;
    if (std::abs(clear) < vessel.limits.stop_tolerance) {
      trace.reason = REASON_NONE;
      trace.normal = vessel.is_lattice ? lattice_gradient(vessel.lattice, place) : support.normal;
      trace.element = support.element;
      return trace;
    }
    traveled += safe_step(support, clear, -heading * direction, Real(1), Real(0));
    if (traveled > Real(2) * reach) {
      trace.reason = REASON_MISSES;
      return trace;
    }
  }
  trace.reason = REASON_NOT_CONVERGED;
  return trace;
}

// Frames e (hand) and f (vessel) share their meaning: 1 along the tips, 2 to the little finger's side, 3 = 1 x 2.
Placement place_hand(const Hand& hand, Real closure, Vec3 direction, Real roll, Vec3 midpoint, Real scale, Real& e1_x) {
  // the hand's own frame: its lateral axis x, made perpendicular to the line of the tips, is e2
  Vec3 slope{};
  const Vec3 apart = tip_to_tip(hand, closure, slope);
  const Vec3 e1 = apart / glm::length(apart);
  e1_x = e1.x;
  const Vec3 e2_raw = Vec3(1, 0, 0) - e1.x * e1;
  const Vec3 e2 = e2_raw / glm::length(e2_raw);
  const Vec3 e3 = glm::cross(e1, e2);
  // the frame it goes to: at roll 0 the little finger is below the line, and a roll turns it about the line
  const Vec3 down_raw = Vec3(0, -1, 0) + direction.y * direction;
  const Vec3 down = down_raw / glm::length(down_raw);
  const Vec3 side = glm::cross(direction, down);
  Real sq = 0, cq = 0;
  sine_cosine(roll, sq, cq);
  const Vec3 f2 = cq * down + sq * side;
  const Vec3 f3 = glm::cross(direction, f2);
  Placement placement;
  placement.scale = scale;
  // columns of the rotation: f1 e1^T + f2 e2^T + f3 e3^T
  placement.rotation = Mat3(direction * e1.x + f2 * e2.x + f3 * e3.x, direction * e1.y + f2 * e2.y + f3 * e3.y,
                            direction * e1.z + f2 * e2.z + f3 * e3.z);
  // the middle of the tips goes to the middle of the contacts
  const Vec3 thumb_lengths(hand.length[0][0], hand.length[0][1], hand.length[0][2]);
  const Vec3 thumb_tip = thumb_points(hand.frame[0], thumb_lengths, thumb_angles(hand, closure)).tip;
  const Vec3 middle = thumb_tip + Real(0.5) * apart;
  placement.translation = midpoint - placement.rotation * (scale * middle);
  return placement;
}

FingerFrame placed_frame(const Placement& placement, FingerFrame frame) {
  FingerFrame placed;
  placed.base = placement.rotation * (placement.scale * frame.base) + placement.translation;
  placed.forward = placement.rotation * frame.forward;
  placed.palmward = placement.rotation * frame.palmward;
  return placed;
}

Closing close_fingers(const Hand& hand, const Vessel& vessel, Grip grip) {
  Closing closing;
  const Vec3 d = grip_direction(grip.azimuth, grip.obliquity);
  closing.direction = d;
  // d x (0, 1, 0) = (-d.z, 0, d.x): its length is the sine of the angle to the axis
  const Real off_axis = std::sqrt(d.x * d.x + d.z * d.z);
  if (off_axis < DEGENERATE_SINE) {
    closing.reason = REASON_DEGENERATE;
    return closing;
  }
  // the line is nearest to the axis at the grip's height, and passes it there at the offset
  const Vec3 aside = Vec3(-d.z, 0, d.x) / off_axis;
  const Vec3 origin = Vec3(0, grip.height, 0) + grip.offset * aside;
  const Real scale = hand.scale * grip.hand_scale;
  const Real thumb_radius = scale * hand.radius[0][3];
  const Real index_radius = scale * hand.radius[1][4];
  // both tips come from outside, along the line, to their first touch
  const Trace index = trace_tip(vessel, origin, d, Real(1), index_radius);
  const Trace thumb = trace_tip(vessel, origin, d, Real(-1), thumb_radius);
  closing.steps = std::max(index.steps, thumb.steps);
  closing.reason = REASON_NOT_CONVERGED;
  if (index.reason == REASON_NOT_CONVERGED || thumb.reason == REASON_NOT_CONVERGED) return closing;
  closing.reason = REASON_MISSES;
  if (index.reason == REASON_MISSES || thumb.reason == REASON_MISSES) return closing;
  // the gap between them gives the closure, if the hand can make it
  closing.t_index = index.t;
  closing.t_thumb = thumb.t;
  closing.gap = index.t - thumb.t;
  closing.midpoint = origin + (Real(0.5) * (index.t + thumb.t)) * d;
  closing.reason = REASON_TOO_WIDE;
  if (closing.gap > scale * hand.gap_open) return closing;
  closing.reason = REASON_TOO_NARROW;
  if (closing.gap < scale * hand.gap_closed || closing.gap < thumb_radius + index_radius) return closing;
  closing.closure = closure_of_gap(hand, closing.gap / scale, hand.limits.stop_tolerance / scale);
  // also too narrow: the hand's lateral axis is so close to the line of the tips that it gives no sideways direction
  Real e1_x = 0;
  closing.placement = place_hand(hand, closing.closure, d, grip.roll, closing.midpoint, scale, e1_x);
  if (std::abs(e1_x) > Real(LARGEST_E1_X)) return closing;
  // a tip on the lid would rest on the open mouth
  closing.reason = REASON_ON_MOUTH;
  if (vessel.lid >= 0 && (index.element == vessel.lid || thumb.element == vessel.lid)) return closing;
  closing.reason = REASON_NONE;
  // the tips' contact angles: compared with the friction cone, and a measure of how sharp a hit is
  closing.index_angle = angle_between(index.normal, d);
  closing.thumb_angle = angle_between(thumb.normal, -d);
  closing.grazing =
      std::abs(glm::dot(index.normal, d)) < Real(GRAZING_COSINE) || std::abs(glm::dot(thumb.normal, d)) < Real(GRAZING_COSINE);
  return closing;
}

}  // namespace CORE_NS

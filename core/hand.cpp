// SPDX-License-Identifier: MIT
#include "core/hand.h"

#include <algorithm>
#include <cmath>

#include "core/trig.h"

namespace CORE_NS {

// The predefined trajectory: each angle is open + c (closed - open) at the closure c.
Vec3 thumb_angles(const Hand& hand, Real closure) { return hand.thumb_open + closure * hand.thumb_swing; }

Vec3 finger_angles(const Hand& hand, Real closure) { return hand.finger_open + closure * hand.finger_swing; }

// All joints of a finger turn about one axis, so its chain stays in a plane: p(k+1) = p(k) + L(k) (cos a forward + sin a palmward),
// where a is the sum of the angles up to that joint.
Vec3 segment_end(FingerFrame frame, Vec3 start, Real length, Real angle) {
  Real s = 0;
  Real c = 0;
  sine_cosine(angle, s, c);
  return start + length * (c * frame.forward + s * frame.palmward);
}

// Rx(-MCP) then Rx(-PIP) then Rx(-DIP) about the same axis add up: one cumulative angle a segment.
FingerPoints finger_points(FingerFrame frame, Vec3 mcp, Vec3 lengths, Vec3 angles) {
  FingerPoints points;
  points.pip = segment_end(frame, mcp, lengths.x, angles.x);
  points.dip = segment_end(frame, points.pip, lengths.y, angles.x + angles.y);
  points.tip = segment_end(frame, points.dip, lengths.z, angles.x + angles.y + angles.z);
  return points;
}

// The thumb's abduction turns by Rx(-a) and its MCP and IP by Rx(+a): they take back from the cumulative angle.
FingerPoints thumb_points(FingerFrame frame, Vec3 lengths, Vec3 angles) {
  FingerPoints points;
  points.pip = segment_end(frame, frame.base, lengths.x, angles.x);
  points.dip = segment_end(frame, points.pip, lengths.y, angles.x - angles.y);
  points.tip = segment_end(frame, points.dip, lengths.z, angles.x - angles.y - angles.z);
  return points;
}

// T(c) = index tip - thumb tip. A segment turns at the rate r, the sum of the swings up to its joint, and so moves everything beyond it by r times
// the segment turned a quarter. T' is the sum of these over the index finger minus that over the thumb.
Vec3 tip_to_tip(const Hand& hand, Real closure, Vec3& slope) {
  const FingerFrame index = hand.frame[1];
  const FingerFrame thumb = hand.frame[0];
  const Vec3 index_mcp = index.base + hand.length[1][0] * index.forward;
  const Vec3 index_angles = finger_angles(hand, closure);
  const Vec3 thumb_angle = thumb_angles(hand, closure);
  const Vec3 index_lengths(hand.length[1][1], hand.length[1][2], hand.length[1][3]);
  const Vec3 thumb_lengths(hand.length[0][0], hand.length[0][1], hand.length[0][2]);
  const FingerPoints finger = finger_points(index, index_mcp, index_lengths, index_angles);
  const FingerPoints opposing = thumb_points(thumb, thumb_lengths, thumb_angle);
  // a segment moves across itself: d/da (cos a f + sin a p) = cos a p - sin a f, which is the segment turned a quarter
  const Vec3 s1 = finger.pip - index_mcp, s2 = finger.dip - finger.pip, s3 = finger.tip - finger.dip;
  const Vec3 t1 = opposing.pip - thumb.base, t2 = opposing.dip - opposing.pip, t3 = opposing.tip - opposing.dip;
  const Vec3 w = hand.finger_swing;
  const Vec3 v = hand.thumb_swing;
  const Vec3 bend = w.x * s1 + (w.x + w.y) * s2 + (w.x + w.y + w.z) * s3;
  const Vec3 fold = v.x * t1 + (v.x - v.y) * t2 + (v.x - v.y - v.z) * t3;
  slope = glm::dot(bend, index.forward) * index.palmward - glm::dot(bend, index.palmward) * index.forward -
          (glm::dot(fold, thumb.forward) * thumb.palmward - glm::dot(fold, thumb.palmward) * thumb.forward);
  return finger.tip - opposing.tip;
}

// Newton on g(c) = gap with g' = T . T' / g. Because g falls all the way, the table's cell brackets the answer; a step that leaves the bracket is
// replaced by its middle.
Real closure_of_gap(const Hand& hand, Real gap, Real tolerance) {
  const int entries = static_cast<int>(hand.gap_table.size());
  const Real span = hand.gap_open - hand.gap_closed;
  const Real place = std::clamp((hand.gap_open - gap) / span, Real(0), Real(1)) * Real(entries - 1);
  const int cell = std::min(static_cast<int>(place), entries - 2);
  Real low = hand.gap_table[cell];
  Real high = hand.gap_table[cell + 1];
  Real closure = low + (high - low) * (place - Real(cell));
  for (int step = 0; step < hand.limits.gap_steps; ++step) {
    Vec3 slope{};
    const Vec3 apart = tip_to_tip(hand, closure, slope);
    const Real distance = glm::length(apart);
    const Real error = distance - gap;
    if (std::abs(error) < tolerance) break;
    if (error > 0) low = closure;  // too open: the answer lies at a larger closure
    if (error < 0) high = closure;
    const Real rate = glm::dot(apart, slope) / distance;
    Real next = closure - error / rate;
    if (!(next > low && next < high)) next = Real(0.5) * (low + high);
    closure = next;
  }
  return closure;
}

}  // namespace CORE_NS

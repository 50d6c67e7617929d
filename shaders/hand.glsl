// SPDX-License-Identifier: MIT
// Twin of core/hand.cpp.
#ifndef HAND_GLSL
#define HAND_GLSL

#include "hand_table.glsl"
#include "trig.glsl"

struct Placement {
  Mat3 rotation;
  Vec3 translation;
  Real scale;
};

struct FingerPoints {
  Vec3 pip, dip, tip;
};

Vec3 thumb_angles(Real closure) { return hand_vectors[HAND_THUMB_OPEN].xyz + closure * hand_vectors[HAND_THUMB_SWING].xyz; }
Vec3 finger_angles(Real closure) { return hand_vectors[HAND_FINGER_OPEN].xyz + closure * hand_vectors[HAND_FINGER_SWING].xyz; }

Vec3 segment_end(FingerFrame frame, Vec3 start, Real length, Real angle) {
  Real s, c;
  sine_cosine(angle, s, c);
  precise Vec3 end = start + length * (c * frame.forward + s * frame.palmward);
  return end;
}

FingerPoints finger_points(FingerFrame frame, Vec3 mcp, Vec3 lengths, Vec3 angles) {
  FingerPoints points;
  Vec3 end = mcp;
  Real angle = Real(0);
  UNROLL_PRECISE for (int k = 0; k < 3; ++k) {
    angle += angles[k];
    end = segment_end(frame, end, lengths[k], angle);
    if (k == 0) points.pip = end;
    if (k == 1) points.dip = end;
  }
  points.tip = end;
  return points;
}

FingerPoints thumb_points(FingerFrame frame, Vec3 lengths, Vec3 angles) {
  return finger_points(frame, frame.base, lengths, Vec3(angles.x, -angles.y, -angles.z));
}

Vec3 tip_to_tip(Real closure, out Vec3 slope) {
  FingerFrame index = hand_frame(1);
  FingerFrame thumb = hand_frame(0);
  Vec3 index_mcp = index.base + hand_length(1, 0) * index.forward;
  FingerPoints finger = finger_points(index, index_mcp, hand_lengths(1, 1), finger_angles(closure));
  FingerPoints opposing = thumb_points(thumb, hand_lengths(0, 0), thumb_angles(closure));
  Vec3 s1 = finger.pip - index_mcp, s2 = finger.dip - finger.pip, s3 = finger.tip - finger.dip;
  Vec3 t1 = opposing.pip - thumb.base, t2 = opposing.dip - opposing.pip, t3 = opposing.tip - opposing.dip;
  Vec3 w = hand_vectors[HAND_FINGER_SWING].xyz;
  Vec3 v = hand_vectors[HAND_THUMB_SWING].xyz;
  Vec3 bend = w.x * s1 + (w.x + w.y) * s2 + (w.x + w.y + w.z) * s3;
  Vec3 fold = v.x * t1 + (v.x - v.y) * t2 + (v.x - v.y - v.z) * t3;
  slope = dot(bend, index.forward) * index.palmward - dot(bend, index.palmward) * index.forward -
          (dot(fold, thumb.forward) * thumb.palmward - dot(fold, thumb.palmward) * thumb.forward);
  return finger.tip - opposing.tip;
}

Real closure_of_gap(Real gap, Real tolerance) {
  Real span = HAND_GAP_OPEN - HAND_GAP_CLOSED;
  Real place = clamp((HAND_GAP_OPEN - gap) / span, Real(0), Real(1)) * Real(GAP_ENTRIES - 1);
  int cell = min(int(place), GAP_ENTRIES - 2);
  Real low = gap_table(cell);
  Real high = gap_table(cell + 1);
  Real closure = low + (high - low) * (place - Real(cell));
  for (int step = 0; step < LIMIT_GAP_STEPS; ++step) {
    Vec3 slope;
    Vec3 apart = tip_to_tip(closure, slope);
    Real distance = length(apart);
    Real error = distance - gap;
    if (abs(error) < tolerance) break;
    if (error > Real(0)) low = closure;
    if (error < Real(0)) high = closure;
    Real rate = dot(apart, slope) / distance;
    Real next = closure - error / rate;
    if (!(distance > Real(0) && next > low && next < high)) next = Real(0.5) * (low + high);
    closure = next;
  }
  return closure;
}

#endif

// SPDX-License-Identifier: MIT
// Twin of core/closure.cpp.
#ifndef CLOSURE_GLSL
#define CLOSURE_GLSL

#include "hand.glsl"
#include "sdf.glsl"

struct Grip {
  Real height, azimuth, obliquity, roll, offset, hand_scale;
};

struct Trace {
  Real t;
  int reason;
  Vec3 normal;
  int element;
};

struct Closing {
  int reason;
  Vec3 direction, midpoint;
  Real t_index, t_thumb, gap, closure, thumb_angle, index_angle;
  bool grazing;
  Placement placement;
};

Trace trace_tip(Vec3 origin, Vec3 direction, Real heading, Real radius) {
  Vec3 center = Vec3(Real(0), scene.bound_height, Real(0));
  Real middle = dot(center - origin, direction);
  Real reach = scene.bound_radius + radius + STOP_TOLERANCE;
  Real traveled = Real(0);
  Trace trace = Trace(Real(0), REASON_NOT_CONVERGED, Vec3(0), -1);
  for (int step = 0; step < LIMIT_TRACE_STEPS; ++step) {
    trace.t = middle + heading * (reach - traveled);
    precise Vec3 place = origin + trace.t * direction;
    Support support = support_at(place);
    Real clear = support.distance - radius;
    if (abs(clear) < STOP_TOLERANCE) {
      trace.reason = REASON_NONE;
      trace.normal = support.normal;
      trace.element = support.element;
      break;
    }
    traveled += safe_step(support, clear, -heading * direction, Real(1), Real(0));
    if (traveled > Real(2) * reach) {
      trace.reason = REASON_MISSES;
      break;
    }
  }
  if (SDF_KIND == SDF_LATTICE && trace.reason == REASON_NONE) {  // after the loop: once for all lanes, wherever each of them ended
    precise Vec3 place = origin + trace.t * direction;
    trace.normal = lattice_gradient(place);
  }
  return trace;
}

Placement place_hand(Real closure, Vec3 direction, Real roll, Vec3 midpoint, Real scale, out Real e1_x) {
  Vec3 slope;
  Vec3 apart = tip_to_tip(closure, slope);
  Vec3 e1 = apart / length(apart);
  e1_x = e1.x;
  Vec3 e2_raw = Vec3(1, 0, 0) - e1.x * e1;
  Vec3 e2 = e2_raw / length(e2_raw);
  Vec3 e3 = cross(e1, e2);
  Vec3 down_raw = Vec3(0, -1, 0) + direction.y * direction;
  Vec3 down = down_raw / length(down_raw);
  Vec3 side = cross(direction, down);
  Real sq, cq;
  sine_cosine(roll, sq, cq);
  Vec3 f2 = cq * down + sq * side;
  Vec3 f3 = cross(direction, f2);
  Mat3 rotation = Mat3(direction * e1.x + f2 * e2.x + f3 * e3.x, direction * e1.y + f2 * e2.y + f3 * e3.y,
                       direction * e1.z + f2 * e2.z + f3 * e3.z);
  Vec3 thumb_tip = thumb_points(hand_frame(0), hand_lengths(0, 0), thumb_angles(closure)).tip;
  Vec3 middle = thumb_tip + Real(0.5) * apart;
  return Placement(rotation, midpoint - rotation * (scale * middle), scale);
}

FingerFrame placed_frame(Placement placement, FingerFrame frame) {
  Vec3 base = placement.rotation * (placement.scale * frame.base) + placement.translation;
  return FingerFrame(base, placement.rotation * frame.forward, placement.rotation * frame.palmward);
}

Closing close_fingers(Grip grip) {
  Closing closing;
  Vec3 d = grip_direction(grip.azimuth, grip.obliquity);
  closing.direction = d;
  closing.reason = REASON_DEGENERATE;
  Real off_axis = sqrt(d.x * d.x + d.z * d.z);
  if (off_axis < DEGENERATE_SINE) return closing;
  Vec3 aside = Vec3(-d.z, Real(0), d.x) / off_axis;
  Vec3 origin = Vec3(Real(0), grip.height, Real(0)) + grip.offset * aside;
  Real scale = HAND_SCALE * grip.hand_scale;
  Real thumb_radius = scale * hand_radius(0, 3);
  Real index_radius = scale * hand_radius(1, 4);
  // a loop, so that the distance is compiled once for both sides
  Trace index, thumb;
  [[dont_unroll]] for (int side = 0; side < 2; ++side) {
    Trace trace = trace_tip(origin, d, side == 0 ? Real(1) : Real(-1), side == 0 ? index_radius : thumb_radius);
    if (side == 0) index = trace;
    thumb = trace;
  }
  closing.reason = REASON_NOT_CONVERGED;
  if (index.reason == REASON_NOT_CONVERGED || thumb.reason == REASON_NOT_CONVERGED) return closing;
  closing.reason = REASON_MISSES;
  if (index.reason == REASON_MISSES || thumb.reason == REASON_MISSES) return closing;
  closing.t_index = index.t;
  closing.t_thumb = thumb.t;
  closing.gap = index.t - thumb.t;
  closing.midpoint = origin + (Real(0.5) * (index.t + thumb.t)) * d;
  closing.reason = REASON_TOO_WIDE;
  if (closing.gap > scale * HAND_GAP_OPEN) return closing;
  closing.reason = REASON_TOO_NARROW;
  if (closing.gap < scale * HAND_GAP_CLOSED || closing.gap < thumb_radius + index_radius) return closing;
  closing.closure = closure_of_gap(closing.gap / scale, STOP_TOLERANCE / scale);
  Real e1_x;
  closing.placement = place_hand(closing.closure, d, grip.roll, closing.midpoint, scale, e1_x);
  if (abs(e1_x) > LARGEST_E1_X) return closing;
  closing.reason = REASON_ON_MOUTH;
  if (index.element == int(scene.lid) || thumb.element == int(scene.lid)) return closing;
  closing.reason = REASON_NONE;
  closing.index_angle = angle_between(index.normal, d);
  closing.thumb_angle = angle_between(thumb.normal, -d);
  closing.grazing = abs(dot(index.normal, d)) < Real(GRAZING_COSINE) || abs(dot(thumb.normal, d)) < Real(GRAZING_COSINE);
  return closing;
}

#endif

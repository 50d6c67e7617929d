// SPDX-License-Identifier: MIT
// Which leaf function a probe evaluates, and how many numbers it takes and gives: read by the probe shaders and by the tests.
#ifndef WHOLEHAND_PROBE_TABLE_H
#define WHOLEHAND_PROBE_TABLE_H

#define CONST_PROBE 10  // specialization constant: one of these

// probe_trig
#define PROBE_SINE_COSINE 0      // angle; sine, cosine
#define PROBE_ARC_COSINE 1       // x; angle
#define PROBE_ANGLE_BETWEEN 2    // a, b; angle
#define PROBE_DIRECTION_ANGLE 3  // y, x; angle
// probe_hand
#define PROBE_TRAJECTORY 10      // closure; angles of the thumb, of a finger
#define PROBE_FINGER_POINTS 11   // frame, mcp, lengths, angles; pip, dip, tip
#define PROBE_THUMB_POINTS 12    // frame, lengths, angles; mcp, ip, tip
#define PROBE_TIP_TO_TIP 13      // closure; way, slope, gap
#define PROBE_CLOSURE_OF_GAP 14  // gap; closure
#define PROBE_SEGMENT_END 15     // frame, start, length, angle; end
// probe_sdf; element: a, b, center, radius, side and supports as layout.h has them
#define PROBE_SIGNED_DISTANCE 20  // point; distance
#define PROBE_GRADIENT 21         // point; gradient, element
#define PROBE_SUPPORT 22          // point; distance, other, normal, element, planar
#define PROBE_SAFE_STEP 23        // distance, other, normal, planar, separation, velocity, speed, acceleration; step
#define PROBE_CONTACT 24          // point, radius; separation, proxy, settled
#define PROBE_ELEMENT 25          // element, q, sign; distance, crosses, spans, convex, supports, outward
#define PROBE_PROXY 26            // point, radius; proxy, settled
#define PROBE_LOCATE_CELL 27      // point; cell, fraction, outside
#define PROBE_LATTICE_SAMPLE 28   // i, j, k; sample
#define PROBE_MIX_REALS 29        // a, b, t; mixed
#define PROBE_DISTANCE_BEYOND 97  // value, way off the box; distance
// probe_closure
#define PROBE_TRACE_TIP 30   // origin, azimuth, obliquity, heading, radius; t, reason, normal, element
#define PROBE_PLACE_HAND 31  // closure, azimuth, obliquity, roll, midpoint, scale; rotation, translation, e1.x, index frame
// height, azimuth, obliquity, roll, offset, hand_scale, and what the core adds to the radii of index and thumb; reason, where it
// stands for some: direction | t_index, t_thumb, gap, midpoint | closure, thumb_angle, index_angle, grazing, rotation, translation,
// scale
#define PROBE_CLOSE_FINGERS 32
#define PROBE_REACH_WRIST 33  // wrist, shoulder, side; along, low, aside, straight, bent
// closure, azimuth, obliquity, roll, midpoint, scale of the hand, shoulder, turn of the holder, raised; flexion, deviation, pronation, share
#define PROBE_EASE_WRIST 34
#define PROBE_FIND_WRIST 35  // closure, azimuth, obliquity, roll, midpoint, scale; share
// probe_projection
#define PROBE_CHAIN_SUMS 40  // of three joints; of their segments
// finger: frame, mcp, lengths, radii; angles, rates, number; sphere, velocity, acceleration, speed, bend, jerk
#define PROBE_WATCHED_PLACE 41
#define PROBE_NEAREST_POINT 42    // separations, first; point
#define PROBE_PLACE_STEP 43       // the same; step
#define PROBE_FINGER_MOTION 44    // finger, limit; angles, blocked, unsettled
#define PROBE_PAPER_AXIS 45       // index MCP, little MCP, index tip, thumb tip; direction, exists
#define PROBE_TURNED_POINT 46     // point, pivot, axis, angle; point
#define PROBE_PROJECT_POINT 47    // point, radius, pivot, axis, largest angle; point, unsettled
#define PROBE_PROJECTION_ROLE 48  // point, touched before; role
// origin, rates, joint, at, end, steps, blocked, unsettled; next joint: the motion, in this order
#define PROBE_TURN_JOINT 49
// probe_force
#define PROBE_DIRECTIONS 80   // direction, sense, sine, cosine; pour, up
#define PROBE_LOAD_CENTER 81  // fixed, lean, height, pour; center
#define PROBE_REFERENCE 82    // mass, gravity, length; torque
#define PROBE_FORCES 83       // base, range, torque, reference, opening, max; normal, feedback
#define PROBE_STRENGTH_AT 87  // opening; share
#define PROBE_SCORE 86  // fingers, points, phalanx, palm, closure, feedback, max, hold, strength, wrist; terms, posture with it
// probe_body; radii of finger_in_table: PIP, DIP, tip
#define PROBE_BALL_BETWEEN 100     // start, end, their radii, share; place, radius
#define PROBE_NEAREST_SHARE 101    // x; share
#define PROBE_BONES_OVERLAP 102    // of two bones: start, end, their radii; deepest; overlap
#define PROBE_DEPTH_IN_TABLE 103   // point, radius; depth
#define PROBE_FINGER_IN_TABLE 104  // pip, dip, tip, radii; depth
#define PROBE_AROUND_BONE 106      // two spheres; place, radius
#define PROBE_OVERLAP_MORE 107     // two spheres, deepest; whether
// probe_press
#define PROBE_PRESS 105  // arm, normal, friction, gamma, direction; height, wrench

#endif

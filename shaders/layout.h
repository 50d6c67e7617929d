// SPDX-License-Identifier: MIT
// The one file that C++ and GLSL both include: bindings, group sizes, specialization constant ids, output fields, status bits and named tolerances.
// It only has the preprocessor's integers and numbers, and one parameter struct of scalars.
#ifndef WHOLEHAND_LAYOUT_H
#define WHOLEHAND_LAYOUT_H

// RATIO: of whole numbers, in the includer's reals, because a literal would be a float in GLSL.
#ifdef __cplusplus
#include <cstdint>

#define RATIO(a, b) (double(a) / double(b))
#else
#define RATIO(a, b) (Real(a) / Real(b))
#endif

// ---- named tolerances (F64 where the reals are double, F32 where they are float) ----
#define STOP_TOLERANCE_F64 1e-9     // m: sphere tracing, conservative advancement, proxies, gap inverse
#define STOP_TOLERANCE_F32 1e-6
#define DEGENERATE_SINE_F64 1e-9    // sine of the angle between thumb-index line and axis under which a grip is degenerate
#define DEGENERATE_SINE_F32 1e-6
#define AXIS_DISTANCE RATIO(1, 1000000)  // m: paper pose, a point nearer to its axis stays
#define LARGEST_E1_X RATIO(19, 20)  // |e1.x| above which the hand's frame is ill-defined: too narrow
#define SMALLEST_PIVOT RATIO(1, 200)  // m: per_grip torque reference, and levers
#define BARE_LEVER RATIO(1, 1000)  // of the pivot length, at least the smallest: a lever up to this counts as 0 for contacts without torsion
// Mean grip strength on handles of 38.1, 50.8, 63.5 and 76.2 mm, over the largest: 231, 236, 208 and 158 N (PMC3855544).
#define OPENING_FROM RATIO(381, 10000)  // m: the first diameter,
#define OPENING_STEP RATIO(127, 10000)  // .. and the increase to the next
#define OPENING_GAIN RATIO(5, 236)      // of the strength: more at the second than at the first,
#define OPENING_LOSS_1 RATIO(28, 236)   // .. less at the third than there,
#define OPENING_LOSS_2 RATIO(50, 236)   // .. and less again at the fourth
#define CONTACT_MARGIN RATIO(1, 400000)  // m: this near to the contact threshold, rounding may decide whether it is a contact
#define DEPTH_SCALE RATIO(1, 100)   // m: depth at which the depth score reaches 0
#define GRAZING_COSINE 0.017452406437283512  // cosine of 89 degrees: contact normal within 1 degree of perpendicular to the line

#define TRACE_STEPS 1000            // sphere tracing steps per side
#define ADVANCE_STEPS 1024          // conservative advancement steps per stage
#define PROXY_STEPS 16
#define GAP_STEPS 32                // safeguarded Newton steps of the gap's inverse
#define GAP_TABLE_SIZE 257          // entries of the table that starts the gap's inverse
#define GAP_TABLE_LARGEST 1025      // .. that the hand's block has room for
#define MAX_OUTLINE 32              // elements that a kernel copies
#define HALF_UNIT RATIO(1, 1024)    // m: unit of 16-bit samples, chosen so that subnormal halves are under 60 nm

// ---- turns of loops, small enough for TURN_BUDGET (host/turns.h); a grip whose efforts take more pivots is STATUS_OUT_OF_TURNS ----
#define DEVICE_RISES 4              // of an effort: times that a grip looks for the state that its last lower bound bounds highest
#define EFFORT_TURNS 4000           // of a grip in a dispatch of the effort kernel
#define RESERVE_TURNS 4100          // .. of the kernel of reserves,
#define RESERVE_RAISE_TURNS 1100    // and turns in which it searches for a friction

// ---- the hand ----
#define FINGERS 5
#define JOINTS 24
#define THUMB_TIP 3
#define INDEX_TIP 8
#define PHALANGES 14  /* two of the thumb, three of each finger */
#define MOST_BETWEEN 8              // spheres on a bone between its joints

// ---- the arm ----
#define ARM_AZIMUTHS 24             // azimuths from which the holder may take a body of revolution
#define ARM_RAISES 7                // places of the elbow, from low to the side

// ---- why a grip is not feasible, in the order of decision (status, low 4 bits) ----
#define REASON_NONE 0
#define REASON_DEGENERATE 1
#define REASON_NOT_CONVERGED 2
#define REASON_MISSES 3
#define REASON_TOO_WIDE 4
#define REASON_TOO_NARROW 5
#define REASON_ON_MOUTH 6

#define STATUS_REASON_MASK 0xF
#define STATUS_PLAUSIBLE 0x10
#define STATUS_ANTIPODAL 0x20
#define STATUS_GRAZING 0x40         // a contact normal within 1 degree of perpendicular to the line
#define STATUS_PROXY_UNSETTLED 0x80 // a proxy used up its steps
#define STATUS_BLOCKED_SHIFT 8      // bits 8..12: finger f was inside when open
#define STATUS_THROUGH_TABLE 0x2000 // bit 13: the hand, posed or open, reaches below the table and its clearance
#define STATUS_SELF_OVERLAP 0x4000  // bit 14: two fingers lie deeper in each other than the depth limit
#define STATUS_CONTACT_UNDECIDED 0x8000 // bit 15: rounding may decide for a point or sphere within CONTACT_MARGIN whether it is a contact
#define STATUS_UNSETTLED_SHIFT 16   // bits 16..20: finger f used up its advancement steps
#define STATUS_OUT_OF_TURNS 0x200000 // bit 21: a kernel's turns ran out (TURN_BUDGET); the host has the core compute the grip, so only the host sees
                                     // it
#define STATUS_NOT_HELD 0x400000    // bit 22: a plausible grip whose worst effort is above 1
#define STATUS_BEYOND_WRIST 0x800000 // bit 23: no arm reaches the hand within the ranges of its wrist and forearm and above the table
#define STATUS_UNJUDGED 0x1000000   // bit 24: a plausible grip without efforts: none would raise its score to the wanted minimum

// ---- kinds, as specialization constants ----
#define POSE_ARTICULATED 0
#define POSE_PAPER 1
#define POSE_RIGGED 2
#define SDF_OUTLINE 0
#define SDF_LATTICE 1
#define TORQUE_PAPER 0
#define TORQUE_EXACT 1
#define REFERENCE_PER_OBJECT 0
#define REFERENCE_PER_GRIP 1

// ---- output fields ----
// FIELD_name (C++) and PLANE_name (GLSL). Shapes, units and meaning are in core/fields.cpp.
// Reals: planes real_out[plane * n + grip], as many as the field's shape says.
#define REAL_FIELD_LIST(X) \
  X(T_INDEX, 0) X(T_THUMB, 1) X(GAP, 2) X(MIDPOINT, 3) X(CLOSURE, 4) X(CONTACT_ANGLES, 5) \
  X(PHALANX_DEPTH, 6) X(PALM_DEPTH, 7) X(BONE_STRETCH, 8) X(JOINTS, 9) X(POSED, 10) X(PROXIES, 11) \
  X(SEPARATION, 12) X(PEAK_FORCE, 13) X(PEAK_TILT, 14) X(LARGEST_HOLD, 15) X(SAFE_TILT, 16) \
  X(SCORE, 17) X(TERMS, 18) X(PIVOT_LENGTH, 19) X(TORQUE, 20) X(EXACT_TORQUE, 21) \
  X(NORMAL_FORCE, 22) X(FEEDBACK_FORCE, 23) X(HOLD_FORCE, 24) X(TABLE_DEPTH, 25) \
  X(WORST_EFFORT, 26) X(WORST_EFFORT_FILL, 27) X(WORST_EFFORT_TILT, 28) X(TIPS_WORST_EFFORT, 29) \
  X(PUSH, 30) X(FRICTION_NEEDED, 31) X(EFFORT, 32) X(EFFORT_LOW, 33) X(TIPS_EFFORT, 34) \
  X(SELF_DEPTH, 35) X(WRIST_SHARE, 36)
#define REAL_FIELDS 37
// Words: uint_out[plane * n + grip], one plane each.
#define UINT_FIELD_LIST(X) \
  X(STATUS, REAL_FIELDS + 0) X(TOUCH_MASK, REAL_FIELDS + 1) X(TIP_MASK, REAL_FIELDS + 2) \
  X(FINGER_MASK, REAL_FIELDS + 3) X(INNER_MASK, REAL_FIELDS + 4) X(USED_MASK, REAL_FIELDS + 5)
#define FIELDS (REAL_FIELDS + 6)
#ifdef __cplusplus
#define DECLARE_FIELD(name, number) inline constexpr int FIELD_##name = number;
REAL_FIELD_LIST(DECLARE_FIELD)
UINT_FIELD_LIST(DECLARE_FIELD)
#undef DECLARE_FIELD
#endif

// ---- axes of a grip as the kernels read them: grips_in[axis * n + grip] ----
#define AXIS_HEIGHT 0
#define AXIS_AZIMUTH 1
#define AXIS_OBLIQUITY 2
#define AXIS_ROLL 3
#define AXIS_OFFSET 4
#define AXIS_HAND_SCALE 5
#define GRIP_AXES 6

// ---- bindings, all in set 0 ----
#define BINDING_PARAMETERS 0        // uniform: Parameters
#define BINDING_GRIPS 1             // readonly: Real[GRIP_AXES * n]
#define BINDING_REAL_OUT 2          // Real[planes * n]
#define BINDING_UINT_OUT 3          // uint[planes * n]
#define BINDING_HAND 4              // uniform: vec4[HAND_VECTORS]
#define BINDING_OUTLINE 5           // readonly: Real[OUTLINE_STRIDE * count]
#define BINDING_LATTICE 6           // texel buffer of uint: each a float's bits, or two halves in units of HALF_UNIT, the first in the low bits
#define BINDING_CANDIDATES 7        // Real scores, and
#define BINDING_INDICES 8           // uint indices of the top-N selection
#define BINDING_STATES 9            // uniform: vec4[2 * STATES_IN_BLOCK], a stretch of the (fill, tilt) in order
#define BINDING_LANES 10            // uint[2]: useful lanes and all lanes, if a benchmark counts them (real.glsl)
#define BINDINGS 11

// Record of an outline element, reals: start r, start y, end r, end y, center r, center y, radius, code. side: 0: line, with its unit
// outward normal in place of the center; +1: arc on the half r >= center r; -1: the other half. supports: bits that say whether the element's tangent
// is a supporting line of the outline (nothing of the outline lies beyond it) if a point's nearest one lies between the element's ends, is its start,
// or is its end. For the last two, the line is perpendicular to the way to the point.
#define OUTLINE_STRIDE 8
#define SUPPORTS_BETWEEN 1
#define SUPPORTS_AT_A 2
#define SUPPORTS_AT_B 4
#define ELEMENT_CODE(side, supports) ((side) + 4 * (supports))  /* its parts: */
#define SUPPORTS_OF(code) (((code) + 1) >> 2)
#define SIDE_OF(code) ((code) - 4 * SUPPORTS_OF(code))
#define NO_LID 0xfffffffeu           // no element, distinct from a lattice's -1
#define FAR_AWAY 1048576.0           // m: the distance of other elements if none limits the step

// The hand as vec4s. Per finger: base and L0; forward and L1; palmward and L2; radii 0..3; radius 4 and L3.
#define HAND_FINGER_STRIDE 5
#define HAND_THUMB_OPEN 25          // abduction, MCP, IP; largest further turn
#define HAND_THUMB_SWING 26         // ...; paper's largest turn
#define HAND_FINGER_OPEN 27         // MCP, PIP, DIP; contact tolerance
#define HAND_FINGER_SWING 28        // ...; depth limit
#define HAND_JOINT_LIMIT 29         // MCP, PIP, DIP; scale
#define HAND_GAP 30                 // g(0), g(1)
#define HAND_TABLE 31               // closures of the gap's inverse, four a vec4
#define HAND_VECTORS 288

// A state as the force kernel reads it: weight (N), the vessel's own share of the mass, lean of the center of mass, and its height if the vessel's
// own is on the axis; sine, cosine and angle of its tilt (angle -1: the state is left out), and the angle of the previous tilt (-1: none). A state as
// the effort kernel reads it: its load; sine and cosine of its tilt; then, for safe tilts, the angle of the previous tilt (-1: none) and the number
// of its fill, else the angle of its tilt and its fill as a fraction.
#define STATE_STRIDE 8
#define STATES_IN_BLOCK 256         // in double 16 KiB, the smallest uniform range that Vulkan grants

// The placed hand: the columns of its rotation, its translation, and a bit for each point that touched before it moved.
#define PLACED_TRANSLATION 9
#define PLACED_BEFORE 12
#define PLACED_STRIDE 13

// A joint's contact: its place on the surface and the inward normal there; both 0 if there is none. A sphere between joints uses the slot of a joint
// of its digit that does not touch.
#define CONTACT_STRIDE 6
#define EFFORT_WORST 0              // the largest effort of the whole hand; with push.flag, the tilt up to which it holds, for each fill
#define EFFORT_TIPS 1               // that of thumb and index tip alone
#define EFFORT_PUSH 2               // of the kernel of reserves: the largest force beside the weight
#define EFFORT_FRICTION 3           // .. the least friction with which all states are held
#define DEVICE_PIVOTS 200           // of a solve
#define SOLVE_REALS 42              // .. in the group's memory, an invocation, in the small build

// ---- specialization constant ids ----
#define CONST_GROUP_SIZE 0
#define CONST_POSE 1
#define CONST_SDF_KIND 2
#define CONST_OUTLINE_COUNT 3
#define CONST_ARCS 4                // bits of the elements that may be arcs, if the outline is copied; -1: all
#define CONST_TORQUE 5
#define CONST_REFERENCE 6
#define CONST_TABLE 7               // whether the scene has a table, bool
#define CONST_UNTIL_POURED 8        // of the forces: whether states may be left out, bool
#define CONST_BETWEEN 9             // spheres on a bone between its joints, 0..MOST_BETWEEN
#define CONST_OFF_AXIS 10           // of the forces: whether a vessel's own center of mass lies off its axis, bool
#define CONST_BARE 11               // .. whether contacts carry no moment (torsion 0), bool
#define CONST_TOGETHER 12           // .. how many grips an invocation has, 1..
#define CONST_ARM 13                // of the grips: azimuths at which the holder may take the vessel; 0: the scene has no arm
#define CONST_CONTACTS 20           // first of CONTACT_STRIDE * JOINTS planes, scratch: the joints' contacts; -1: not computed
#define CONST_EFFORT_TASK 21        // of the efforts and reserves: EFFORT_WORST .. EFFORT_FRICTION
#define CONST_PLACED 22             // first of PLACED_STRIDE planes, scratch: passed between the kernels of a grip
#define CONST_STOP_TOLERANCE 40     // Real, m; this and the next five have the named values by default
#define CONST_TRACE_STEPS 41
#define CONST_ADVANCE_STEPS 42
#define CONST_GAP_STEPS 43
#define CONST_GAP_TABLE_SIZE 44
#define CONST_LATTICE_BITS 45       // of a sample: 32 or 16
#define CONST_EFFORT_TOLERANCE 47   // Real, of an effort's bracket; 1e-3 by default
#define CONST_FEW_STEPS 48          // of the grips: whether their steps are limited below the core's to keep within TURN_BUDGET, bool
#define CONST_PLANE 320             // + field: first plane, or -1: not computed

#define GROUP_SIZE 64
// Entries per invocation of the top-N selection: with a full list's shifts within TURN_BUDGET.
#define SELECT_ENTRIES 900
#define SELECT_SCORES_TO_FIRST 0   // push.first: the source, and the target half of the candidates
#define SELECT_FIRST_TO_SECOND 1
#define SELECT_SECOND_TO_FIRST 2
#define SELECT_SCORES_TO_SECOND 3

// Scalars of a vessel and a scene, in one uniform block. Branches on them alone cost time: lavapipe takes such numbers for constants, and may
// recompile the kernel in every dispatch.
#ifdef __cplusplus
template <class Real>
#endif
struct Parameters {
  Real bound_height;      // m: center and radius of a sphere that encloses the vessel
  Real bound_radius;
  Real lattice_x, lattice_y, lattice_z, lattice_spacing;  // m
  Real center_x, center_y, center_z;          // of the empty vessel, m
  Real gravity;           // m/s2
  Real force_base, force_range, force_max;    // N
  Real reference;         // torque reference per object, N m
  Real largest_mass;      // upright at the largest fill: kg,
  Real largest_share, largest_height;         // the liquid's share of it and the height of its center, m
  Real friction, torsion; // mu, gamma (m)
  Real friction_angle;    // atan(mu), rad
  Real grip_strength;     // N
  Real thumb_strength, index_strength, middle_strength, ring_strength, little_strength, palm_strength;  // N
  Real tip_radii;         // m, of thumb and index finger together, at the scene's scale; 0: strengths are the same at every opening
  Real pour_sense;        // +1 away, -1 towards
  Real table_top;         // m, the table's height and the clearance
  Real lid_radius, lid_height;                // edge of the mouth's element in the outline, m; with none, no point is above it
  Real shoulder_x, shoulder_y, shoulder_z;    // vessel frame, m
  Real upper_arm, forearm, wrist_radius, elbow_radius;                     // m
  Real flexion, extension, ulnar, radial, pronation, supination;           // ranges, rad
  Real weight_fingers, weight_contacts, weight_depth, weight_posture, weight_force, weight_hold;
#ifdef __cplusplus
  std::uint32_t
#else
  uint
#endif
      outline_count,      // for the variant that reads its outline from a buffer
      lid,                // index of the mouth's element, NO_LID: none
      lattice_nx, lattice_ny, lattice_nz, fills, tilts;
};

// Push constants: number of grips of this chunk, distance between planes; first state and number of states for split dispatches; the bits of the
// lowest wanted score; and a flag: whether efforts are for safe tilts, or a score is its upper bound.
#ifdef __cplusplus
struct Push {
  std::uint32_t count, stride, first, number;
  std::uint32_t floor_low = 0, floor_high = 0;
  std::uint32_t flag = 0;
};
#endif

#endif

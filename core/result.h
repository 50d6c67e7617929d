// SPDX-License-Identifier: MIT
// The results of one grip, as plain doubles in SI units; shared by the core (either precision) and the GPU.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/scene.h"

namespace wholehand {

// Where and how the two tracked fingers close. Vessel frame; roll and the rest as in docs/method.md.
struct GripInput {
  double height = 0;      // m
  double azimuth = 0;     // rad
  double obliquity = 0;   // rad
  double roll = 0;        // rad
  double offset = 0;      // m
  double hand_scale = 1;  // times the scene's own
};

// Why a grip is not feasible, in the order of decision. Values equal REASON_* of shaders/layout.h.
enum class Reason : std::uint32_t { none, degenerate, not_converged, misses, too_wide, too_narrow, on_mouth };
extern const std::array<const char*, 7> REASON_NAMES;  // "" for none

using PosedHand = std::array<Triple, JOINT_COUNT>;  // vessel frame, m

// Fields exist up to the reason: gap and midpoint from too_wide on, everything else only if the reason is none.
struct GripResult {
  Reason reason = Reason::none;
  bool plausible = false;                  // not deeper than the depth limit, not through the table, and not beyond the wrist
  bool antipodal = false;                  // both contact angles within atan(mu)
  bool grazing = false;                    // a contact normal within 1 degree of perpendicular to the thumb-index line
  bool self_overlap = false;               // two fingers lie deeper in each other than the depth limit
  bool through_table = false;              // the hand, posed or open, reaches below the table and its clearance
  bool beyond_wrist = false;               // no arm reaches the hand within the ranges of its wrist and forearm
  std::array<double, 2> contact_angles{};  // thumb, index: between outward normal and line, rad
  double closure = 0;
  double gap = 0;  // m
  Triple midpoint{};
  std::array<Triple, JOINT_COUNT> joints{};  // rigged hand, vessel frame, m
  PosedHand posed{};
  std::array<Triple, JOINT_COUNT> proxies{};
  std::array<double, JOINT_COUNT> separation{};
  std::uint32_t touch_mask = 0;  // bit j: joint j touches in the posed hand
  std::uint32_t tip_mask = 0;    // projected, by role
  std::uint32_t finger_mask = 0;
  std::uint32_t inner_mask = 0;
  std::uint32_t used_mask = 0;               // bit f: finger f has a touching point
  std::uint32_t status = 0;                  // STATUS_* bits of shaders/layout.h; STATUS_NOT_HELD is found with the score
  double phalanx_depth = 0, palm_depth = 0;  // m, >= 0
  double bone_stretch = 0;                   // m
  double self_depth =
      std::numeric_limits<double>::quiet_NaN();  // m, of two fingers in each other; NaN without spheres between the joints
  double table_depth = std::numeric_limits<double>::quiet_NaN();  // m, above 0: through_table; NaN without a table
  double wrist_share = std::numeric_limits<double>::quiet_NaN();  // share of a range, above 1: beyond_wrist; NaN without an arm
  // Flexion, ulnar deviation and pronation of the wrist at that share, rad; only from the core.
  std::array<double, 3> wrist_angles{wrist_share, wrist_share, wrist_share};
  // Iterations, only from the core (a device reports none): of the longer trace of a tip, and of a finger's longest stage.
  int trace_steps = 0, advance_steps = 0;
};

// Liquid of a vessel at one fill and tilt; the center of mass lies in the (n, y) plane.
struct LiquidResult {
  double volume = 0, mass = 0;  // m3, kg
  double lean = 0, height = 0;  // center of mass along n and y, m
  double poured = 0;            // m3
};

// Where the hand presses on the vessel: nearest point of the surface (m) and unit normal into the vessel, vessel frame.
struct GripContact {
  int joint = 0, between = 0;  // between: number of a sphere of the bone that ends at the joint; 0: the joint
  int digit = 0;               // the digit is a finger, or FINGER_COUNT for the palm
  bool is_tip = false;         // of thumb or index finger
  Triple point{}, normal{};
};

// One state of one grip.
struct StateResult {
  double mass = 0;                                              // vessel and liquid, kg
  Triple center_of_mass{};                                      // vessel frame, m
  double pivot_length = 0;                                      // m
  double torque = 0, exact_torque = 0;                          // N m
  double normal_force = 0, feedback_force = 0, hold_force = 0;  // N; hold is infinity if the pinch is not antipodal
};

// Per-fill terms of a grip over the tilts that count. An angle is NaN if no tilt qualifies.
struct FillTerms {
  double peak_force = 0;    // largest feedback force, N
  double peak_tilt = 0;     // the first tilt at which it occurs, rad
  double largest_hold = 0;  // N, may be infinity
  double safe_tilt = 0;     // largest tilt up to which unclamped F < F_max and N_hold <= grip strength, rad; NaN: none
};

struct ScoreTerms {
  double fingers = 0, contacts = 0, depth = 0, posture = 0, force = 0, hold = 0;
};

// The factor by which the hand's strength exceeds what is needed: 1 / worst effort; infinite if nothing has to be held.
inline double held_margin(double worst_effort) {
  return worst_effort == 0 ? std::numeric_limits<double>::infinity() : 1 / worst_effort;
}

struct GripScore {
  double score = 0;
  bool not_held = false;  // plausible, and the worst effort is above 1
  ScoreTerms terms;
  std::vector<FillTerms> fills;  // one per fill (one, empty glass, without liquid); empty without tilts
};

}  // namespace wholehand

// SPDX-License-Identifier: MIT
#include "core/fields.h"

#include <array>
#include <string_view>

namespace wholehand {
namespace {

using S = FieldShape;
using A = FieldAbsent;
using R = FieldRange;
constexpr bool DEFAULT = true, ON_REQUEST = false;
constexpr const char* NONE = "";
constexpr const char* EFFORT = "NaN where the grip is implausible";
constexpr const char* UNRESISTED = "infinite where no force of the hand holds the vessel; NaN where the grip is implausible";
constexpr const char* HOLD =
    "infinite where no such force holds the vessel: without strengths where the pinch is not antipodal; with strengths NaN where "
    "the "
    "grip is implausible";

constexpr Field ROWS[] = {
    {FIELD_T_INDEX, S::one, "t_index", "m", "place of the index tip on the thumb-index line", NONE, ON_REQUEST, "closure",
     "index contact", 0, A::not_closed},
    {FIELD_T_THUMB, S::one, "t_thumb", "m", "place of the thumb tip on the thumb-index line", NONE, ON_REQUEST, "closure",
     "thumb contact", 0, A::not_closed},
    {FIELD_GAP, S::one, "gap", "m", "distance between the tips of thumb and index finger", NONE, DEFAULT, "closure", "gap", 0,
     A::not_closed},
    {FIELD_MIDPOINT, S::vector, "midpoint", "m", "midpoint of the tips of thumb and index finger, vessel frame", NONE, ON_REQUEST,
     "closure", "midpoint", 0, A::not_closed},
    {FIELD_CLOSURE, S::one, "closure", "1", "closure of thumb and index finger: 0 open, 1 closed", NONE, DEFAULT, "closure",
     "closure"},
    {FIELD_CONTACT_ANGLES, S::contacts, "contact_angles", "rad", "angle between contact normal and thumb-index line", NONE, DEFAULT,
     "closure", "contact angle"},
    {FIELD_JOINTS, S::joint_vectors, "joints", "m", "joints of the rigged hand, vessel frame", NONE, ON_REQUEST, "hand",
     "rigged joints"},
    {FIELD_POSED, S::joint_vectors, "posed", "m", "joints of the posed hand, vessel frame", NONE, ON_REQUEST, "projection",
     "posed joints", 1},
    {FIELD_SEPARATION, S::joints, "separation", "m", "signed distance of the posed hand's joints to the vessel, less their radius",
     NONE, ON_REQUEST, "sdf", "separation", 1},
    {FIELD_PROXIES, S::joint_vectors, "proxies", "m", "proxies of the posed hand's joints, vessel frame", NONE, ON_REQUEST,
     "contact", "proxies", 1},
    {FIELD_PHALANX_DEPTH, S::one, "phalanx_depth", "m", "largest depth in the vessel of a phalanx, at its joints and spheres", NONE,
     DEFAULT, "contact", "phalanx depth", 1},
    {FIELD_PALM_DEPTH, S::one, "palm_depth", "m",
     "largest depth in the vessel of the palm: metacarpal bases and spheres on metacarpals", NONE, DEFAULT, "contact", "palm depth",
     1},
    {FIELD_BONE_STRETCH, S::one, "bone_stretch", "m", "largest change of a bone's length between proxies against the rigged hand",
     NONE, ON_REQUEST, "contact", "bone stretch", 1},
    {FIELD_PIVOT_LENGTH, S::states, "pivot_length", "m", "distance from the pivot to the center of mass", NONE, ON_REQUEST, "force",
     "pivot length"},
    {FIELD_TORQUE, S::states, "torque", "N m", "torque of the paper's eq. (1)", "m g L_pivot sin(tilt)", ON_REQUEST, "force",
     "torque"},
    {FIELD_EXACT_TORQUE, S::states, "exact_torque", "N m", "torque about the tilt direction, positive topples further", NONE,
     ON_REQUEST, "force", "exact torque"},
    {FIELD_NORMAL_FORCE, S::states, "normal_force", "N", "normal force", "F_base + F_range torque / reference torque", ON_REQUEST,
     "force", "normal force"},
    {FIELD_FEEDBACK_FORCE, S::states, "feedback_force", "N", "force that the gripper renders", "normal force clamped to [0, F_max]",
     ON_REQUEST, "force", "feedback force"},
    {FIELD_HOLD_FORCE, S::states, "hold_force", "N", "force with which each of two tips must press to hold the vessel", HOLD,
     ON_REQUEST, "force", "hold force", 0, A::infeasible, R::may_be_infinite},
    {FIELD_PEAK_FORCE, S::fills, "peak_feedback_force", "N", "largest feedback force over all tilts", NONE, DEFAULT, "force",
     "peak feedback"},
    {FIELD_PEAK_TILT, S::fills, "peak_feedback_tilt", "rad", "first tilt at which the feedback force is largest", NONE, DEFAULT,
     "force", nullptr},
    {FIELD_LARGEST_HOLD, S::fills, "largest_hold_force", "N",
     "largest force with which each of two tips must press, over all tilts", HOLD, DEFAULT, "force", "largest hold", 0,
     A::infeasible, R::may_be_infinite},
    {FIELD_SAFE_TILT, S::fills, "largest_safe_tilt", "rad",
     "largest tilt up to which the unclamped feedback force is below F_max and the vessel is held: with strengths an effort up to "
     "1, "
     "without them a hold force up to 40 N",
     "NaN where no tilt is; with strengths also where the grip is implausible", DEFAULT, "force", nullptr, 0, A::infeasible,
     R::may_be_missing},
    {FIELD_TABLE_DEPTH, S::one, "table_depth", "m",
     "largest depth of the skin of the hand, posed or open, below the table and its clearance",
     "up to 0: the hand stays above; more: the grip is implausible", ON_REQUEST, "table", "table depth", 1, A::infeasible,
     R::finite, true},
    {FIELD_SELF_DEPTH, S::one, "self_depth", "m", "largest overlap of two bones of different digits of the posed hand",
     "below 0: they are apart; more than the depth limit: the grip is implausible", ON_REQUEST, "body", "self depth", 1,
     A::infeasible, R::finite, false, true},
    {FIELD_WRIST_SHARE, S::one, "wrist_share", "1",
     "largest share of a range of motion that wrist and forearm take, where the arm reaches the hand best",
     "up to 1: within reach; more: the grip is implausible", DEFAULT, "wrist", "wrist share", 0, A::infeasible, R::finite, false,
     false, false, true},
    {FIELD_WORST_EFFORT, S::one, "worst_effort", "1", "largest effort over all fills and tilts", UNRESISTED, DEFAULT, "effort",
     "1/(1+worst effort)", 0, A::infeasible, R::may_be_infinite, false, false, true},
    {FIELD_WORST_EFFORT_FILL, S::one, "worst_effort_fill", "1", "fill of a state of the largest effort, of the capacity", EFFORT,
     DEFAULT, "effort", nullptr, 0, A::infeasible, R::finite, false, false, true},
    {FIELD_WORST_EFFORT_TILT, S::one, "worst_effort_tilt", "rad", "tilt of that state", EFFORT, DEFAULT, "effort", nullptr, 0,
     A::infeasible, R::finite, false, false, true},
    {FIELD_TIPS_WORST_EFFORT, S::one, "tips_worst_effort", "1",
     "largest effort over all fills and tilts, of thumb and index tip alone", UNRESISTED, ON_REQUEST, "effort",
     "1/(1+tips' effort)", 0, A::infeasible, R::may_be_infinite, false, false, true},
    {FIELD_PUSH, S::one, "push", "N",
     "largest force at the center of mass, along any axis of the vessel frame, that is held beside the weight upright and fullest",
     EFFORT, ON_REQUEST, "effort", "push", 0, A::infeasible, R::finite, false, false, true},
    {FIELD_FRICTION_NEEDED, S::one, "friction_needed", "1", "least friction with which every state is held",
     "infinite where none up to 10 does; NaN where the grip is implausible", ON_REQUEST, "effort", "1/(1+friction)", 0,
     A::infeasible, R::may_be_infinite, false, false, true},
    {FIELD_EFFORT, S::states, "effort", "1", "least part of the hand's strength that holds the vessel", UNRESISTED, ON_REQUEST,
     "effort", nullptr, 0, A::infeasible, R::may_be_infinite, false, false, true},
    {FIELD_EFFORT_LOW, S::states, "effort_low", "1", "lower bound of the effort", UNRESISTED, ON_REQUEST, "effort", nullptr, 0,
     A::infeasible, R::may_be_infinite, false, false, true},
    {FIELD_TIPS_EFFORT, S::states, "tips_effort", "1", "effort of thumb and index tip alone", UNRESISTED, ON_REQUEST, "effort",
     nullptr, 0, A::infeasible, R::may_be_infinite, false, false, true},
    {FIELD_TERMS, S::terms, nullptr, "1", "score terms: fingers, contacts, depth, posture, force, hold", NONE, DEFAULT, "score",
     "terms", 0, A::never},
    {FIELD_SCORE, S::one, "score", "1", "score of the grip, larger is better",
     "sum of weight x term over the score terms (attribute score_weights); 0 where the grip is infeasible (and so are its terms), "
     "implausible or not held",
     DEFAULT, "score", "score", 0, A::never},
};
static_assert(std::size(ROWS) == REAL_FIELDS, "a row for each field of reals in shaders/layout.h");

// Places of FIELD_* among the rows.
constexpr std::array<std::size_t, REAL_FIELDS> PLACES = [] {
  std::array<std::size_t, REAL_FIELDS> places{};
  for (std::size_t& place : places) place = std::size(ROWS);
  for (std::size_t row = 0; row < std::size(ROWS); ++row) places[static_cast<std::size_t>(ROWS[row].number)] = row;
  return places;
}();
static_assert(
    [] {
      for (const std::size_t place : PLACES)
        if (place == std::size(ROWS)) return false;
      return true;
    }(),
    "no field of reals has two rows");

}  // namespace

std::span<const Field> real_fields() { return ROWS; }

const Field& field_row(int field) { return ROWS[PLACES[static_cast<std::size_t>(field)]]; }

int field_of_variable(std::string_view variable) {
  for (const Field& field : ROWS)
    if (field.variable && variable == field.variable) return field.number;
  return -1;
}

FineUnit fine_unit(const Field& field) {
  const std::string_view units = field.units;
  if (units == "m") return {"um", 1e6};
  if (units == "rad") return {"urad", 1e6};
  if (units == "N") return {"mN", 1e3};
  if (units == "N m") return {"uN m", 1e6};
  return {"1e-6", 1e6};
}

}  // namespace wholehand

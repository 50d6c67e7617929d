// SPDX-License-Identifier: MIT
#include "sweeps/variables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>

#include "core/error.h"
#include "shaders/layout.h"

namespace wholehand {
namespace {

constexpr bool DEFAULT = true, ON_REQUEST = false;

std::int32_t word_itself(std::uint32_t word) { return static_cast<std::int32_t>(word); }
std::int32_t bits_set(std::uint32_t word) { return std::popcount(word); }
std::int32_t reason(std::uint32_t status) { return static_cast<std::int32_t>(status & STATUS_REASON_MASK); }
std::int32_t plausible(std::uint32_t status) { return (status & STATUS_PLAUSIBLE) != 0; }
std::int32_t antipodal(std::uint32_t status) { return (status & STATUS_ANTIPODAL) != 0; }
std::int32_t grazing(std::uint32_t status) { return (status & STATUS_GRAZING) != 0; }
std::int32_t blocked(std::uint32_t status) { return static_cast<std::int32_t>((status >> STATUS_BLOCKED_SHIFT) & 0x1F); }
std::int32_t unsettled(std::uint32_t status) { return static_cast<std::int32_t>((status >> STATUS_UNSETTLED_SHIFT) & 0x1F); }
std::int32_t proxy_unsettled(std::uint32_t status) { return (status & STATUS_PROXY_UNSETTLED) != 0; }

constexpr const char* FINGER_BITS = "bit f: finger f; 0 thumb, 1 index, 2 middle, 3 ring, 4 little; 0 where the grip is infeasible";
constexpr const char* JOINT_BITS = "bit j: joint j, as the variable joint names them; 0 where the grip is infeasible";
constexpr const char* INFINITE = "infinite where not antipodal";

using Dims = std::vector<const char*>;
constexpr const char* NO_COMMENT = "";

Variable real(const char* name, const char* units, const char* long_name, const char* comment, int field, int plane = 0,
              const Dims& dims = {}) {
  return {name, units, long_name, comment, NumberType::real, field, plane, dims, true, Need::nothing, nullptr, false};
}

Variable byte(const char* name, const char* long_name, const char* comment, int field, std::int32_t (*value)(std::uint32_t)) {
  return {name, "1", long_name, comment, NumberType::byte, field, 0, {}, true, Need::nothing, value, false};
}

// A bit for each finger.
Variable finger_mask(const char* name, const char* long_name, int field, std::int32_t (*value)(std::uint32_t)) {
  return {name, "1", long_name, FINGER_BITS, NumberType::byte, field, 0, {}, true, Need::nothing, value, false, FINGER_COUNT, 0};
}

// A bit for each joint.
Variable joint_mask(const char* name, const char* long_name, int field) {
  return {name, "1",           long_name,   JOINT_BITS, NumberType::word, field, 0, {},
          true, Need::nothing, word_itself, false,      JOINT_COUNT,      0};
}

// A group of the catalogue: kept by default or on request, and what it needs.
void add(std::vector<Variable>& catalogue, bool by_default, Need need, std::vector<Variable> group) {
  for (Variable& variable : group) {
    variable.by_default = by_default;
    variable.need = need;
    const std::string_view name = variable.name;
    variable.always = name == "score" || name.starts_with("score_") || name == "reason";
    catalogue.push_back(std::move(variable));
  }
}

// In one piece however long, because it is one table: a row a variable.
std::vector<Variable> make_catalogue() {
  std::vector<Variable> all;
  const Dims fill{"fill"}, state{"fill", "tilt"}, vector{"xyz"}, joint{"joint"}, joint_vector{"joint", "xyz"}, contact{"contact"};
  add(all, DEFAULT, Need::nothing,
      {
          real(
              "score", "1", "score of the grip, larger is better",
              "sum of weight x term over the score terms (attribute score_weights); 0 where the grip is infeasible (and so are its "
              "terms) or implausible",
              FIELD_SCORE),
          real("score_fingers", "1", "score term: fingers used", "fingers used / 5", FIELD_TERMS, 0),
          real("score_contacts", "1", "score term: points touching", "points touching / 24", FIELD_TERMS, 1),
          real("score_depth", "1", "score term: depth of the hand in the vessel",
               "1 - min(1, max(phalanx_depth, palm_depth) / 10 mm)", FIELD_TERMS, 2),
          real("score_posture", "1", "score term: middle of the hand's range", "1 - |2 closure - 1|", FIELD_TERMS, 3),
      });
  add(all, DEFAULT, Need::tilts,
      {
          real("score_force", "1", "score term: feedback force", "1 - (largest feedback force over all fills and tilts) / F_max",
               FIELD_TERMS, 4),
          real("score_hold", "1", "score term: force to hold",
               "min(1, grip strength / largest hold force over all fills and tilts)", FIELD_TERMS, 5),
      });
  add(all, DEFAULT, Need::nothing,
      {
          byte("reason", "why the grip is infeasible", "none: it is feasible", FIELD_STATUS, reason),
          byte("plausible", "whether the hand is nowhere deeper than the depth limit", YES_NO, FIELD_STATUS, plausible),
          byte("antipodal", "whether both contact angles lie within the friction cone", YES_NO, FIELD_STATUS, antipodal),
          real("closure", "1", "closure of thumb and index finger: 0 open, 1 closed", NO_COMMENT, FIELD_CLOSURE),
          real("gap", "m", "distance between the tips of thumb and index finger", NO_COMMENT, FIELD_GAP),
          real("phalanx_depth", "m", "largest depth of a phalanx point in the vessel", NO_COMMENT, FIELD_PHALANX_DEPTH),
          real("palm_depth", "m", "largest depth of a metacarpal base in the vessel", NO_COMMENT, FIELD_PALM_DEPTH),
          real("contact_angles", "rad", "angle between contact normal and thumb-index line", NO_COMMENT, FIELD_CONTACT_ANGLES, 0,
               contact),
          byte("fingers_used", "number of fingers with a touching point", NO_COMMENT, FIELD_USED_MASK, bits_set),
          byte("points_touching", "number of touching points", NO_COMMENT, FIELD_TOUCH_MASK, bits_set),
          finger_mask("used_mask", "fingers with a touching point", FIELD_USED_MASK, word_itself),
          joint_mask("touch_mask", "points touching in the posed hand", FIELD_TOUCH_MASK),
      });
  add(all, DEFAULT, Need::articulated,
      {finger_mask("blocked_mask", "fingers that are inside the vessel when open", FIELD_STATUS, blocked)});
  add(all, DEFAULT, Need::projection,
      {
          byte("projected_tip", "number of projected tips of fingers whose inner points touched before", NO_COMMENT, FIELD_TIP_MASK,
               bits_set),
          byte("projected_finger", "number of projected points of fingers that did not touch before", NO_COMMENT, FIELD_FINGER_MASK,
               bits_set),
          byte("projected_inner", "number of other projected points", NO_COMMENT, FIELD_INNER_MASK, bits_set),
          joint_mask("projected_tip_mask", "projected tips of fingers whose inner points touched before", FIELD_TIP_MASK),
          joint_mask("projected_finger_mask", "projected points of fingers that did not touch before", FIELD_FINGER_MASK),
          joint_mask("projected_inner_mask", "other projected points", FIELD_INNER_MASK),
      });
  add(all, DEFAULT, Need::tilts,
      {
          real("peak_feedback_force", "N", "largest feedback force over all tilts", NO_COMMENT, FIELD_PEAK_FORCE, 0, fill),
          real("peak_feedback_tilt", "rad", "first tilt at which the feedback force is largest", NO_COMMENT, FIELD_PEAK_TILT, 0,
               fill),
          real("largest_hold_force", "N", "largest force per finger that holding takes, over all tilts", INFINITE,
               FIELD_LARGEST_HOLD, 0, fill),
          real("largest_safe_tilt", "rad",
               "largest tilt up to which the unclamped feedback force is below F_max and the hold force within the grip strength",
               "NaN where no tilt is", FIELD_SAFE_TILT, 0, fill),
      });
  add(all, ON_REQUEST, Need::nothing,
      {
          real("t_index", "m", "place of the index tip on the thumb-index line", NO_COMMENT, FIELD_T_INDEX),
          real("t_thumb", "m", "place of the thumb tip on the thumb-index line", NO_COMMENT, FIELD_T_THUMB),
          real("midpoint", "m", "midpoint of the tips of thumb and index finger, vessel frame", NO_COMMENT, FIELD_MIDPOINT, 0,
               vector),
          real("bone_stretch", "m", "largest change of a bone's length between proxies against the rigged hand", NO_COMMENT,
               FIELD_BONE_STRETCH),
          real("joints", "m", "joints of the rigged hand, vessel frame", NO_COMMENT, FIELD_JOINTS, 0, joint_vector),
          real("posed", "m", "joints of the posed hand, vessel frame", NO_COMMENT, FIELD_POSED, 0, joint_vector),
          real("proxies", "m", "proxies of the posed hand's joints, vessel frame", NO_COMMENT, FIELD_PROXIES, 0, joint_vector),
          real("separation", "m", "signed distance of the posed hand's joints to the vessel, less their radius", NO_COMMENT,
               FIELD_SEPARATION, 0, joint),
          byte("grazing", "whether a contact normal is within 1 degree of perpendicular to the thumb-index line", YES_NO,
               FIELD_STATUS, grazing),
          byte("proxy_unsettled", "whether a proxy took all its steps", YES_NO, FIELD_STATUS, proxy_unsettled),
      });
  add(all, ON_REQUEST, Need::articulated,
      {finger_mask("unsettled_mask", "fingers that took all their advancement steps", FIELD_STATUS, unsettled)});
  add(all, ON_REQUEST, Need::tilts,
      {
          real("pivot_length", "m", "distance from the pivot to the centre of mass", NO_COMMENT, FIELD_PIVOT_LENGTH, 0, state),
          real("torque", "N m", "torque of the paper's eq. (1)", "m g L_pivot sin(tilt)", FIELD_TORQUE, 0, state),
          real("exact_torque", "N m", "torque about the tilt direction, positive topples further", NO_COMMENT, FIELD_EXACT_TORQUE,
               0, state),
          real("normal_force", "N", "normal force", "F_base + F_range torque / reference torque", FIELD_NORMAL_FORCE, 0, state),
          real("feedback_force", "N", "force that the gripper renders", "normal force clamped to [0, F_max]", FIELD_FEEDBACK_FORCE,
               0, state),
          real("hold_force", "N", "force per finger that a soft-finger pinch needs to hold the vessel", INFINITE, FIELD_HOLD_FORCE,
               0, state),
      });
  return all;
}

const std::vector<Variable>& catalogue() {
  static const std::vector<Variable> CATALOGUE = make_catalogue();
  return CATALOGUE;
}

// What the scene lacks for a variable; null: nothing.
const char* missing_need(Need need, const Scene& scene) {
  switch (need) {
    case Need::tilts:
      return scene.tilts.empty() ? "[tilts]" : nullptr;
    case Need::projection:
      return scene.pose == Pose::rigged ? "a [scene] pose other than \"rigged\"" : nullptr;
    case Need::articulated:
      return scene.pose != Pose::articulated ? "[scene] pose = \"articulated\"" : nullptr;
    case Need::nothing:
      break;
  }
  return nullptr;
}

}  // namespace

std::span<const Variable> variable_catalogue() { return catalogue(); }

std::size_t variable_planes(const Variable& variable, const Scene& scene) {
  std::size_t planes = 1;
  for (const std::string_view dim : variable.dims) {
    if (dim == "fill") planes *= scene_fills(scene);
    if (dim == "tilt") planes *= scene.tilts.size();
    if (dim == "joint") planes *= JOINT_COUNT;
    if (dim == "xyz") planes *= 3;
    if (dim == "contact") planes *= 2;
  }
  return planes;
}

std::vector<const Variable*> choose_variables(const Scene& scene) {
  const OutputData& output = scene.output;
  const std::string& given = output.keep ? output.keep_place : output.also_place;
  const std::string where = fmt::format("{}: [output] {}", given.empty() ? scene.file : given, output.keep ? "keep" : "also");
  const std::vector<std::string>& named = output.keep ? *output.keep : output.also;
  std::set<std::string> wanted(named.begin(), named.end());
  std::vector<const Variable*> chosen;
  for (const Variable& variable : catalogue()) {
    const char* lacking = missing_need(variable.need, scene);
    const bool is_named = wanted.erase(variable.name) > 0;
    if (is_named && lacking)
      throw usage_error(fmt::format("{}: \"{}\" needs {}, which this scene does not have", where, variable.name, lacking));
    if (is_named || (!output.keep && variable.by_default && !lacking)) chosen.push_back(&variable);
  }
  if (!wanted.empty()) {
    std::vector<std::string> known;
    for (const Variable& variable : catalogue()) {
      if (!missing_need(variable.need, scene)) known.push_back(variable.name);
    }
    throw usage_error(fmt::format("{}: unknown variable{} \"{}\"; known: {}", where, wanted.size() > 1 ? "s" : "",
                                  fmt::join(wanted, "\", \""), fmt::join(known, ", ")));
  }
  return chosen;
}

std::vector<int> variable_fields(const std::vector<const Variable*>& variables) {
  std::set<int> fields;
  for (const Variable* variable : variables) fields.insert(variable->field);
  if (!fields.empty()) fields.insert(FIELD_STATUS);
  return {fields.begin(), fields.end()};
}

bool keeps_vectors(const std::vector<const Variable*>& variables) {
  return std::any_of(variables.begin(), variables.end(), [](const Variable* variable) {
    return std::any_of(variable->dims.begin(), variable->dims.end(), [](const char* dim) { return std::strcmp(dim, "xyz") == 0; });
  });
}

double bytes_per_grip(const std::vector<const Variable*>& variables, const Scene& scene, std::size_t real_size) {
  double bytes = 0;
  for (const Variable* variable : variables) {
    const std::size_t size = variable->type == NumberType::real ? real_size : variable->type == NumberType::byte ? 1 : 4;
    bytes += static_cast<double>(size * variable_planes(*variable, scene));
  }
  return bytes;
}

bool is_kept(const FieldSet& fields, int field) {
  return fields.has(field) && fields.plane[field] < (field < REAL_FIELDS ? fields.real_kept : fields.uint_kept);
}

}  // namespace wholehand

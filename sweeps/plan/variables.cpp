// SPDX-License-Identifier: MIT
#include "sweeps/plan/variables.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>

#include "base/text/error.h"
#include "base/text/text.h"
#include "core/fields.h"
#include "shaders/layout.h"

namespace wholehand::sweeps {
namespace {

constexpr bool DEFAULT = true, ON_REQUEST = false;

std::int32_t word_itself(std::uint32_t word) { return static_cast<std::int32_t>(word); }
std::int32_t bits_set(std::uint32_t word) { return std::popcount(word); }
std::int32_t reason(std::uint32_t status) { return static_cast<std::int32_t>(status & STATUS_REASON_MASK); }
std::int32_t plausible(std::uint32_t status) { return (status & STATUS_PLAUSIBLE) != 0; }
std::int32_t not_held(std::uint32_t status) { return (status & STATUS_NOT_HELD) != 0; }
std::int32_t antipodal(std::uint32_t status) { return (status & STATUS_ANTIPODAL) != 0; }
std::int32_t through_table(std::uint32_t status) { return (status & STATUS_THROUGH_TABLE) != 0; }
std::int32_t self_overlap(std::uint32_t status) { return (status & STATUS_SELF_OVERLAP) != 0; }
std::int32_t beyond_wrist(std::uint32_t status) { return (status & STATUS_BEYOND_WRIST) != 0; }
std::int32_t grazing(std::uint32_t status) { return (status & STATUS_GRAZING) != 0; }
std::int32_t undecided(std::uint32_t status) { return (status & STATUS_CONTACT_UNDECIDED) != 0; }
std::int32_t blocked(std::uint32_t status) { return static_cast<std::int32_t>((status >> STATUS_BLOCKED_SHIFT) & 0x1F); }
std::int32_t unsettled(std::uint32_t status) { return static_cast<std::int32_t>((status >> STATUS_UNSETTLED_SHIFT) & 0x1F); }
std::int32_t proxy_unsettled(std::uint32_t status) { return (status & STATUS_PROXY_UNSETTLED) != 0; }

constexpr const char* FINGER_BITS = "bit f: finger f; 0 thumb, 1 index, 2 middle, 3 ring, 4 little; 0 where the grip is infeasible";
constexpr const char* JOINT_BITS = "bit j: joint j, as the variable joint names them; 0 where the grip is infeasible";

using Dims = std::vector<const char*>;
constexpr const char* NO_COMMENT = "";

Dims dims_of(FieldShape shape) {
  switch (shape) {
    case FieldShape::contacts:
      return {"contact"};
    case FieldShape::vector:
      return {"xyz"};
    case FieldShape::joints:
      return {"joint"};
    case FieldShape::joint_vectors:
      return {"joint", "xyz"};
    case FieldShape::fills:
      return {"fill"};
    case FieldShape::states:
      return {"fill", "tilt"};
    case FieldShape::one:
    case FieldShape::terms:
      break;
  }
  return {};
}

// A field of reals as one variable.
Variable of_field(const Field& row) {
  const bool of_tilts = row.shape == FieldShape::fills || row.shape == FieldShape::states;
  return {row.variable,
          row.units,
          row.long_name,
          row.comment,
          NumberType::real,
          row.number,
          0,
          dims_of(row.shape),
          row.by_default,
          row.of_strength  ? Need::strength
          : of_tilts       ? Need::tilts
          : row.of_table   ? Need::table
          : row.of_between ? Need::between
          : row.of_arm     ? Need::arm
                           : Need::nothing,
          nullptr,
          row.absent == FieldAbsent::never};
}
Variable of_field(int field) { return of_field(field_row(field)); }

// One of the six score terms.
Variable term(const char* name, const char* long_name, const char* comment, int plane) {
  return {name, "1", long_name, comment, NumberType::real, FIELD_TERMS, plane, {}, true, Need::nothing, nullptr, true};
}

Variable byte(const char* name, const char* long_name, const char* comment, int field, std::int32_t (*value)(std::uint32_t)) {
  return {name, "1", long_name, comment, NumberType::byte, field, 0, {}, true, Need::nothing, value, false};
}

// It has a value for infeasible grips too.
Variable always(Variable variable) {
  variable.always = true;
  return variable;
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

// A group of the catalogue: kept by default or on request, and its requirements. A field of its own says both by itself.
void add(std::vector<Variable>& catalogue, bool by_default, Need need, std::vector<Variable> group) {
  for (Variable& variable : group) {
    if (variable.type != NumberType::real || variable.field == FIELD_TERMS) {
      variable.by_default = by_default;
      variable.need = need;
    }
    catalogue.push_back(std::move(variable));
  }
}

// The fields of reals that the catalogue does not have yet.
void add_other_fields(std::vector<Variable>& catalogue) {
  for (const Field& row : real_fields()) {
    const bool is_there =
        std::any_of(catalogue.begin(), catalogue.end(), [&](const Variable& variable) { return variable.field == row.number; });
    if (!is_there) catalogue.push_back(of_field(row));
  }
}

// In one piece however long, because it is one table: one row per variable, in the order of the result file.
std::vector<Variable> make_catalogue() {
  std::vector<Variable> all;
  add(all, DEFAULT, Need::nothing,
      {
          of_field(FIELD_SCORE),
          term("score_fingers", "score term: fingers used", "fingers used / 5", 0),
          term("score_contacts", "score term: points touching", "points touching / 24", 1),
          term("score_depth", "score term: depth of the hand in the vessel", "1 - min(1, max(phalanx_depth, palm_depth) / 10 mm)",
               2),
          term("score_posture", "score term: middle of the hand's range", "1 - |2 closure - 1|", 3),
      });
  add(all, DEFAULT, Need::tilts,
      {
          term("score_force", "score term: feedback force", "1 - (largest feedback force over all fills and tilts) / F_max", 4),
          term("score_hold", "score term: force to hold",
               "with strengths 1 / (1 + worst_effort), else min(1, 40 N / largest hold force over all fills and tilts)", 5),
      });
  add(all, DEFAULT, Need::nothing,
      {
          always(byte("reason", "why the grip is infeasible", "none: it is feasible", FIELD_STATUS, reason)),
          byte("plausible",
               "whether the hand is nowhere deeper than the depth limit, in the vessel or a finger in another, above the table, "
               "and within "
               "reach of the wrist",
               YES_NO, FIELD_STATUS, plausible),
      });
  add(all, DEFAULT, Need::strength,
      {byte("not_held", "whether a plausible grip takes more than the hand's strength: its worst effort is above 1", YES_NO,
            FIELD_STATUS, not_held)});
  add(all, DEFAULT, Need::arm,
      {
          of_field(FIELD_WRIST_SHARE),
          byte("beyond_wrist",
               "whether wrist and forearm do not reach the hand within their ranges, which makes the grip implausible", YES_NO,
               FIELD_STATUS, beyond_wrist),
      });
  add(all, DEFAULT, Need::nothing,
      {
          byte("antipodal", "whether both contact angles lie within the friction cone", YES_NO, FIELD_STATUS, antipodal),
          of_field(FIELD_CLOSURE),
          of_field(FIELD_GAP),
          of_field(FIELD_PHALANX_DEPTH),
          of_field(FIELD_PALM_DEPTH),
          of_field(FIELD_CONTACT_ANGLES),
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
          of_field(FIELD_PEAK_FORCE),
          of_field(FIELD_PEAK_TILT),
          of_field(FIELD_LARGEST_HOLD),
          of_field(FIELD_SAFE_TILT),
      });
  add(all, ON_REQUEST, Need::nothing,
      {
          of_field(FIELD_T_INDEX),
          of_field(FIELD_T_THUMB),
          of_field(FIELD_MIDPOINT),
          of_field(FIELD_BONE_STRETCH),
          of_field(FIELD_JOINTS),
          of_field(FIELD_POSED),
          of_field(FIELD_PROXIES),
          of_field(FIELD_SEPARATION),
          byte("grazing", "whether a contact normal is within 1 degree of perpendicular to the thumb-index line", YES_NO,
               FIELD_STATUS, grazing),
          byte("undecided", "whether rounding may decide if a point or a sphere of the hand is a contact", YES_NO, FIELD_STATUS,
               undecided),
          byte("proxy_unsettled", "whether a proxy took all its steps", YES_NO, FIELD_STATUS, proxy_unsettled),
      });
  add(all, ON_REQUEST, Need::articulated,
      {finger_mask("unsettled_mask", "fingers that took all their advancement steps", FIELD_STATUS, unsettled)});
  add(all, ON_REQUEST, Need::tilts,
      {
          of_field(FIELD_PIVOT_LENGTH),
          of_field(FIELD_TORQUE),
          of_field(FIELD_EXACT_TORQUE),
          of_field(FIELD_NORMAL_FORCE),
          of_field(FIELD_FEEDBACK_FORCE),
          of_field(FIELD_HOLD_FORCE),
      });
  add(all, ON_REQUEST, Need::table,
      {
          of_field(FIELD_TABLE_DEPTH),
          byte("through_table", "whether the hand goes through the table, which makes the grip implausible", YES_NO, FIELD_STATUS,
               through_table),
      });
  add(all, ON_REQUEST, Need::between,
      {
          of_field(FIELD_SELF_DEPTH),
          byte("self_overlap",
               "whether two fingers lie deeper in each other than the depth limit, which makes the grip implausible", YES_NO,
               FIELD_STATUS, self_overlap),
      });
  add_other_fields(all);
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
    case Need::table:
      return scene.table ? nullptr : "[table]";
    case Need::between:
      return scene.hand.between > 0 ? nullptr : "[hand] between";
    case Need::strength:
      return !scene.strength ? "the efforts of [strength]" : scene.tilts.empty() ? "[tilts]" : nullptr;
    case Need::arm:
      return scene.arm ? nullptr : "[arm]";
    case Need::nothing:
      break;
  }
  return nullptr;
}

Error lacking_error(const std::string& where, const char* name, const char* lacking) {
  return usage_error(fmt::format("{}: \"{}\" needs {}, which this scene does not have", where, name, lacking));
}

// With the variables that the scene can have.
Error unknown_error(const Scene& scene, const std::string& where, const std::set<std::string>& names) {
  std::vector<std::string> known;
  for (const Variable& variable : catalogue()) {
    if (!missing_need(variable.need, scene)) known.push_back(variable.name);
  }
  return usage_error(fmt::format("{}: unknown variable{} \"{}\"; known: {}", where, names.size() > 1 ? "s" : "",
                                 joined(names, "\", \""), joined(known, ", ")));
}

}  // namespace

std::string variable_comment(const Variable& variable, const Scene& scene) {
  std::string comment = variable.comment;
  const bool is_of_states = variable.need == Need::tilts || variable.need == Need::strength;
  if (variable.type != NumberType::real || !is_of_states || !scene.until_poured) return comment;
  if (!comment.empty()) comment += "; ";
  const bool has_states =
      std::any_of(variable.dims.begin(), variable.dims.end(), [](const char* dim) { return std::strcmp(dim, "tilt") == 0; });
  return comment + fmt::format("{} the tilts beyond the first at which {:.6g} of the fill has poured (until_poured)",
                               has_states ? "NaN at" : "leaves out", *scene.until_poured);
}

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
    if (is_named && lacking) throw lacking_error(where, variable.name, lacking);
    // with efforts the lists have it from the effort of the tips
    const bool is_said = variable.field == FIELD_LARGEST_HOLD && has_effort(scene);
    if (is_named || (!output.keep && variable.by_default && !lacking && !is_said)) chosen.push_back(&variable);
  }
  if (!wanted.empty()) throw unknown_error(scene, where, wanted);
  return chosen;
}

std::vector<const Variable*> named_variables(const Scene& scene, std::span<const std::string> names, const std::string& where) {
  std::set<std::string> unknown(names.begin(), names.end());
  for (const Variable& variable : catalogue()) unknown.erase(variable.name);
  if (!unknown.empty()) throw unknown_error(scene, where, unknown);
  std::vector<const Variable*> named;
  for (const std::string& name : names)
    for (const Variable& variable : catalogue()) {
      if (name != variable.name) continue;
      if (const char* lacking = missing_need(variable, scene)) throw lacking_error(where, variable.name, lacking);
      named.push_back(&variable);
    }
  return named;
}

const char* missing_need(const Variable& variable, const Scene& scene) { return missing_need(variable.need, scene); }

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

}  // namespace wholehand::sweeps

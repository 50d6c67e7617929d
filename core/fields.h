// SPDX-License-Identifier: MIT
// The real output fields of a grip, as one table that all code reads. A new field needs a line in shaders/layout.h, a row of this table, and the
// lines that compute it in core/evaluator.cpp and in the .comp that writes it.
#pragma once

#include <span>
#include <string_view>

#include "shaders/layout.h"

namespace wholehand {

// The shape of a field: how many planes it has, and what they are. Order: contacts thumb, index; joints joint-major, x y z; states fill-major.
enum class FieldShape { one, contacts, vector, terms, joints, joint_vectors, fills, states };

// When a field has no value (NaN). The score and its terms are 0 instead.
enum class FieldAbsent { infeasible, not_closed, never };

// What a feasible grip's value may be besides finite: infinite if nothing holds the vessel, NaN if no tilt qualifies.
enum class FieldRange { finite, may_be_infinite, may_be_missing };

struct Field {
  int number;  // FIELD_*
  FieldShape shape;
  const char* variable;   // name in the result file; null: the file has variables of its own for it (sweeps/plan/variables)
  const char* units;      // of the values: "m", "rad", "N", "N m", "1"
  const char* long_name;  // what it is, and its frame
  const char* comment;    // formula, or what a special value means; may be empty
  bool by_default;        // kept in a result file by default
  const char* kernel;     // the kernel that computes it, in reports
  const char* label;      // in comparisons; null: it is not compared number by number
  double rests = 0;       // its dependence on the length at which a finger rests; m per m
  FieldAbsent absent = FieldAbsent::infeasible;
  FieldRange range = FieldRange::finite;
  bool of_table = false;     // only in a scene with a table
  bool of_between = false;   // only of a hand with spheres between its joints
  bool of_strength = false;  // only in a scene with strengths and tilts, for plausible grips
  bool of_arm = false;       // only in a scene with an arm

  // Whether it is points or vectors of the vessel frame, which a left hand mirrors.
  bool is_vector() const { return shape == FieldShape::vector || shape == FieldShape::joint_vectors; }
};

// Every field of reals, in the order of the kernels that compute them.
std::span<const Field> real_fields();
// The row of FIELD_*, below REAL_FIELDS.
const Field& field_row(int field);
// FIELD_* of a variable of the result file; -1: no real field has this name.
int field_of_variable(std::string_view variable);

// The unit in which people read differences of such values, and its factor: "um" and 1e6 for m.
struct FineUnit {
  const char* name;
  double scale;
};
FineUnit fine_unit(const Field& field);

}  // namespace wholehand

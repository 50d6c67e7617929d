// SPDX-License-Identifier: MIT
// The catalogue of variables that a result file can hold for every grip, and a scene's choice from it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/planes.h"
#include "core/scene.h"

namespace wholehand::sweeps {

enum class NumberType { real, byte, word };  // real: float or double with the backend's precision; signed 8 and 32 bits

// What a scene needs for a variable to exist.
enum class Need { nothing, tilts, projection, articulated, table, between, strength, arm };

inline constexpr const char* YES_NO = "1: yes, 0: no";  // meaning of bytes that are true or false

constexpr int MISSING = -1;  // for bytes and words: the value for an infeasible grip (reals: NaN; masks: no bit)

// One variable of the result file. Its dimensions are (vessel, `dims`.., the grip's axes).
struct Variable {
  const char* name;
  const char* units;
  const char* long_name;
  const char* comment;  // formula or meaning of the values; empty: nothing to add
  NumberType type;
  int field;                      // FIELD_* of shaders/layout.h it comes from
  int plane;                      // first plane of the field that belongs to it
  std::vector<const char*> dims;  // of "fill", "tilt", "joint", "xyz", "contact"; the slowest first
  bool by_default;
  Need need;
  // Bytes and words: value of a feasible grip from the field's word; an infeasible grip has `missing`. Reals: null.
  std::int32_t (*value)(std::uint32_t word) = nullptr;
  bool always = false;  // has a value for infeasible grips too
  int bits = 0;         // of a mask: one for each finger or joint; 0: no mask
  std::int32_t missing = MISSING;

  // Whether the variable marks missing values (_FillValue). Readers like xarray convert integers with a _FillValue to reals. Masks must stay integers
  // for bit operations, so an infeasible grip has a mask without bits instead.
  bool has_missing() const { return type == NumberType::real || (bits == 0 && !always); }
};

// A variable's comment in a result of the scene, including the effect of tilts that are left out. May be empty.
std::string variable_comment(const Variable& variable, const Scene& scene);

// Every variable there is, in the order of the result file.
std::span<const Variable> variable_catalogue();

// Planes of a variable in a scene, the product of its dims: 6 terms are 6 variables of 1 plane each.
std::size_t variable_planes(const Variable& variable, const Scene& scene);

// The variables that `[output] keep` names, or the default ones that the scene can have plus those of `also`; in the catalogue's order, each once.
// Throws Error (usage) for a name that is unknown (listing the known ones) or needs what the scene lacks (naming it).
std::vector<const Variable*> choose_variables(const Scene& scene);

// The variables of these names, in order. `where` begins the line of an error; throws as choose_variables.
std::vector<const Variable*> named_variables(const Scene& scene, std::span<const std::string> names, const std::string& where);

// What the scene lacks for a variable, as in "[tilts]"; null: nothing.
const char* missing_need(const Variable& variable, const Scene& scene);

// FIELD_* from which they come, ascending, each once; with the status (which says whether a grip is feasible) unless there are none.
std::vector<int> variable_fields(const std::vector<const Variable*>& variables);

// Whether one of them is a vector of the vessel frame, which turns with the azimuth.
bool keeps_vectors(const std::vector<const Variable*>& variables);

// Bytes that the result file stores for one grip.
double bytes_per_grip(const std::vector<const Variable*>& variables, const Scene& scene, std::size_t real_size);

// Whether the planes of `field` may be read from a backend's chunks.
bool is_kept(const FieldSet& fields, int field);

}  // namespace wholehand::sweeps

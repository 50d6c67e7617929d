// SPDX-License-Identifier: MIT
// Results of many grips, field by field: one plane of `stride` numbers per scalar, so that a plane is one write to the file. Core and GPU use the
// same layout.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/result.h"
#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// Number of planes of a field (FIELD_* of layout.h) in a scene with `fills` and `tilts` (fills counts 1, the empty glass, where
// there is no liquid; 0 planes for the force fields where there are no tilts).
int field_planes(int field, std::size_t fills, std::size_t tilts);

// Whether efforts are computed: in a scene with strengths and tilts.
bool has_effort(const Scene& scene);

// The same for a scene; also 0 for a field of the table, of efforts or of the arm if the scene has none.
int field_planes(int field, const Scene& scene);

// Which fields are computed and where. Kept fields come first, so reading back copies a prefix. Scratch fields follow: other fields need them, and
// they stay on the device.
struct FieldSet {
  std::array<int, FIELDS> plane{};     // first plane (reals and uints counted separately), -1: not computed
  int real_kept = 0, real_planes = 0;  // planes kept, planes in all
  int uint_kept = 0, uint_planes = 0;
  bool has(int field) const { return plane[field] >= 0; }
};

// A field set that keeps `kept` (FIELD_*) and computes what they depend on.
FieldSet make_field_set(const std::vector<int>& kept, const Scene& scene);

// Planes of the grips first .. first + count - 1 of one vessel. Exactly one of `floats` and `doubles` is set.
struct PlaneChunk {
  std::size_t vessel = 0;
  std::uint64_t first = 0;
  std::size_t count = 0;
  std::size_t stride = 0;  // distance between planes, in elements, >= count
  const float* floats = nullptr;
  const double* doubles = nullptr;
  const std::uint32_t* uints = nullptr;
  double real(int plane, std::size_t i) const {
    return floats ? static_cast<double>(floats[plane * stride + i]) : doubles[plane * stride + i];
  }
  std::uint32_t uint(int plane, std::size_t i) const { return uints[plane * stride + i]; }
};

// Number of fills in a scene's states: its liquid's, or 1 (the empty glass).
std::size_t scene_fills(const Scene& scene);

// The liquid's fills in a vessel, fractions of its capacity, strictly ascending. Only for a scene with liquid.
const std::vector<double>& vessel_fills(const Scene& scene, const VesselData& vessel);

// Weights of the six score terms in the order of FIELD_TERMS: the scene's, or without tilts those of the four remaining terms scaled to
// sum to 1.
std::array<double, 6> effective_weights(const Scene& scene);

// Grip i of a chunk as a GripResult; fields that the set lacks stay zero.
GripResult decode_grip(const PlaneChunk& chunk, const FieldSet& fields, std::size_t i);

}  // namespace wholehand

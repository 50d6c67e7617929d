// SPDX-License-Identifier: MIT
#include "core/planes.h"

#include <algorithm>

#include "core/fields.h"

namespace wholehand {

int field_planes(int field, std::size_t fills, std::size_t tilts) {
  if (field >= REAL_FIELDS) return 1;
  const std::size_t per_fill = tilts > 0 ? fills : 0;
  switch (field_row(field).shape) {
    case FieldShape::contacts:
      return 2;
    case FieldShape::vector:
      return 3;
    case FieldShape::terms:
      return 6;
    case FieldShape::joints:
      return JOINT_COUNT;
    case FieldShape::joint_vectors:
      return 3 * JOINT_COUNT;
    case FieldShape::fills:
      return static_cast<int>(per_fill);
    case FieldShape::states:
      return static_cast<int>(per_fill * tilts);
    case FieldShape::one:
      break;
  }
  return 1;
}

int field_planes(int field, const Scene& scene) {
  if (field < REAL_FIELDS && field_row(field).of_table && !scene.table) return 0;
  if (field < REAL_FIELDS && field_row(field).of_between && scene.hand.between == 0) return 0;
  if (field < REAL_FIELDS && field_row(field).of_strength && !has_effort(scene)) return 0;
  if (field < REAL_FIELDS && field_row(field).of_arm && !scene.arm) return 0;
  return field_planes(field, scene_fills(scene), scene.tilts.size());
}

namespace {

// What must be computed for a score, and for any force.
const std::vector<int> SCORE_NEEDS{FIELD_STATUS,        FIELD_TOUCH_MASK,   FIELD_USED_MASK,  FIELD_CLOSURE,
                                   FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH,   FIELD_PEAK_FORCE, FIELD_LARGEST_HOLD,
                                   FIELD_MIDPOINT,      FIELD_WORST_EFFORT, FIELD_GAP,        FIELD_WRIST_SHARE};

}  // namespace

FieldSet make_field_set(const std::vector<int>& kept, const Scene& scene) {
  FieldSet set;
  set.plane.fill(-1);
  const auto place = [&](int field, bool is_kept) {
    const int planes = field_planes(field, scene);
    if (planes == 0 || set.plane[field] >= 0) return;
    int& next = field < REAL_FIELDS ? set.real_planes : set.uint_planes;
    set.plane[field] = next;
    next += planes;
    if (is_kept) (field < REAL_FIELDS ? set.real_kept : set.uint_kept) = next;
  };
  for (const int field : kept) place(field, true);
  place(FIELD_SCORE, false);
  for (const int field : SCORE_NEEDS) {
    // the midpoint serves the forces alone
    if (field == FIELD_MIDPOINT && scene.tilts.empty()) continue;
    // with efforts the hold term is the whole hand's
    if (field == FIELD_LARGEST_HOLD && has_effort(scene)) continue;
    // the gap serves strengths that shrink as the hand opens
    if (field == FIELD_GAP && !(has_effort(scene) && scene.strength->by_opening)) continue;
    place(field, false);
  }
  return set;
}

bool has_effort(const Scene& scene) { return scene.strength && !scene.tilts.empty(); }

std::size_t scene_fills(const Scene& scene) {
  return scene.liquid ? std::max(scene.liquid->fills.size(), scene.liquid->volumes.size()) : 1;
}

const std::vector<double>& vessel_fills(const Scene& scene, const VesselData& vessel) {
  return vessel.fills.empty() ? scene.liquid->fills : vessel.fills;
}

std::array<double, 6> effective_weights(const Scene& scene) {
  const ScoreWeights& w = scene.score;
  if (!scene.tilts.empty()) return {w.fingers, w.contacts, w.depth, w.posture, w.force, w.hold};
  const double sum = w.fingers + w.contacts + w.depth + w.posture;
  const double scale = sum > 0 ? 1 / sum : 0;
  return {w.fingers * scale, w.contacts * scale, w.depth * scale, w.posture * scale, 0, 0};
}

GripResult decode_grip(const PlaneChunk& chunk, const FieldSet& fields, std::size_t i) {
  GripResult result;
  const auto real = [&](int field, int k = 0) { return fields.has(field) ? chunk.real(fields.plane[field] + k, i) : 0.0; };
  const auto uint = [&](int field) { return fields.has(field) ? chunk.uint(fields.plane[field], i) : 0u; };
  const auto triples = [&](int field, std::array<Triple, JOINT_COUNT>& out) {
    if (!fields.has(field)) return;
    for (int j = 0; j < JOINT_COUNT; ++j)
      for (int k = 0; k < 3; ++k) out[j][k] = real(field, 3 * j + k);
  };
  result.status = uint(FIELD_STATUS);
  result.reason = static_cast<Reason>(result.status & STATUS_REASON_MASK);
  result.plausible = (result.status & STATUS_PLAUSIBLE) != 0;
  result.antipodal = (result.status & STATUS_ANTIPODAL) != 0;
  result.grazing = (result.status & STATUS_GRAZING) != 0;
  result.through_table = (result.status & STATUS_THROUGH_TABLE) != 0;
  result.beyond_wrist = (result.status & STATUS_BEYOND_WRIST) != 0;
  result.contact_angles = {real(FIELD_CONTACT_ANGLES, 0), real(FIELD_CONTACT_ANGLES, 1)};
  result.closure = real(FIELD_CLOSURE);
  result.gap = real(FIELD_GAP);
  result.midpoint = {real(FIELD_MIDPOINT, 0), real(FIELD_MIDPOINT, 1), real(FIELD_MIDPOINT, 2)};
  triples(FIELD_JOINTS, result.joints);
  triples(FIELD_POSED, result.posed);
  triples(FIELD_PROXIES, result.proxies);
  if (fields.has(FIELD_SEPARATION))
    for (int j = 0; j < JOINT_COUNT; ++j) result.separation[j] = real(FIELD_SEPARATION, j);
  result.touch_mask = uint(FIELD_TOUCH_MASK);
  result.tip_mask = uint(FIELD_TIP_MASK);
  result.finger_mask = uint(FIELD_FINGER_MASK);
  result.inner_mask = uint(FIELD_INNER_MASK);
  result.used_mask = uint(FIELD_USED_MASK);
  result.phalanx_depth = real(FIELD_PHALANX_DEPTH);
  result.palm_depth = real(FIELD_PALM_DEPTH);
  result.bone_stretch = real(FIELD_BONE_STRETCH);
  result.self_overlap = (result.status & STATUS_SELF_OVERLAP) != 0;
  if (fields.has(FIELD_SELF_DEPTH)) result.self_depth = real(FIELD_SELF_DEPTH);
  if (fields.has(FIELD_TABLE_DEPTH)) result.table_depth = real(FIELD_TABLE_DEPTH);
  if (fields.has(FIELD_WRIST_SHARE)) result.wrist_share = real(FIELD_WRIST_SHARE);
  return result;
}

}  // namespace wholehand

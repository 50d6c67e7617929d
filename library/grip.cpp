// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "library/scene.h"
#include "library/status.h"

using namespace wholehand;

namespace {

bool is_finite(const wh_grip& in) noexcept {
  return std::isfinite(in.height + in.azimuth + in.obliquity + in.roll + in.offset + in.hand_scale);
}

void copy_points(const std::array<Triple, JOINT_COUNT>& from, bool is_there, double (*to)[3]) noexcept {
  for (int j = 0; j < WH_JOINTS; ++j)
    for (int k = 0; k < 3; ++k) to[j][k] = is_there ? from[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)] : std::nan("");
}

wh_grip_result result_of(const GripResult& grip, const GripScore& score) noexcept {
  wh_grip_result out{};
  const bool is_feasible = grip.reason == Reason::none;
  out.reason = REASON_NAMES[static_cast<std::size_t>(grip.reason)];
  out.is_feasible = is_feasible;
  out.is_plausible = grip.plausible;
  out.is_antipodal = grip.antipodal;
  out.is_grazing = grip.grazing;
  out.overlaps_itself = grip.self_overlap;
  out.is_through_table = grip.through_table;
  out.touch_mask = grip.touch_mask;
  out.used_mask = grip.used_mask;
  out.tip_mask = grip.tip_mask;
  out.finger_mask = grip.finger_mask;
  out.inner_mask = grip.inner_mask;
  const double none = std::nan("");
  out.closure = is_feasible ? grip.closure : none;
  // these two exist from too_wide on
  const bool has_gap = is_feasible || grip.reason >= Reason::too_wide;
  out.gap = has_gap ? grip.gap : none;
  for (int k = 0; k < 3; ++k) out.midpoint[k] = has_gap ? grip.midpoint[static_cast<std::size_t>(k)] : none;
  out.thumb_angle = is_feasible ? grip.contact_angles[0] : none;
  out.index_angle = is_feasible ? grip.contact_angles[1] : none;
  copy_points(grip.joints, is_feasible, out.joints);
  copy_points(grip.posed, is_feasible, out.posed);
  copy_points(grip.proxies, is_feasible, out.proxies);
  for (int j = 0; j < WH_JOINTS; ++j) out.separation[j] = is_feasible ? grip.separation[static_cast<std::size_t>(j)] : none;
  out.phalanx_depth = is_feasible ? grip.phalanx_depth : none;
  out.palm_depth = is_feasible ? grip.palm_depth : none;
  out.score = score.score;
  const ScoreTerms& terms = score.terms;
  const double all[6]{terms.fingers, terms.contacts, terms.depth, terms.posture, terms.force, terms.hold};
  for (int k = 0; k < 6; ++k) out.score_terms[k] = all[k];
  return out;
}

}  // namespace

wh_status wh_grip_evaluate(const wh_scene* scene, size_t vessel, const wh_grip* grip, wh_grip_result* result) {
  if (!scene) return fail(WH_ARGUMENT, "wh_grip_evaluate: the scene is null");
  if (vessel >= scene->scene.vessels.size()) return fail(WH_ARGUMENT, "wh_grip_evaluate: the scene has no vessel of this number");
  wh_grip in;
  if (!take_over(grip, in)) return fail(WH_ARGUMENT, "wh_grip_evaluate: the grip is null, or its size is not set");
  if (!is_finite(in)) return fail(WH_INPUT, "wh_grip_evaluate: a number of the grip is not finite");
  return guarded([&] {
    const GripInput asked{in.height, in.azimuth, in.obliquity, in.roll, in.offset, in.hand_scale == 0 ? 1 : in.hand_scale};
    GripResult found;
    scene->core->grip(vessel, asked, found);
    const GripScore score = scene->core->score(vessel, asked, found);
    return give_back(result_of(found, score), result)
               ? WH_OK
               : fail(WH_ARGUMENT, "wh_grip_evaluate: the result is null, or its size is not set");
  });
}

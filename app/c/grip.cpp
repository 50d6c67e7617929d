// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <string>

#include "app/c/scene.h"
#include "app/c/status.h"
#include "sweeps/grips/report.h"

using namespace wholehand;

namespace {

// The grip that a caller asks about, checked.
wh_status take_grip(const ReadyScene& ready, const wh_grip* grip, GripInput& asked, const char* place) noexcept {
  wh_grip in;
  if (const wh_status status = take_over(grip, in, place); status != WH_OK) return status;
  asked = {in.height, in.azimuth, in.obliquity, in.roll, in.offset, in.hand_scale == 0 ? 1 : in.hand_scale};
  return check_grip(ready.allowed, asked, place);
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
  out.is_not_held = score.not_held;
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
  const bool has_wrist = is_feasible && !std::isnan(grip.wrist_share);
  out.wrist_share = has_wrist ? grip.wrist_share : none;
  out.wrist_flexion = has_wrist ? grip.wrist_angles[0] : none;
  out.wrist_deviation = has_wrist ? grip.wrist_angles[1] : none;
  out.wrist_pronation = has_wrist ? grip.wrist_angles[2] : none;
  out.is_beyond_wrist = grip.beyond_wrist;
  return out;
}

// The fields of the state's struct; `hold` if the scene has strengths.
wh_grip_state state_of(const sweeps::GripState& found, const sweeps::StateHold* hold) noexcept {
  wh_grip_state out{};
  out.fill = found.fill;
  out.tilt = found.tilt;
  out.liquid_volume = found.liquid.volume;
  out.liquid_mass = found.liquid.mass;
  out.poured = found.liquid.poured;
  out.mass = found.state.mass;
  for (std::size_t k = 0; k < 3; ++k) out.center_of_mass[k] = found.state.center_of_mass[k];
  out.pivot_length = found.state.pivot_length;
  out.torque = found.state.torque;
  out.exact_torque = found.state.exact_torque;
  out.normal_force = found.state.normal_force;
  out.feedback_force = found.state.feedback_force;
  out.hold_force = found.state.hold_force;
  out.effort = hold ? hold->effort : std::nan("");
  out.effort_low = hold ? hold->low : std::nan("");
  return out;
}

sweeps::GripReport report_of(const ReadyScene& ready, size_t vessel, const GripInput& asked, const sweeps::StateAxes& axes) {
  sweeps::GripReport report =
      sweeps::make_grip_report(ready.scene, vessel, asked, axes, sweeps::core_grip_methods(ready.scene, ready.core, "core"));
  sweeps::add_holding(report, ready.scene, vessel, *ready.core);
  return report;
}

}  // namespace

wh_status wh_grip_evaluate(const wh_scene* scene, size_t vessel, const wh_grip* grip, wh_grip_result* result) {
  if (const wh_status status = check_vessel(scene, vessel, "wh_grip_evaluate"); status != WH_OK) return status;
  GripInput asked;
  if (const wh_status status = take_grip(*scene->ready, grip, asked, "wh_grip_evaluate: the grip"); status != WH_OK) return status;
  if (const wh_status status = check_answer(result, "wh_grip_evaluate: the result"); status != WH_OK) return status;
  return guarded([&] {
    GripResult found;
    const Evaluator& core = *scene->ready->core;
    core.grip(vessel, asked, found);
    give_back(result_of(found, core.score(vessel, asked, found)), result);
    return WH_OK;
  });
}

wh_status wh_grip_hold(const wh_scene* scene, size_t vessel, const wh_grip* grip, double fill, double tilt, wh_grip_state* state) {
  if (const wh_status status = check_vessel(scene, vessel, "wh_grip_hold"); status != WH_OK) return status;
  GripInput asked;
  if (const wh_status status = take_grip(*scene->ready, grip, asked, "wh_grip_hold: the grip"); status != WH_OK) return status;
  if (const wh_status status = check_answer(state, "wh_grip_hold: the state"); status != WH_OK) return status;
  if (!(fill >= 0 && fill <= 1)) return fail(WH_INPUT, "wh_grip_hold: the fill is %g; it must be 0 to 1", fill);
  if (!(tilt >= 0 && tilt <= PI)) return fail(WH_INPUT, "wh_grip_hold: the tilt is %g rad; it must be 0 to pi", tilt);
  return guarded([&] {
    const ReadyScene& ready = *scene->ready;
    if (fill > 0 && !ready.scene.liquid) return fail(WH_INPUT, "wh_grip_hold: the fill is %g, and the scene has no [liquid]", fill);
    const sweeps::GripReport report = report_of(ready, vessel, asked, {{fill}, {tilt}});
    const Reason reason = report.answer.result.reason;
    if (reason != Reason::none)
      return fail(WH_INPUT, "wh_grip_hold: the grip is not feasible (%s)", REASON_NAMES[static_cast<std::size_t>(reason)]);
    give_back(state_of(report.answer.states.at(0), report.holds.empty() ? nullptr : &report.holds[0]), state);
    return WH_OK;
  });
}

wh_status wh_grip_json(const wh_scene* scene, size_t vessel, const wh_grip* grip, char** text) {
  if (const wh_status status = check_vessel(scene, vessel, "wh_grip_json"); status != WH_OK) return status;
  if (!text) return fail(WH_ARGUMENT, "wh_grip_json: the text is null");
  *text = nullptr;
  GripInput asked;
  if (const wh_status status = take_grip(*scene->ready, grip, asked, "wh_grip_json: the grip"); status != WH_OK) return status;
  return guarded([&] {
    const ReadyScene& ready = *scene->ready;
    const std::string json = sweeps::grip_json(report_of(ready, vessel, asked, sweeps::scene_axes(ready.scene, vessel)));
    char* const own = new char[json.size() + 1];
    std::memcpy(own, json.c_str(), json.size() + 1);
    *text = own;
    return WH_OK;
  });
}

void wh_text_free(char** text) {
  if (!text) return;
  delete[] * text;
  *text = nullptr;
}

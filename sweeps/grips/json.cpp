// SPDX-License-Identifier: MIT
// A grip report as JSON. The order of the fields is part of the format.
#include <nlohmann/json.hpp>

#include <cmath>

#include "base/files/json.h"
#include "shaders/layout.h"
#include "sweeps/grips/report.h"

namespace wholehand::sweeps {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json finger_values(const std::array<double, FINGER_COUNT - 1>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(finite_or_null(value));
  return list;
}

Json triples(const std::array<Triple, JOINT_COUNT>& points) {
  Json list = Json::array();
  for (const Triple& point : points) list.push_back(point);
  return list;
}

Json touching(const GripResult& result) {
  Json list = Json::array();
  for (int j = 0; j < JOINT_COUNT; ++j) list.push_back((result.touch_mask >> j & 1) != 0);
  return list;
}

Json projected(const GripResult& result) {
  Json list = Json::array();
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const auto has = [j](std::uint32_t mask) { return (mask >> j & 1) != 0; };
    list.push_back(has(result.tip_mask)      ? Json("tip")
                   : has(result.finger_mask) ? Json("finger")
                   : has(result.inner_mask)  ? Json("inner")
                                             : Json(nullptr));
  }
  return list;
}

Json fingers_used(const GripResult& result) {
  Json list = Json::array();
  for (int f = 0; f < FINGER_COUNT; ++f) {
    if ((result.used_mask >> f & 1) != 0) list.push_back(FINGER_NAMES[f]);
  }
  return list;
}

Json state_json(const GripReport& report, const GripState& s) {
  Json center = nullptr;
  if (report.has_liquid && s.liquid.volume > 0) {
    center = Triple{s.liquid.lean * report.pour[0], s.liquid.height, s.liquid.lean * report.pour[2]};
  }
  Json json;
  json["fill"] = s.fill;
  json["tilt_rad"] = s.tilt;
  json["liquid_volume_m3"] = s.liquid.volume;
  json["liquid_mass_kg"] = s.liquid.mass;
  json["liquid_com_m"] = center;
  json["poured_m3"] = s.liquid.poured;
  json["mass_kg"] = s.state.mass;
  json["com_m"] = s.state.center_of_mass;
  json["pivot_length_m"] = finite_or_null(s.state.pivot_length);
  json["torque_Nm"] = finite_or_null(s.state.torque);
  json["exact_torque_Nm"] = finite_or_null(s.state.exact_torque);
  json["normal_force_N"] = finite_or_null(s.state.normal_force);
  json["feedback_force_N"] = finite_or_null(s.state.feedback_force);
  json["hold_force_N"] = finite_or_null(s.state.hold_force);
  return json;
}

const char* digit_name(int digit) { return digit < FINGER_COUNT ? FINGER_NAMES[static_cast<std::size_t>(digit)] : "palm"; }

void add_state_hold(Json& json, const StateHold& hold) {
  json["effort"] = finite_or_null(hold.effort);
  json["effort_low"] = finite_or_null(hold.low);
  json["tips_effort"] = finite_or_null(hold.tips);
  json["worst_direction"] = hold.escape ? Json(*hold.escape) : Json(nullptr);
  json["contacts"] = Json::array();
  for (const HeldContact& contact : hold.contacts) {
    json["contacts"].push_back({{"digit", digit_name(contact.digit)},
                                {"joint", contact.joint},
                                {"between", contact.between},
                                {"point_m", contact.point},
                                {"normal", contact.normal},
                                {"force_N", contact.force},
                                {"torsion_Nm", contact.torsion}});
  }
}

// Null without an effort.
void add_finger_shares(Json& json, const std::optional<FingerShares>& shares) {
  json["finger_share"] = shares ? finger_values(shares->share) : Json(nullptr);
  json["finger_share_low"] = shares ? finger_values(shares->least) : Json(nullptr);
  json["finger_share_high"] = shares ? finger_values(shares->most) : Json(nullptr);
}

void add_grip_hold(Json& json, const GripHold& hold) {
  json["worst_effort"] = finite_or_null(hold.worst);
  json["worst_effort_fill"] = hold.worst_fill;
  json["worst_effort_tilt_rad"] = hold.worst_tilt;
  json["tips_worst_effort"] = finite_or_null(hold.tips_worst);
  json["push_N"] = hold.push;
  json["friction_needed"] = finite_or_null(hold.friction_needed);
  json["held_margin"] = finite_or_null(held_margin(hold.worst));
}

void add_grip_quality(Json& json, const GripQuality& quality) {
  json["epsilon"] = quality.wrenches.epsilon;
  json["wrench_volume"] = quality.wrenches.volume;
  json["torque_scale_m"] = quality.scale;
  json["torque_center_m"] = quality.center;
}

Json score_terms(const GripReport& report) {
  const ScoreTerms& terms = report.answer.score.terms;
  Json json{{"fingers", terms.fingers}, {"contacts", terms.contacts}, {"depth", terms.depth}, {"posture", terms.posture}};
  if (report.has_tilts) {
    json["force"] = terms.force;
    json["hold"] = terms.hold;
  }
  return json;
}

}  // namespace

std::string grip_json(const GripReport& report) {
  const GripResult& result = report.answer.result;
  const GripInput& grip = report.grip;
  const bool is_feasible = result.reason == Reason::none;
  Json json;
  json["vessel"] = report.vessel;
  json["grip"] = {{"height_m", grip.height}, {"azimuth_rad", grip.azimuth}, {"obliquity_rad", grip.obliquity},
                  {"roll_rad", grip.roll},   {"offset_m", grip.offset},     {"hand_scale", grip.hand_scale}};
  json["feasible"] = is_feasible;
  json["reason"] = REASON_NAMES[static_cast<std::size_t>(result.reason)];
  if (is_feasible) {
    json["plausible"] = result.plausible;
    json["antipodal"] = result.antipodal;
    json["undecided"] = (result.status & STATUS_CONTACT_UNDECIDED) != 0;
    json["contact_angles_rad"] = result.contact_angles;
    json["closure"] = result.closure;
  }
  if (is_feasible || result.reason >= Reason::too_wide) {
    json["gap_m"] = result.gap;
    json["midpoint_m"] = result.midpoint;
  }
  if (is_feasible) {
    json["joints_m"] = triples(result.joints);
    json["posed_m"] = triples(result.posed);
    json["separation_m"] = result.separation;
    json["touching"] = touching(result);
    json["proxies_m"] = triples(result.proxies);
    json["projected"] = projected(result);
    json["fingers_used"] = fingers_used(result);
    json["phalanx_depth_m"] = result.phalanx_depth;
    json["palm_depth_m"] = result.palm_depth;
    json["bone_stretch_m"] = result.bone_stretch;
    json["table_depth_m"] = finite_or_null(result.table_depth);
    json["self_depth_m"] = finite_or_null(result.self_depth);
    json["wrist_share"] = finite_or_null(result.wrist_share);
    if (!std::isnan(result.wrist_share)) {
      json["beyond_wrist"] = result.beyond_wrist;
      json["wrist_rad"] = result.wrist_angles;
    }
    json["states"] = Json::array();
    for (std::size_t k = 0; k < report.answer.states.size(); ++k) {
      json["states"].push_back(state_json(report, report.answer.states[k]));
      if (k >= report.holds.size()) continue;
      add_state_hold(json["states"].back(), report.holds[k]);
      if (report.quality) add_finger_shares(json["states"].back(), report.holds[k].shares);
    }
    if (report.hold) add_grip_hold(json, *report.hold);
    if (report.quality) add_grip_quality(json, *report.quality);
    if (report.hold) json["not_held"] = report.answer.score.not_held;
    json["score"] = report.answer.score.score;
    json["score_terms"] = score_terms(report);
  }
  return json_text(json);
}

}  // namespace wholehand::sweeps

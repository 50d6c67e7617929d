// SPDX-License-Identifier: MIT
// A session's report as JSON. The order of the fields is part of the format.
#include <nlohmann/json.hpp>

#include <cmath>

#include "base/files/json.h"
#include "device/recordings/session_report.h"

namespace wholehand::device {
namespace {

using SessionJson = nlohmann::ordered_json;

SessionJson number_or_null(double value) { return std::isfinite(value) ? SessionJson(value) : SessionJson(nullptr); }

SessionJson mean_json(const MeanDeviation& value) {
  return {{"mean", number_or_null(value.mean)}, {"deviation", number_or_null(value.deviation)}, {"count", value.count}};
}

SessionJson percentiles_json(const Percentiles& value) {
  return {{"p50", number_or_null(value.p50)},
          {"p99", number_or_null(value.p99)},
          {"p999", number_or_null(value.p999)},
          {"max", number_or_null(value.max)}};
}

SessionJson course_json(GripCourse course) {
  return course == GripCourse::not_analyzed ? SessionJson(nullptr)
                                            : SessionJson(GRIP_COURSE_NAMES[static_cast<std::size_t>(course)]);
}

SessionJson slip_json(const SlipReport& slip) {
  if (!slip.is_measured()) return nullptr;
  return {{"slips", static_cast<int>(slip.slips)},
          {"distance_m", slip.distance},
          {"turned_rad", slip.turned},
          {"below_hold_s", slip.below_hold},
          {"least_margin_N", number_or_null(slip.least_margin)}};
}

SessionJson grasp_json(const SessionReport& report, const GraspReport& grasp) {
  SessionJson json;
  json["vessel"] = report.info.vessels[static_cast<std::size_t>(grasp.vessel)].name;
  json["start_s"] = grasp.start;
  json["end_s"] = grasp.end;
  json["duration_s"] = {{"lift", grasp.duration[0]}, {"tilt", grasp.duration[1]}, {"maintain", grasp.duration[2]}};
  json["response_time_s"] = number_or_null(grasp.response_time);
  json["grip_stopped_N"] = number_or_null(grasp.tightened);
  json["grip_before_N"] = mean_json(grasp.before);
  json["grip_during_N"] = mean_json(grasp.during);
  json["grip_after_N"] = mean_json(grasp.after);
  json["largest_tilt_rad"] = number_or_null(grasp.largest_tilt);
  json["tilt_start_s"] = number_or_null(grasp.tilt_start);
  json["tilt_time_s"] = number_or_null(grasp.tilt_time);
  json["normal_increase_N"] = number_or_null(grasp.normal_increase);
  json["grip_change_N"] = number_or_null(grasp.grip_change);
  json["turning_back_N"] = number_or_null(grasp.turning_back);
  json["saturated_s"] = grasp.saturated;
  json["slip"] = slip_json(grasp.slip);
  json["type"] = course_json(grasp.course);
  json["outcome"] = GRASP_OUTCOME_NAMES[static_cast<std::size_t>(grasp.outcome)];
  json["guidance_distance_m"] = number_or_null(grasp.guidance_distance);
  json["poured_m3"] = number_or_null(grasp.poured);
  json["arrived_m3"] = number_or_null(grasp.arrived);
  json["spilled_m3"] = number_or_null(grasp.spilled);
  return json;
}

SessionJson summary_json(const GraspSummary& summary) {
  SessionJson json;
  json["vessel"] = summary.name;
  json["grasps"] = summary.grasps;
  json["lost"] = summary.lost;
  for (std::size_t k = 1; k < summary.courses.size(); ++k) json["types"][GRIP_COURSE_NAMES[k]] = summary.courses[k];
  json["not_analyzed"] = summary.courses[0];
  json["response_time_s"] = mean_json(summary.response_time);
  json["grip_stopped_N"] = mean_json(summary.tightened);
  json["grip_before_N"] = mean_json(summary.before);
  json["grip_during_N"] = mean_json(summary.during);
  json["grip_after_N"] = mean_json(summary.after);
  json["normal_increase_N"] = mean_json(summary.normal_increase);
  json["grip_change_N"] = mean_json(summary.grip_change);
  json["tilt_time_s"] = mean_json(summary.tilt_time);
  return json;
}

SessionJson scatter_json(const GripScatter& scatter) {
  if (!scatter.is_enough()) return nullptr;
  SessionJson json{{"grasps", scatter.grasps()}, {"vessels", scatter.vessels()}, {"degrees_of_freedom", scatter.freedom()}};
  const auto deviations = scatter.deviations();
  for (std::size_t k = 0; k < deviations.size(); ++k)
    json[SCATTER_KEYS[k].name_si] = {{"deviation", number_or_null(deviations[k].value)},
                                     {"low", number_or_null(deviations[k].interval.low)},
                                     {"high", number_or_null(deviations[k].interval.high)}};
  return json;
}

SessionJson amount_json(const PouredAmount& amount) {
  return {{"liquid", amount.liquid},
          {"wanted_m3", number_or_null(amount.wanted)},
          {"arrived_m3", number_or_null(amount.arrived)},
          {"spilled_m3", number_or_null(amount.spilled)},
          {"within_tolerance", amount.is_within}};
}

}  // namespace

std::string session_json(const SessionReport& report) {
  SessionJson json;
  json["scene"] = report.info.scene_name;
  json["scene_file"] = report.info.scene_file;
  json["device"] = report.info.device.name;
  json["version"] = report.info.version;
  json["start"] = report.info.start;
  json["rate_Hz"] = report.info.rate;
  json["force_base_N"] = number_or_null(report.info.force_base);
  json["note"] = report.note.empty() ? SessionJson(nullptr) : SessionJson(report.note);
  json["duration_s"] = report.duration;
  json["fault"] = FAULT_NAMES[static_cast<std::size_t>(report.fault)];
  for (std::size_t k = 0; k < report.time_in_state.size(); ++k)
    json["time_in_state_s"][SESSION_STATE_NAMES[k]] = report.time_in_state[k];
  json["lost"] = report.lost;
  json["destinations"] = report.destinations;
  json["task_done"] = report.task_done;
  json["grasps"] = SessionJson::array();
  for (const GraspReport& grasp : report.grasps) json["grasps"].push_back(grasp_json(report, grasp));
  json["vessels"] = SessionJson::array();
  for (const GraspSummary& summary : report.vessels) json["vessels"].push_back(summary_json(summary));
  json["scatter"] = scatter_json(report.scatter);
  json["amounts"] = SessionJson::array();
  for (const PouredAmount& amount : report.amounts) json["amounts"].push_back(amount_json(amount));
  json["has_clock"] = report.info.has_clock;
  json["timing_s"] = nullptr;
  if (report.info.has_clock)
    json["timing_s"] = {{"period", percentiles_json(report.period)},
                        {"step", percentiles_json(report.step)},
                        {"latency", percentiles_json(report.latency)}};
  json["ticks"] = report.ticks;
  json["missed_periods"] = report.missed;
  return json_text(json);
}

}  // namespace wholehand::device

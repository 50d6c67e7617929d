// SPDX-License-Identifier: MIT
// What `wholehand check` found, as text and as JSON. The order of the JSON's keys is part of its format.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/readable.h"
#include "evidence/check/check.h"

namespace wholehand {
namespace {

using CheckJson = nlohmann::ordered_json;

// As the options of `grip`; a state of the liquid as its fill and tilt.
std::string place_text(const CheckedQuantity& quantity) {
  if (quantity.state)
    return fmt::format("{}, fill {:g}, tilt {:g} deg", quantity.vessel, (*quantity.state)[0], degrees((*quantity.state)[1]));
  if (!quantity.grip) return "-";
  const GripInput& grip = *quantity.grip;
  std::string place = fmt::format("{} --height-mm {:.9g}", quantity.vessel, grip.height * 1e3);
  const auto add = [&place](const char* option, double value, double usual) {
    if (value != usual) place += fmt::format(" {} {:.9g}", option, value);
  };
  add("--azimuth-deg", degrees(grip.azimuth), 0);
  add("--obliquity-deg", degrees(grip.obliquity), 0);
  add("--roll-deg", degrees(grip.roll), 0);
  add("--offset-mm", grip.offset * 1e3, 0);
  add("--hand-scale", grip.hand_scale, 1);
  return place;
}

std::string pair_text(const CheckedPair& pair) {
  std::string text = fmt::format("\n{}: {}\n", pair.question, pair.holds ? "holds" : "DOES NOT HOLD");
  text += fmt::format("  {:<11} {:<18} {:>12} {:>12} {:<6} {:>9} {:>9} {:>8}  {}\n", "kernel", "quantity", "worst", "tolerance", "",
                      "ratio", "compared", "outside", "worst at");
  for (const CheckedQuantity& quantity : pair.quantities) {
    const Comparison& row = quantity.row;
    text += fmt::format("  {:<11} {:<18} {:>12.4g} {:>12.4g} {:<6} {:>9.3f} {:>9} {:>8}  {}\n", row.kernel, row.quantity, row.worst,
                        row.tolerance, row.unit, row.worst_ratio, readable_number(row.compared), readable_number(row.outside),
                        place_text(quantity));
  }
  return text + fmt::format(
                    "  {}; {} the glass and {} left out; in {} a discrete outcome differs within the margin; at most "
                    "{} may differ: a true share of 1 in 1,000 exceeds this number once in 1,000,000 checks\n",
                    counted(pair.grips, "grip"), counted(pair.grazing, "grazes", "graze"), pair.grazing == 1 ? "is" : "are",
                    readable_number(pair.excluded), readable_number(pair.allowed));
}

CheckJson finite_or_null(double value) { return std::isfinite(value) ? CheckJson(value) : CheckJson(nullptr); }

CheckJson place_json(const CheckedQuantity& quantity) {
  if (quantity.state) return {{"vessel", quantity.vessel}, {"fill", (*quantity.state)[0]}, {"tilt_rad", (*quantity.state)[1]}};
  if (!quantity.grip) return nullptr;
  const GripInput& grip = *quantity.grip;
  return {{"vessel", quantity.vessel}, {"height_m", grip.height}, {"azimuth_rad", grip.azimuth},  {"obliquity_rad", grip.obliquity},
          {"roll_rad", grip.roll},     {"offset_m", grip.offset}, {"hand_scale", grip.hand_scale}};
}

CheckJson quantity_json(const CheckedQuantity& quantity, const CheckedPair& pair) {
  const Comparison& row = quantity.row;
  // numbers leave out grips that graze or whose outcome differs; a row of the liquid counts states
  const bool counts_grips = row.kernel != "liquid";
  return {{"kernel", row.kernel},
          {"quantity", row.quantity},
          {"holds", row.outside == 0},
          {"compared", row.compared},
          {"excluded", counts_grips && row.compared > 0 ? pair.grips - row.compared : 0},
          {"outside", row.outside},
          {"worst", finite_or_null(row.worst)},
          {"tolerance", finite_or_null(row.tolerance)},
          {"worst_of_its_tolerance", finite_or_null(row.worst_ratio)},
          {"unit", row.unit},
          {"where", place_json(quantity)}};
}

CheckJson pair_json(const CheckedPair& pair) {
  CheckJson json{{"name", pair.name},       {"holds", pair.holds},       {"grips", pair.grips},    {"feasible", pair.feasible},
                 {"grazing", pair.grazing}, {"excluded", pair.excluded}, {"allowed", pair.allowed}};
  json["quantities"] = CheckJson::array();
  for (const CheckedQuantity& quantity : pair.quantities) json["quantities"].push_back(quantity_json(quantity, pair));
  return json;
}

}  // namespace

std::string check_text(const CheckReport& report) {
  const CheckVerdict verdict = verdict_of(report);
  std::string text = fmt::format("{}: {}{}{}\n", verdict.holds ? "holds" : "DOES NOT HOLD", verdict.text,
                                 verdict.advice.empty() ? "" : "; ", verdict.advice);
  text += fmt::format("\n{} on {} ({}){}; the check compares every number of these grips that a device computes:\n",
                      report.scene.empty() ? "check" : report.scene, report.device, report.driver,
                      report.is_cpu ? ", a CPU driver" : "");
  text += report.contracted.empty()
              ? "  the driver rounds products before it adds them, as the kernels ask (NoContraction)\n"
              : fmt::format("  the driver does NOT round products before it adds them, as the kernels ask (NoContraction), in {}\n",
                            fmt::join(report.contracted, " and "));
  for (const CheckedVessel& vessel : report.vessels) {
    text += fmt::format(
        "  {}: {} of the scene{}\n", vessel.name, counted(vessel.own, "grip"),
        vessel.between == 0 ? "" : fmt::format(" and {} more between and around them", readable_number(vessel.between)));
  }
  text += pair_text(report.translation) + pair_text(report.cost);
  return text +
         (report.exact ? pair_text(*report.exact) : "\nthe device has no double precision: the third comparison is left out\n");
}

std::string check_json(const CheckReport& report) {
  const CheckVerdict verdict = verdict_of(report);
  CheckJson json{{"holds", verdict.holds},
                 {"verdict", verdict.text},
                 {"advice", verdict.advice.empty() ? CheckJson(nullptr) : CheckJson(verdict.advice)},
                 {"scene", report.scene},
                 {"device", report.device},
                 {"driver", report.driver},
                 {"is_cpu_driver", report.is_cpu},
                 {"precisions", report.has_double ? CheckJson::array({"float", "double"}) : CheckJson::array({"float"})},
                 {"contracted", report.contracted},
                 {"warnings", report.warnings}};
  json["vessels"] = CheckJson::array();
  for (const CheckedVessel& vessel : report.vessels)
    json["vessels"].push_back({{"name", vessel.name}, {"scene_grips", vessel.own}, {"grips_between", vessel.between}});
  json["comparisons"] = CheckJson::array({pair_json(report.translation), pair_json(report.cost)});
  if (report.exact) json["comparisons"].push_back(pair_json(*report.exact));
  return json_text(json) + "\n";
}

}  // namespace wholehand

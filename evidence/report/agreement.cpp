// SPDX-License-Identifier: MIT
#include "evidence/report/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "base/charts/axes.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "evidence/report/grips.h"
#include "shaders/layout.h"

namespace wholehand {
namespace {

// Bits of the status that the file has a variable for.
struct StatusPart {
  const char* variable;
  std::uint32_t mask;
  int shift;
};
constexpr const char* MILLIONTHS = "1e-6";  // the unit of quantities without one
constexpr StatusPart STATUS_PARTS[] = {
    {"reason", STATUS_REASON_MASK, 0},
    {"plausible", STATUS_PLAUSIBLE, 4},
    {"antipodal", STATUS_ANTIPODAL, 5},
    {"grazing", STATUS_GRAZING, 6},
    {"proxy_unsettled", STATUS_PROXY_UNSETTLED, 7},
    {"blocked_mask", 0x1Fu << STATUS_BLOCKED_SHIFT, STATUS_BLOCKED_SHIFT},
    {"through_table", STATUS_THROUGH_TABLE, 13},
    {"self_overlap", STATUS_SELF_OVERLAP, 14},
    {"unsettled_mask", 0x1Fu << STATUS_UNSETTLED_SHIFT, STATUS_UNSETTLED_SHIFT},
    {"not_held", STATUS_NOT_HELD, 22},
    {"beyond_wrist", STATUS_BEYOND_WRIST, 23},
};
// Variables that are a field's own word.
constexpr const char* WORD_VARIABLES[] = {"used_mask", "touch_mask", "projected_tip_mask", "projected_finger_mask",
                                          "projected_inner_mask"};

// One vessel as a scene of its own, so that the comparison prepares only that vessel.
Scene scene_of_vessel(const Scene& scene, std::size_t vessel) {
  Scene one = scene;
  one.vessels = {scene.vessels[vessel]};
  return one;
}

// Real fields that the file has as variables. Reported tilts can be judged only if the file has the forces of all states.
std::vector<int> fields_of_file(const sweeps::SweepResult& result, const Scene& scene) {
  const bool has_states =
      result.find("feedback_force") && result.find("normal_force") && (has_effort(scene) || result.find("hold_force"));
  std::set<int> fields;
  for (const sweeps::Variable* variable : result.variables()) {
    const bool is_reported_tilt = variable->field == FIELD_PEAK_TILT || variable->field == FIELD_SAFE_TILT;
    if (variable->type == sweeps::NumberType::real && (has_states || !is_reported_tilt)) fields.insert(variable->field);
  }
  std::vector<int> all(fields.begin(), fields.end());
  all.insert(all.end(), {FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_TIP_MASK, FIELD_FINGER_MASK, FIELD_INNER_MASK, FIELD_USED_MASK});
  return all;
}

// The sample, and every grip that the page lists of the vessel; each once.
std::vector<std::uint64_t> compared_places(const ReportSource& source, std::size_t vessel) {
  const std::vector<std::uint64_t> sample = sample_places(source.plan.stored_grips(), SAMPLED_GRIPS);
  std::set<std::uint64_t> places(sample.begin(), sample.end());
  const std::size_t scales = source.plan.hand_scales();
  for (std::size_t scale = 0; scale < scales; ++scale) {
    std::vector<std::uint64_t> listed;
    if (source.lists) {
      for (const sweeps::RankedCandidate& ranked : (*source.lists)[vessel * scales + scale])
        listed.push_back(ranked.candidate.index);
    } else {
      for (const Candidate& candidate : source.result.best(vessel, scale)) listed.push_back(candidate.index);
    }
    listed.resize(std::min(listed.size(), TABLED_GRIPS));
    places.insert(listed.begin(), listed.end());
  }
  return {places.begin(), places.end()};
}

// The core's planes with everything in its place that the file holds. `outcomes`: names of the discrete ones among that.
GatheredPlanes planes_of_file(const ReportSource& source, std::size_t vessel, const std::vector<std::uint64_t>& places,
                              const GatheredPlanes& core, std::vector<std::string>& outcomes) {
  GatheredPlanes planes = core;
  planes.reals.resize(planes.fields.real_kept * places.size());  // what is not held is not compared
  const sweeps::SweepResult& result = source.result;
  const std::size_t n = places.size();
  for (const sweeps::Variable* variable : result.variables()) {
    if (variable->type != sweeps::NumberType::real || !sweeps::is_kept(core.fields, variable->field)) continue;
    for (std::size_t p = 0; p < sweeps::variable_planes(*variable, source.scene); ++p) {
      const std::vector<double> values = result.pick(*variable, vessel, p, places);
      const std::size_t plane = static_cast<std::size_t>(core.fields.plane[variable->field] + variable->plane) + p;
      std::copy(values.begin(), values.end(), planes.reals.begin() + static_cast<std::ptrdiff_t>(plane * n));
    }
  }
  const auto put = [&](const char* name, int field, std::uint32_t mask, int shift) {
    const sweeps::Variable* variable = result.find(name);
    if (!variable) return;
    outcomes.push_back(name);
    const std::vector<double> values = result.pick(*variable, vessel, 0, places);
    for (std::size_t i = 0; i < n; ++i) {
      std::uint32_t& word = planes.uints[core.fields.plane[field] * n + i];
      const auto bits = static_cast<std::uint32_t>(std::max(0.0, values[i]));  // missing: 0
      word = (word & ~mask) | (bits << shift & mask);
    }
  };
  for (const StatusPart& part : STATUS_PARTS) put(part.variable, FIELD_STATUS, part.mask, part.shift);
  for (const char* name : WORD_VARIABLES)
    if (const sweeps::Variable* variable = result.find(name)) put(name, variable->field, ~0u, 0);
  return planes;
}

// Three figures, without an exponent where that is readable.
std::string three_figures(double value) { return value >= 100 && value < 1e6 ? fixed_text(value, 0) : plain_text(value, 3); }

std::string unit_for_people(const std::string& unit) {
  if (unit == MILLIONTHS) return "10⁻⁶";
  return unit.starts_with("u") ? "µ" + unit.substr(1) : unit;
}

std::string difference_text(const Comparison& row) {
  return row.unit == MILLIONTHS ? power_text(1e-6 * row.worst) : three_figures(row.worst) + " " + unit_for_people(row.unit);
}

// The first three that exist of those that people ask for most.
std::string largest_differences(const Agreement& agreement) {
  std::vector<std::string> parts;
  for (const std::string_view wanted : {"gap", "score", "peak feedback", "largest hold"}) {
    for (const Comparison& row : agreement.rows)
      if (row.quantity == wanted) parts.push_back(row.quantity + " " + difference_text(row));
  }
  return joined(parts, ", ");
}

// Whether the core computed the sweep, and is thus compared with itself.
bool is_of_core(const ReportSource& source) { return source.result.origin().backend == "core"; }

std::string agreement_text(const ReportSource& source, const Agreement& agreement) {
  const bool is_all = agreement.grips == source.plan.stored_grips();
  const std::string stored = counted(source.plan.stored_grips(), "grip");
  std::string text =
      is_all ? fmt::format("The core computed {}{} again in double precision", agreement.grips == 1 ? "the only " : "all ",
                           agreement.grips == 1 ? "grip" : stored)
             : fmt::format("The core computed {} of {} again in double precision", readable_number(agreement.grips), stored);
  text += fmt::format("; {} feasible. ", counted(agreement.feasible, "of them is", "of them are"));
  if (agreement.holds()) {
    text += is_of_core(source)
                ? "The file holds these numbers. The core computed them for the sweep, too: no device was compared with it; "
                  "`wholehand check` does that."
            : agreement.rows.empty() ? "They agree."
                                     : "Every number agrees within its tolerance.";
  } else {
    text += fmt::format("{} and {} do NOT agree.", counted(agreement.outside, "number"),
                        counted(agreement.flipped, "discrete outcome"));
  }
  if (const std::string largest = largest_differences(agreement); !largest.empty())
    text += fmt::format(" Largest differences: {}.", largest);
  if (!agreement.outcomes.empty()) {
    const std::uint64_t compared = agreement.grips - agreement.grazing, equal = compared - agreement.flipped - agreement.excluded;
    text += fmt::format(" Reasons, flags and masks are equal in {} of {}", readable_number(equal), counted(compared, "grip"));
    text += agreement.excluded > 0 ? fmt::format("; in {} they differ within the margin, and in {} they may.",
                                                 readable_number(agreement.excluded), readable_number(agreement.allowed))
                                   : ".";
  }
  if (agreement.grazing > 0)
    text +=
        fmt::format(" {} left out.", counted(agreement.grazing, "grip grazes the glass and is", "grips graze the glass and are"));
  return text;
}

}  // namespace

Agreement compare_with_core(const ReportSource& source, std::size_t vessel) {
  const Scene scene = scene_of_vessel(source.scene, vessel);
  const auto core = make_core_evaluator(scene);
  const std::vector<std::uint64_t> places = compared_places(source, vessel);
  std::vector<GripInput> grips;
  for (const std::uint64_t place : places) grips.push_back(stored_grip(source.plan, source.scene, vessel, place));
  const FieldSet fields = make_field_set(fields_of_file(source.result, scene), scene);
  const GatheredPlanes by_core = gather(*core, fields, 0, grips);
  Agreement agreement;
  const GatheredPlanes of_file = planes_of_file(source, vessel, places, by_core, agreement.outcomes);
  Comparer comparer(scene, *core, allowance(source.result.origin().precision));
  comparer.add(0, grips, of_file, by_core, by_core);
  for (const Comparison& row : comparer.rows()) {
    if (row.kernel == "whole") {
      agreement.flipped = row.outside;
    } else if (row.compared > 0) {
      agreement.rows.push_back(row);
      agreement.outside += row.outside;
    }
  }
  for (const sweeps::Variable* variable : source.result.variables()) {
    // a tilt has no row of its own: if all states are kept, the forces at it are compared
    const bool is_tilt = variable->field == FIELD_PEAK_TILT || variable->field == FIELD_SAFE_TILT;
    const bool is_real = variable->type == sweeps::NumberType::real && sweeps::is_kept(fields, variable->field) &&
                         (is_tilt || is_compared_by_number(scene, field_row(variable->field)));
    if (!is_real && std::find(agreement.outcomes.begin(), agreement.outcomes.end(), variable->name) == agreement.outcomes.end())
      agreement.uncompared.emplace_back(variable->name);
  }
  agreement.grips = comparer.grips();
  agreement.feasible = comparer.feasible();
  agreement.grazing = comparer.grazing();
  agreement.excluded = comparer.excluded();
  agreement.allowed = comparer.allowed();
  return agreement;
}

void write_agreement(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id) {
  html.element("h3", "Agreement with the core", {{"id", id + "-agreement"}});
  if (!source.core || source.result.variables().empty()) {
    html.element("p", source.core ? "The file holds only the best grips, so there is nothing to compare."
                                  : fmt::format("This part is left out: {}.", source.no_core));
    return;
  }
  const Agreement agreement = compare_with_core(source, vessel);
  html.element("p", agreement_text(source, agreement),
               {{"class", !agreement.holds()   ? "bad"
                          : is_of_core(source) ? "note"
                                               : "good"}});
  html.open("details").element("summary", "Each quantity");
  HtmlTable table(html, fmt::format("{}: the file compared with the core, on the grips above", source.scene.vessels[vessel].name),
                  {"quantity", "unit", "largest difference", "tolerance there", "grips", "beyond"}, {1});
  for (const Comparison& row : agreement.rows)
    table.row({row.quantity, unit_for_people(row.unit), three_figures(row.worst), three_figures(row.tolerance),
               readable_number(row.compared), readable_number(row.outside)});
  table.end();
  std::string note =
      "The tolerance covers rounding and the stop tolerance. A difference beyond these adds twice the change of the core's own "
      "answer when the grip moves by as much as the sweep's precision leaves open. The table shows the tolerance of the grip with "
      "the largest difference.";
  if (!agreement.uncompared.empty()) note += fmt::format(" These are not compared: {}.", joined(agreement.uncompared, ", "));
  html.element("p", note, {{"class", "note"}}).close();
}

}  // namespace wholehand

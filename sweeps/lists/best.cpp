// SPDX-License-Identifier: MIT
#include "sweeps/lists/best.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/files/csv.h"
#include "base/numbers/nearest.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/counted_tilts.h"
#include "core/load.h"
#include "shaders/layout.h"
#include "sweeps/grips/report.h"
#include "sweeps/plan/variables.h"

namespace wholehand::sweeps {
namespace {

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();

void read_best(const PlaneChunk& chunk, const FieldSet& fields, std::size_t i, const Scene& scene,
               const std::vector<double>& last_tilts, BestGrip& best) {
  const auto real = [&](int field, int plane = 0) { return chunk.real(fields.plane[field] + plane, i); };
  best.score = real(FIELD_SCORE);
  for (int term = 0; term < 6; ++term) best.terms[term] = real(FIELD_TERMS, term);
  best.closure = real(FIELD_CLOSURE);
  best.gap = real(FIELD_GAP);
  best.phalanx_depth = real(FIELD_PHALANX_DEPTH);
  best.palm_depth = real(FIELD_PALM_DEPTH);
  if (scene.arm) best.wrist_share = real(FIELD_WRIST_SHARE);
  best.fingers_used = std::popcount(chunk.uint(fields.plane[FIELD_USED_MASK], i));
  best.antipodal = (chunk.uint(fields.plane[FIELD_STATUS], i) & STATUS_ANTIPODAL) != 0;
  best.points_touching = std::popcount(chunk.uint(fields.plane[FIELD_TOUCH_MASK], i));
  set_worst(best, scene, last_tilts, real);
}

// Empty where there is no number.
std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{:.9g}", value); }

// A column of the table.
struct Column {
  // When a narrow table has the column: always, or where there is room; columns of earlier enumerators stay longest.
  enum Place { always, effort, held_share, safe_tilt, fingers, gap, wide_only };

  std::string title;
  std::string (*cell)(const BestGrip& best);
  Place place = wide_only;
};

constexpr std::size_t MOST_COLUMNS = 10, MOST_LETTERS = 99;  // of a table that is not wide

// Leaves those for which there is room beside `head`, which has some columns itself.
void narrow(std::vector<Column>& columns, const std::string& head, std::size_t in_head) {
  std::erase_if(columns, [](const Column& column) { return column.place == Column::wide_only; });
  const auto is_too_wide = [&] {
    std::size_t letters = head.size();
    for (const Column& column : columns) letters += 2 + column.title.size();
    return columns.size() + in_head > MOST_COLUMNS || letters > MOST_LETTERS;
  };
  while (is_too_wide()) {
    const auto last =
        std::max_element(columns.begin(), columns.end(), [](const Column& a, const Column& b) { return a.place < b.place; });
    if (last->place == Column::always) return;
    columns.erase(last);
  }
}

}  // namespace

std::vector<int> best_fields(const Scene& scene) {
  std::vector<int> fields{FIELD_GAP, FIELD_CLOSURE, FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH};
  if (scene.arm) fields.push_back(FIELD_WRIST_SHARE);
  if (!scene.tilts.empty()) fields.insert(fields.end(), {FIELD_PEAK_FORCE, FIELD_PEAK_TILT, FIELD_SAFE_TILT});
  if (has_effort(scene)) {
    fields.insert(fields.end(), {FIELD_WORST_EFFORT, FIELD_WORST_EFFORT_FILL, FIELD_WORST_EFFORT_TILT, FIELD_TIPS_WORST_EFFORT,
                                 FIELD_PUSH, FIELD_FRICTION_NEEDED});
  } else if (!scene.tilts.empty()) {
    fields.push_back(FIELD_LARGEST_HOLD);
  }
  fields.insert(fields.end(), {FIELD_SCORE, FIELD_TERMS, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_USED_MASK});
  return fields;
}

void set_worst(BestGrip& best, const Scene& scene, const std::vector<double>& last_tilts,
               const std::function<double(int field, int fill)>& value) {
  best.peak_force = best.peak_tilt = best.largest_hold = best.safe_tilt = NOT_A_NUMBER;
  if (scene.tilts.empty()) return;
  best.peak_force = best.largest_hold = -1;
  best.safe_tilt = std::numeric_limits<double>::infinity();
  best.is_safe_to_end = true;
  for (int fill = 0; fill < static_cast<int>(scene_fills(scene)); ++fill) {
    if (value(FIELD_PEAK_FORCE, fill) > best.peak_force) {
      best.peak_force = value(FIELD_PEAK_FORCE, fill);
      best.peak_tilt = nearest_value(scene.tilts, value(FIELD_PEAK_TILT, fill));
    }
    if (!has_effort(scene)) best.largest_hold = std::max(best.largest_hold, value(FIELD_LARGEST_HOLD, fill));
    const double safe = nearest_value(scene.tilts, value(FIELD_SAFE_TILT, fill));
    if (std::isnan(safe) || safe < best.safe_tilt) best.safe_tilt = safe;
    best.is_safe_to_end = best.is_safe_to_end && safe >= last_tilts.at(static_cast<std::size_t>(fill));
  }
  if (!has_effort(scene)) return;
  best.efforts = {value(FIELD_WORST_EFFORT, 0),
                  value(FIELD_WORST_EFFORT_FILL, 0),
                  nearest_value(scene.tilts, value(FIELD_WORST_EFFORT_TILT, 0)),
                  value(FIELD_TIPS_WORST_EFFORT, 0),
                  value(FIELD_PUSH, 0),
                  value(FIELD_FRICTION_NEEDED, 0)};
  const core_f64::HandStrength hand = core_f64::load_strength(scene, best.gap, scene.hand.scale * best.grip.hand_scale);
  best.largest_hold = best.efforts.tips_worst * hand.weaker_tip();
}

void evaluate_best(Backend& backend, const Scene& scene, std::size_t vessel, std::vector<BestGrip>& grips) {
  if (grips.empty()) return;
  const std::vector<double> last = last_tilts(scene, vessel);
  RunRequest request;
  request.vessel = vessel;
  request.last = grips.size();
  request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = grips[first + i].grip;
  };
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i) {
      BestGrip& grip = grips[chunk.first + i];
      read_best(chunk, backend.fields(), i, scene, last, grip);
      grip.rank = chunk.first + i + 1;
    }
  };
  const RunResult result = backend.run(request);
  if (result.done != grips.size())
    throw failure_error(fmt::format("{}: evaluated {} of the {} best grips", backend.info().device, result.done, grips.size()));
}

std::vector<BestGrip> evaluate_best(Backend& backend, const Scene& scene, const Plan& plan, std::size_t vessel,
                                    const std::vector<Candidate>& candidates) {
  std::vector<BestGrip> best;
  for (const Candidate& candidate : candidates) best.push_back(bare_grip(plan, vessel, candidate));
  evaluate_best(backend, scene, vessel, best);
  return best;
}

BestGrip bare_grip(const Plan& plan, std::size_t vessel, const Candidate& candidate) {
  BestGrip grip;
  grip.candidate = candidate;
  grip.grip = plan.grip(vessel, candidate.index);
  return grip;
}

std::string best_csv_head(const Scene& scene) {
  std::string csv(BEST_CSV_START);
  csv +=
      "azimuth_deg,obliquity_deg,roll_deg,offset_mm,hand_scale,score,score_fingers,score_contacts,score_"
      "depth,"
      "score_posture,score_force,score_hold,closure,gap_mm,fingers_used,points_touching,phalanx_depth_mm,palm_depth_mm,"
      "peak_feedback_force_N,peak_feedback_tilt_deg,largest_hold_force_N,largest_safe_tilt_deg,antipodal,"
      "worst_effort,worst_effort_fill,worst_effort_tilt_deg,tips_worst_effort,push_N,friction_needed,held_margin,not_held,"
      "refined_score,refined_height_mm,refined_azimuth_deg,refined_obliquity_deg,refined_roll_deg,refined_offset_mm,";
  if (scene.robust) csv += "robust_mean,robust_low,robust_share,";
  if (scene.arm) csv += "wrist_share,";
  return csv + "grip,result,sweep\n";
}

std::string best_csv_row(const Scene& scene, const std::string& vessel, const BestGrip& best, const ListOrigin& origin) {
  const GripInput& grip = best.grip;
  std::vector<double> numbers{grip.height * 1e3,  degrees(grip.azimuth), degrees(grip.obliquity),
                              degrees(grip.roll), grip.offset * 1e3,     grip.hand_scale,
                              best.score};
  for (std::size_t term = 0; term < best.terms.size(); ++term) {
    const bool absent = term >= 4 && scene.tilts.empty();  // force and hold
    numbers.push_back(absent ? std::nan("") : best.terms[term]);
  }
  numbers.insert(numbers.end(),
                 {best.closure, best.gap * 1e3, static_cast<double>(best.fingers_used), static_cast<double>(best.points_touching),
                  best.phalanx_depth * 1e3, best.palm_depth * 1e3, best.peak_force, degrees(best.peak_tilt), best.largest_hold,
                  degrees(best.safe_tilt), best.antipodal ? 1.0 : 0.0});
  const GripEfforts& efforts = best.efforts;
  const double not_held = std::isnan(efforts.worst) ? NOT_A_NUMBER : efforts.worst > 1 ? 1 : 0;
  numbers.insert(numbers.end(), {efforts.worst, efforts.fill, degrees(efforts.tilt), efforts.tips_worst, efforts.push,
                                 efforts.friction_needed, held_margin(efforts.worst), not_held});
  const GripInput& refined = best.refined;
  const bool is_refined = !std::isnan(best.refined_score);
  for (const double number : {best.refined_score, refined.height * 1e3, degrees(refined.azimuth), degrees(refined.obliquity),
                              degrees(refined.roll), refined.offset * 1e3})
    numbers.push_back(is_refined ? number : NOT_A_NUMBER);
  if (scene.robust) numbers.insert(numbers.end(), {best.robust.mean, best.robust.low, best.robust.share});
  if (scene.arm) numbers.push_back(best.wrist_share);
  std::string row = fmt::format("{},{}", csv_text(vessel), best.rank);
  for (const double number : numbers) row += "," + csv_number(number);
  return row + fmt::format(",{},{},{}\n", best.candidate.index, csv_text(origin.result), origin.sweep);
}

std::string best_csv(const Scene& scene, const Plan& plan, const std::vector<std::vector<BestGrip>>& lists,
                     const ListOrigin& origin) {
  std::string csv = best_csv_head(scene);
  for (std::size_t list = 0; list < lists.size(); ++list)
    for (const BestGrip& best : lists[list])
      csv += best_csv_row(scene, scene.vessels[list / plan.hand_scales()].name, best, origin);
  return csv;
}

RankBy usual_order(const Scene& scene) { return scene.robust ? RankBy::robust : RankBy::score; }

std::string best_table(const Scene& scene, const Plan& plan, const std::vector<BestGrip>& best, const ListView& view) {
  const bool is_robust = view.by == RankBy::robust;
  const auto if_so = [](bool is_so, Column::Place place = Column::always) { return is_so ? place : Column::wide_only; };
  std::vector<Column> columns{{"score", [](const BestGrip& b) { return fixed_text(b.score, 3); }, if_so(!is_robust)}};
  if (std::any_of(best.begin(), best.end(), [](const BestGrip& b) { return !std::isnan(b.refined_score); }))
    columns.push_back({"refined", [](const BestGrip& b) { return fixed_text(b.refined_score, 3); }});
  if (scene.robust) {
    columns.push_back({"robust", [](const BestGrip& b) { return fixed_text(b.robust.low, 3); }, if_so(is_robust)});
    columns.push_back({"mean", [](const BestGrip& b) { return fixed_text(b.robust.mean, 3); }});
    columns.push_back(
        {"holds %", [](const BestGrip& b) { return held_percent(b.robust.share); }, if_so(is_robust, Column::held_share)});
  }
  const auto axis = [&](int place, const char* title, std::string (*cell)(const BestGrip&)) {
    const auto differs = [&](const BestGrip& b) { return cell(b) != cell(best.front()); };  // between several results
    if (plan.varies(place) || std::any_of(best.begin(), best.end(), differs)) columns.push_back({title, cell, Column::always});
  };
  axis(PLACE_HEIGHT, "height mm", [](const BestGrip& b) { return fixed_text(b.grip.height * 1e3, 1); });
  axis(PLACE_AZIMUTH, "azimuth deg", [](const BestGrip& b) { return fixed_text(degrees(b.grip.azimuth), 1); });
  axis(PLACE_OBLIQUITY, "obliquity deg", [](const BestGrip& b) { return fixed_text(degrees(b.grip.obliquity), 1); });
  axis(PLACE_ROLL, "roll deg", [](const BestGrip& b) { return fixed_text(degrees(b.grip.roll), 1); });
  axis(PLACE_OFFSET, "offset mm", [](const BestGrip& b) { return fixed_text(b.grip.offset * 1e3, 1); });
  if (plan.hand_scales() == 1)
    axis(PLACE_HAND_SCALE, "hand scale", [](const BestGrip& b) { return fixed_text(b.grip.hand_scale, 3); });
  columns.insert(columns.end(),
                 {
                     {"fingers", [](const BestGrip& b) { return std::to_string(b.fingers_used); }, Column::fingers},
                     {"points", [](const BestGrip& b) { return std::to_string(b.points_touching); }},
                     {"depth mm", [](const BestGrip& b) { return fixed_text(std::max(b.phalanx_depth, b.palm_depth) * 1e3, 1); }},
                     {"closure", [](const BestGrip& b) { return fixed_text(b.closure, 2); }},
                     {"gap mm", [](const BestGrip& b) { return fixed_text(b.gap * 1e3, 1); }, Column::gap},
                 });
  // with tilts an infinite hold says it
  if (scene.tilts.empty())
    columns.push_back({"antipodal", [](const BestGrip& b) { return std::string(b.antipodal ? "yes" : "no"); }, Column::always});
  if (!scene.tilts.empty()) {
    columns.push_back({"peak N", [](const BestGrip& b) { return fixed_text(b.peak_force, 2); }});
    columns.push_back({"hold N", [](const BestGrip& b) { return fixed_text(b.largest_hold, 1); }, if_so(!has_effort(scene))});
    columns.push_back(
        {"safe deg", [](const BestGrip& b) { return range_text(degrees(b.safe_tilt), b.is_safe_to_end); }, Column::safe_tilt});
  }
  if (has_effort(scene)) {
    columns.push_back({"effort", [](const BestGrip& b) { return fixed_text(b.efforts.worst, 3); }, Column::effort});
    columns.push_back({"margin", [](const BestGrip& b) { return fixed_text(held_margin(b.efforts.worst), 2); }});
    columns.push_back({"push N", [](const BestGrip& b) { return fixed_text(b.efforts.push, 1); }, if_so(view.by == RankBy::push)});
  }
  std::size_t longest = std::string_view("result").size();
  for (const std::string& result : view.results) longest = std::max(longest, result.size());
  std::string table = view.results.empty() ? "  rank" : fmt::format("  rank  {:<{}}", "result", longest);
  if (!view.is_wide) narrow(columns, table, view.results.empty() ? 1 : 2);
  for (const Column& column : columns) table += "  " + column.title;
  table += '\n';
  for (std::size_t rank = 0; rank < std::min(view.rows, best.size()); ++rank) {
    table += fmt::format("  {:>4}", best[rank].rank);
    if (!view.results.empty()) table += fmt::format("  {:<{}}", view.results[rank], longest);
    for (const Column& column : columns) table += fmt::format("  {:>{}}", column.cell(best[rank]), column.title.size());
    table += '\n';
  }
  return table;
}

}  // namespace wholehand::sweeps

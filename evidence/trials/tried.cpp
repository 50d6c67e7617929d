// SPDX-License-Identifier: MIT
#include "evidence/trials/tried.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "base/files/csv.h"
#include "evidence/trials/cases.h"

namespace wholehand {
namespace {

constexpr const char* COLUMNS =
    "vessel,grip,fill,tilt_rad,protocol,effort,tips_effort,push_N,score,held,slip_m,turn_rad,discarded,reason,"
    "sample,model,material,direction,move_m,lost_after_s,tilt_lost_rad,worst_effort,tips_worst_effort,scene_worst_effort,"
    "friction_needed,epsilon,score_fingers,score_contacts,score_depth,score_posture,score_force,score_hold,"
    "height_m,azimuth_rad,obliquity_rad,roll_rad,offset_m,hand_scale,leg_effort,leg_tips_effort,slipped,robust_low,robust_mean,"
    "robust_share,"
    "placements,"
    "placements_held,placements_discarded,placements_impossible,detail\n";

std::string cell_of(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

// Cells one after the other, each behind a comma but the first.
class RowText {
 public:
  explicit RowText(std::string& text) : text_(text) {}
  RowText& add(const std::string& cell) {
    if (!is_first_) text_ += ',';
    is_first_ = false;
    text_ += cell;
    return *this;
  }
  RowText& add(double value, bool is_there = true) { return add(is_there ? cell_of(value) : std::string()); }

 private:
  std::string& text_;
  bool is_first_ = true;
};

void add_grip(RowText& row, const TrialGrip& grip, const GripPrediction& said) {
  row.add(said.worst_effort).add(said.tips_worst_effort).add(said.scene_worst_effort);
  row.add(said.friction_needed).add(said.epsilon);
  for (const double term : said.terms) row.add(term);
  row.add(grip.grip.height).add(grip.grip.azimuth).add(grip.grip.obliquity);
  row.add(grip.grip.roll).add(grip.grip.offset).add(grip.grip.hand_scale);
}

void add_placements(RowText& row, const GripFinding& found) {
  const bool has_any = !found.placements.empty();
  PlacementCount count;
  count.add(found.placements);
  row.add(found.robust.low).add(found.robust.mean).add(found.robust.share);
  for (const std::size_t number : {count.all, count.held, count.discarded, count.impossible})
    row.add(static_cast<double>(number), has_any);
}

}  // namespace

void PlacementCount::add(const std::vector<Placement>& placements) {
  all += placements.size();
  for (const Placement& one : placements) {
    held += one.held ? 1 : 0;
    impossible += one.is_possible ? 0 : 1;
    discarded += is_discarded(one.reason) ? 1 : 0;
    if (one.is_possible && !one.held) ++reasons[static_cast<std::size_t>(one.reason)];
  }
}

std::string trials_csv(const Scene& scene, const TrialSettings& settings, const TriedGrips& tried) {
  std::string text = COLUMNS;
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    const TrialGrip& grip = tried.grips[g];
    const GripPrediction& said = tried.found[g].prediction;
    for (std::size_t k = 0; k < tried.cases_of(g).size(); ++k) {
      const TrialCase& one = tried.cases_of(g)[k];
      const TrialOutcome& outcome = tried.found[g].outcomes[k];
      const bool is_push = one.protocol == TrialProtocol::six_forces, has_run = !outcome.discarded;
      RowText row(text);
      row.add(csv_text(scene.vessels[grip.vessel].name)).add(fmt::format("{}", grip.number));
      row.add(one.fill).add(one.tilt, !is_push).add(TRIAL_PROTOCOL_NAMES[static_cast<std::size_t>(one.protocol)]);
      row.add(said.cases[k].effort).add(said.cases[k].tips).add(said.push).add(said.score);
      row.add(outcome.held && has_run ? "1" : "0").add(outcome.slip, has_run).add(outcome.turn, has_run);
      row.add(outcome.discarded ? "1" : "0").add(TRIAL_REASON_NAMES[static_cast<std::size_t>(outcome.reason)]);
      row.add(TRIAL_SAMPLE_NAMES[static_cast<std::size_t>(grip.sample)]);
      row.add(TRIAL_MODEL_NAMES[static_cast<std::size_t>(settings.model)]);
      row.add(is_push ? csv_text(settings.materials[static_cast<std::size_t>(one.material)].name) : "");
      row.add(is_push ? FORCE_DIRECTION_NAMES[static_cast<std::size_t>(one.direction)] : "");
      const bool is_lost = has_run && !outcome.held;
      row.add(outcome.move, has_run).add(outcome.when, is_lost).add(outcome.tilt_lost, is_lost && !is_push);
      add_grip(row, grip, said);
      row.add(said.cases[k].leg_effort).add(said.cases[k].leg_tips);
      row.add(!has_run ? "" : has_slipped(outcome, settings) ? "1" : "0");
      add_placements(row, tried.found[g]);
      row.add(csv_text(outcome.detail));
      text += '\n';
    }
  }
  return text;
}

}  // namespace wholehand
